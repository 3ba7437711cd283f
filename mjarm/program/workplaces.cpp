#include <algorithm>
#include <optional>

#include "mjarm/core/messages/execution.hpp"
#include "mjarm/program/workplaces_internal.hpp"

namespace mjarm::program::detail {
namespace {

constexpr std::size_t kMaxTools = 16;  // that are kept; each has copies of the scene of its own
/// [m] What is carried may be so deep in what it lies on, when it is picked up and put down: a part
/// at rest sinks in a little, and one is put down to the hair.
constexpr double kRestDepth = 1e-3;

/// Of the joints' acceleration and jerk limits, while something is carried: fingers hold by
/// friction, and what they hold swings and slips where an empty hand could be thrown about.
constexpr double kCarryingShare = 0.3;
/// [m] What is carried keeps so far from things, where a path with it can be had: it moves a little
/// in the fingers.
constexpr double kCarryingMargin = 0.005;

/// All that is in a scene, byte by byte.
std::string key_of(const SceneState& scene) {
  std::string key;
  const auto put = [&key](double value) {
    key.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (const double value : scene.qpos) put(value);
  for (const AttachedBody& one : scene.attached) {
    key += one.body + '\0';
    std::ranges::for_each(one.X_TB.p, put);
    for (Eigen::Index k = 0; k < 9; ++k) put(one.X_TB.R.data()[k]);
  }
  return key;
}

}  // namespace

std::shared_ptr<Tool> Workplaces::make(const SceneState& scene, const Arm& of_tool) const {
  Arm arm = of_tool;
  if (!scene.attached.empty()) {
    arm.limits.acceleration *= kCarryingShare;
    arm.limits.jerk *= kCarryingShare;
  }
  ContactRules rules{.attached = attached_to(arm, arms_.front(), scene.attached),
                     .allowed = options_.allowed};
  IkOptions options;
  options.task = task_for(arm);
  std::optional<ExactChecker> checker, shown;
  if (options_.collision) {
    ExactOptions exact{.rules = rules, .qpos = scene.qpos, .rest_depth = kRestDepth};
    checker.emplace(model_, arm, exact);
    exact.skip_neighbours = true;
    shown.emplace(model_, arm, exact);
  }
  const MoveJudge judge(arm, checker, shown);
  if (checker) {
    options.valid = [clearance = judge.clearance()](std::span<const double> q) {
      return clearance.is_free(q);
    };
  }
  const IkSolver ik(arm, options);
  WorldOptions world;
  world.rules = std::move(rules);
  world.qpos = scene.qpos;
  const double margin = scene.attached.empty() ? 0 : kCarryingMargin;
  return std::make_shared<Tool>(
      Tool{arm, ik.with({.task = options.task}), ik, judge,
           DetourPlanner({model_, arm}, ik, judge, std::move(world), options_.stop, margin),
           AnswerChoice(ik, judge.clearance()), !scene.qpos.empty()});
}

std::shared_ptr<Tool> Workplaces::tool(std::size_t scene, std::size_t tool) {
  const std::pair wanted(scene, tool);
  const auto known =
      std::ranges::find_if(tools_, [&](const auto& entry) { return entry.first == wanted; });
  if (known != tools_.end()) return known->second;
  if (tools_.size() == kMaxTools) tools_.pop_front();
  tools_.emplace_back(wanted, make(scenes_[scene], arms_[tool]));
  return tools_.back().second;
}

Result<std::size_t> Workplaces::gripped(const Stand& at, bool close) {
  const Arm& arm = arms_.front();
  if (!arm.gripper) return fail(Errc::not_available, text(msg::execution_no_gripper));
  const SceneState& before = scenes_[at.scene];
  Result<SceneState> after = close ? close_gripper(model_, arm, as_span(at.q), before)
                                   : open_gripper(model_, arm, as_span(at.q), before);
  if (!after) return fail(std::move(after.error()));
  return enter(std::move(*after));
}

std::size_t Workplaces::enter(SceneState scene) {
  // Where the arm itself stands makes no other scene.
  for (const ArmJoint& joint : arms_.front().joints) {
    if (!scene.qpos.empty()) scene.qpos[static_cast<std::size_t>(joint.qpos)] = 0;
  }
  const auto [entry, fresh] = known_.try_emplace(key_of(scene), scenes_.size());
  if (fresh) scenes_.push_back(std::move(scene));
  return entry->second;
}

}  // namespace mjarm::program::detail
