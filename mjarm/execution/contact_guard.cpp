#include "mjarm/execution/contact_guard.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mjarm/core/messages/execution.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
namespace {

constexpr std::array<std::string_view, 2> kReactions = {"ignore", "stop"};
constexpr double kJudged = 0.014;    // [s] for which link and force may still be corrected
constexpr double kShareBack = 0.25;  // of the limits, on the way back
constexpr int kFewestBack = 25;      // [steps]

double smooth_way(double x) { return x * x * x * (10 - x * (15 - 6 * x)); }

}  // namespace

std::string_view name(ContactReaction reaction) noexcept {
  return kReactions[static_cast<std::size_t>(reaction)];
}

Result<ContactReaction> contact_reaction(std::string_view word) {
  const auto index = index_of_word(word, kReactions, msg::execution_unknown_reaction);
  if (!index) return fail(index.error());
  return static_cast<ContactReaction>(*index);
}

ContactGuard::ContactGuard(const Model& model, const Arm& arm, ContactObserver observer)
    : model_(model), arm_(arm), observer_(std::move(observer)), places_(model, arm) {}

Result<ContactGuard> ContactGuard::create(const Model& model, const Arm& arm) {
  Result<ContactObserver> observer = ContactObserver::create(model, arm, {});
  if (!observer) return fail(std::move(observer.error()));
  return ContactGuard(model, arm, std::move(*observer));
}

void ContactGuard::change_model(const Model& model) {
  // Its options, which are what could be wrong, are those that served before.
  observer_ = ContactObserver::create(model, arm_, {}).value();
}

void ContactGuard::restart() {
  contact_.reset();
  surprise_ = 0;
  back_.clear();
  done_ = 0;
  has_way_ = planned_ = false;
  observer_.restart();
}

bool ContactGuard::look(const Sim& sim, bool planned) {
  if (planned_ && !planned) observer_.restart();
  planned_ = planned;
  if (planned) return false;
  const std::optional<NoticedContact> noticed = observer_.look(sim.qpos(), sim.qvel());
  if (!noticed) return false;
  const bool first = !contact_;
  if (first || sim.time() <= contact_->time + kJudged) {
    judge(*noticed, sim.arm_state(arm_).q, sim.time());
  }
  return first;
}

void ContactGuard::judge(const NoticedContact& noticed, const JointVec& q, double time) {
  if (noticed.surprise <= surprise_) return;
  surprise_ = noticed.surprise;
  const ContactPlace place = places_.find(q, noticed);
  contact_ = {.time = contact_ ? contact_->time : time,
              .joint = place.joint,
              .link = place.body,
              .force = place.force_W.norm(),
              .torque = noticed.torque};
}

/// As far back on the motion that was stopped as the tool has gone kBackOff, or to its beginning.
void ContactGuard::plan_way_back(const MotionPlan& plan, const MotionClock& clock) {
  constexpr double kLook = 0.01;  // [s]
  has_way_ = true;
  if (clock.motion() >= plan.moves.size()) return;
  const Trajectory& way = plan.moves[clock.motion()].trajectory;
  const double from = clock.time(), h = model_.timestep();
  const Eigen::Vector3d here = fk(arm_, as_span(way.at(from).q)).p;
  double to = from;
  while (to > 0 && (fk(arm_, as_span(way.at(to).q)).p - here).norm() < kBackOff) {
    to = std::max(0.0, to - kLook);
  }
  for (int steps = kFewestBack;; steps += steps / 2) {
    back_.assign(1, way.at(from).q);
    JointVec v = JointVec::Zero(arm_.dof()), a = v;
    bool keeps = true;
    for (int i = 1; i <= steps; ++i) {
      const double x = smooth_way(static_cast<double>(i) / steps);
      const JointVec q = way.at(from + x * (to - from)).q;
      const JointVec v_next = (q - back_.back()) / h, a_next = (v_next - v) / h;
      keeps = keeps && (v_next.cwiseAbs() - kShareBack * arm_.limits.velocity).maxCoeff() <= 0 &&
              (a_next.cwiseAbs() - kShareBack * arm_.limits.acceleration).maxCoeff() <= 0 &&
              ((a_next - a).cwiseAbs() / h - arm_.limits.jerk).maxCoeff() <= 0;
      back_.push_back(q);
      v = v_next;
      a = a_next;
    }
    if (keeps || steps * h > 60) return;
  }
}

std::optional<StepReference> ContactGuard::back_off(const MotionPlan& plan,
                                                    const MotionClock& clock) {
  if (!has_way_) plan_way_back(plan, clock);
  if (done_ + 1 >= back_.size()) return std::nullopt;
  return reference_at(back_, done_++);
}

}  // namespace mjarm
