#include "mjarm/session/free_sim.hpp"

#include <algorithm>
#include <utility>

#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/panels.hpp"
#include "mjarm/session/arm_json.hpp"
#include "mjarm/session/max_moments.hpp"

namespace mjarm::session {
namespace {

constexpr std::size_t kMaxMoments = 2000;
constexpr double kPace = 8;          // [1/s] of the spring to the goal
constexpr double kSpeedShare = 0.5;  // of the joints' velocity limits

}  // namespace

FreeSim::FreeSim(const Model& model, std::optional<Arm> arm, std::optional<Controller> controller)
    : sim_(model),
      arm_(std::move(arm)),
      controller_(std::move(controller)),
      playback_(model.timestep()),
      history_(max_moments(sim_, kMaxMoments)),
      ctrl_(static_cast<std::size_t>(model.nu()), 0.0) {
  if (controller_) sim_.hold_others(*arm_);
  reset();
}

Result<FreeSim> FreeSim::create(const Model& model, const std::optional<Arm>& arm, bool passive) {
  if (passive || !arm) return FreeSim(model, arm, std::nullopt);
  // Servos of the model as they are where there are some; else what motors can do.
  Result<Controller> controller = Controller::create(model, *arm, ControlMode::servo_gravity);
  if (!controller) controller = Controller::create(model, *arm, ControlMode::computed_torque);
  if (!controller) return fail(Errc::not_available, controller.error().what);
  return FreeSim(model, arm, std::move(*controller));
}

void FreeSim::reset() {
  sim_.reset_home();
  if (arm_) {
    sim_.place(*arm_, as_span(arm_->home));
    q_before_ = q_now_ = q_goal_ = arm_->home;
  }
  const auto ctrl = sim_.ctrl();
  ctrl_.assign(ctrl.begin(), ctrl.end());
  if (!controller_) std::fill(ctrl_.begin(), ctrl_.end(), 0.0);
  if (controller_) controller_->restart();
  history_.clear();
  remember();
  unstable_ = false;
}

void FreeSim::remember() { history_.add({sim_.snapshot(), q_before_, q_now_, q_goal_}); }

void FreeSim::go_to(const Moment& moment) {
  // Of the same model, so it fits.
  (void)sim_.restore(moment.snapshot);
  sim_.clear_external_forces();  // a push goes on with the user's hand, not with the past
  q_before_ = moment.q_before;
  q_now_ = moment.q_now;
  q_goal_ = moment.q_goal;
}

JointVec FreeSim::next_reference() const {
  const double dt = sim_.model().timestep();
  const JointVec max = kSpeedShare * arm_->limits.velocity;
  const JointVec v = (q_now_ - q_before_) / dt;
  const JointVec a = kPace * (kPace * (q_goal_ - q_now_) - 2 * v);
  return q_now_ + dt * (v + dt * a).cwiseMax(-max).cwiseMin(max);
}

void FreeSim::step() {
  if (controller_) {
    StepReference reference{q_before_, q_now_, next_reference()};
    (void)controller_->command(sim_.qpos(), sim_.qvel(), reference, ctrl_);
    q_before_ = q_now_;
    q_now_ = reference.next;
  }
  if (auto stepped = sim_.step(ctrl_); !stepped) {
    log_warning(stepped.error().what);
    reset();
    unstable_ = true;
    return;
  }
  remember();
}

std::string FreeSim::status() const {
  return unstable_ ? text(msg::panel_unstable) : std::string();
}

std::vector<int> FreeSim::jog_dofs() const {
  return controller_ ? dofs_of(*arm_) : std::vector<int>();
}

void FreeSim::set_goal(const JointVec& q) {
  if (!controller_ || q.size() != q_goal_.size()) return;
  q_goal_ = q.cwiseMax(arm_->limits.lower).cwiseMin(arm_->limits.upper);
}

void FreeSim::jog(const view::JointEvent& event) {
  if (!controller_) return;
  for (int i = 0; i < arm_->dof(); ++i) {
    if (arm_->joints[static_cast<std::size_t>(i)].dof != event.dof) continue;
    q_goal_[i] = std::clamp(event.value, arm_->limits.lower[i], arm_->limits.upper[i]);
  }
}

void FreeSim::handle(const view::ViewEvent& event) {
  if (const auto* push = std::get_if<view::PushEvent>(&event)) {
    sim_.set_external_force(push->body, push->force_W, push->torque_W);
  } else if (std::holds_alternative<view::ReleaseEvent>(event)) {
    sim_.clear_external_forces();
  } else if (std::holds_alternative<view::ResetEvent>(event)) {
    reset();
  } else if (const auto* joint = std::get_if<view::JointEvent>(&event)) {
    jog(*joint);
  } else if (const auto* step = std::get_if<view::StepEvent>(&event)) {
    const Moment* moment = step->steps < 0 ? history_.back() : history_.forward();
    if (moment != nullptr) {
      go_to(*moment);
    } else if (step->steps > 0) {
      (void)playback_.handle(event);
    }
  } else {
    (void)playback_.handle(event);
  }
}

}  // namespace mjarm::session
