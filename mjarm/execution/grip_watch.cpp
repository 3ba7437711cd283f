#include "mjarm/execution/grip_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mjarm/core/messages/execution.hpp"
#include "mjarm/model/describe.hpp"

namespace mjarm {

std::string_view name(GripFault fault) noexcept {
  switch (fault) {
    case GripFault::nothing_held:
      return "nothing_held";
    case GripFault::lost:
      return "lost";
    case GripFault::blocked:
      return "blocked";
    case GripFault::none:
      break;
  }
  return "";
}

GripWatch::GripWatch(const Model& model, const MotionPlan& plan, SceneState before)
    : plan_(&plan), on_way_(std::numeric_limits<double>::infinity()) {
  const Arm& arm = plan.arms.front();
  holding_.resize(plan.moves.size());
  if (!arm.gripper) return;
  find_fingers(model, arm);
  SceneState scene = std::move(before);
  bool known = true;
  for (std::size_t i = 0; i < plan.moves.size(); ++i) {
    const PlannedMove& move = plan.moves[i];
    if (move.close && known) {
      const JointVec q = move.trajectory.at(0).q;
      Result<SceneState> next = *move.close ? close_gripper(model, arm, as_span(q), scene)
                                            : open_gripper(model, arm, as_span(q), scene);
      known = next.has_value();
      if (known) scene = std::move(*next);
    }
    if (known && !scene.attached.empty()) holding_[i] = scene.qpos;
  }
}

void GripWatch::find_fingers(const Model& model, const Arm& arm) {
  const Result<SceneState> open = open_gripper(model, arm, as_span(arm.home), {});
  if (!open) return;
  for (const BodyInfo& body : describe(model).bodies) {
    for (const JointInfo& joint : body.joints) {
      const auto& names = arm.gripper->joints;
      if (!joint.limited || std::ranges::find(names, joint.name) == names.end()) continue;
      const auto at = static_cast<std::size_t>(joint.qpos);
      const double stands = open->qpos[at];
      const bool opens_up = std::abs(stands - joint.upper) < std::abs(stands - joint.lower);
      fingers_.push_back({.name = joint.name,
                          .qpos = at,
                          .slides = joint.type == "slide",
                          .closed = opens_up ? joint.lower : joint.upper});
    }
  }
}

const GripWatch::Finger* GripWatch::closed_too_far(const Sim& sim, std::size_t move) const {
  const std::vector<double>& held = holding_[move];
  for (const Finger& finger : fingers_) {
    const double left = finger.closed - held[finger.qpos];
    const double may = std::min(finger.slides ? kFingerSlide : kFingerTurn, 0.5 * std::abs(left));
    const double farther = (sim.qpos()[finger.qpos] - held[finger.qpos]) * (left < 0 ? -1.0 : 1.0);
    if (farther > may) return &finger;
  }
  return nullptr;
}

GripFault GripWatch::look(const Sim& sim, std::size_t move, const JointVec& error) {
  if (fault_ != GripFault::none || move >= holding_.size()) return fault_;
  int joint = 0;
  const double most = error.cwiseAbs().maxCoeff(&joint);
  if (most <= kBlockedError) on_way_ = sim.time();
  if (sim.time() - on_way_ > kBlockedTime) {
    const Arm& arm = plan_->arms.front();
    what_ = text(msg::execution_blocked, arm.joints[static_cast<std::size_t>(joint)].name, most,
                 sim.time());
    return fault_ = GripFault::blocked;
  }
  // While they close they are not there yet; while they open they leave it.
  if (holding_[move].empty() || plan_->moves[move].close) {
    holds_ = false;
    return fault_;
  }
  if (const Finger* finger = closed_too_far(sim, move)) {
    fault_ = holds_ ? GripFault::lost : GripFault::nothing_held;
    what_ = text(holds_ ? msg::execution_grip_lost : msg::execution_nothing_held, finger->name,
                 sim.time());
  }
  holds_ = true;
  return fault_;
}

}  // namespace mjarm
