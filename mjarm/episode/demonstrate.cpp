#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "mjarm/core/stopwatch.hpp"
#include "mjarm/episode/demonstrate_internal.hpp"
#include "mjarm/episode/studio_internal.hpp"
#include "mjarm/execution/execution.hpp"
#include "mjarm/execution/grip_watch.hpp"
#include "mjarm/execution/metrics.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/scene_bodies.hpp"

namespace mjarm::episode {
namespace {

class Demonstrator {
 public:
  Demonstrator(const Robot& robot, const EpisodeOptions& options, Task& task, const StopCheck& stop)
      : robot_(robot), options_(options), task_(task), stop_(stop), sim_(robot.model) {
    bodies_ = place_scene(robot, task.scene(), sim_);
    before_ = state();
  }

  /// Fills plan and goal; a verdict with a reason where there is none.
  void plan(const std::optional<Jaws>& jaws, Demonstration& out) const {
    TaskPlan planned = task_.plan({robot_, jaws, before_, stop_});
    out.plan = std::move(planned.plan);
    out.goal = planned.goal;
    out.verdict.reason = std::move(planned.reason);
  }

  Result<void> execute(Demonstration& out) {
    Result<Execution> execution = Execution::create(robot_.model, out.plan, task_.execution());
    if (!execution) return fail(std::move(execution.error()));
    GripWatch watch(robot_.model, out.plan, before_);
    GripFault fault = GripFault::none;
    task_.look(sim_);
    take(*execution, 0, out);
    long long steps = 0;
    const auto done = execution->run_to_end(sim_, [&](const Sim& sim) {
      const std::size_t motion = execution->motions().back().move;
      const JointVec error = execution->error(sim);
      // A tool that is pressed on something is not where the plan has it.
      if (!execution->presser()) fault = watch.look(sim, motion, error);
      measure(error, out);
      task_.look(sim);
      if (++steps >= due(out.samples.size())) take(*execution, motion, out);
      return fault == GripFault::none && !is_stopped(stop_);
    });
    if (!done) return fail(done.error());
    if (is_stopped(stop_)) return fail(stopped());
    judge_end(*execution, fault, out);
    return {};
  }

 private:
  [[nodiscard]] SceneState state() const {
    return {.qpos = {sim_.qpos().begin(), sim_.qpos().end()}, .attached = {}};
  }

  /// The number of steps after which row `row` is taken.
  [[nodiscard]] long long due(std::size_t row) const {
    return std::llround(static_cast<double>(row) / (options_.fps * robot_.model.timestep()));
  }

  void take(const Execution& execution, std::size_t motion, Demonstration& out) const {
    const JointState arm = sim_.arm_state(robot_.arm);
    Sample sample{.state = sim_.snapshot(),
                  .qpos = {sim_.qpos().begin(), sim_.qpos().end()},
                  .qvel = {sim_.qvel().begin(), sim_.qvel().end()},
                  .ctrl = {sim_.ctrl().begin(), sim_.ctrl().end()},
                  .q = arm.q,
                  .v = arm.v,
                  .q_ref = arm.q + (out.samples.empty() ? JointVec(JointVec::Zero(arm.q.size()))
                                                        : execution.error(sim_)),
                  .X_WT = sim_.tool(robot_.arm),
                  .X_WT_ref = {},
                  .grip = grip_command(robot_.arm, sim_),
                  .objects = poses(),
                  .motion = motion,
                  .marks = task_.marks()};
    sample.X_WT_ref = fk(robot_.arm, as_span(sample.q_ref));
    out.samples.push_back(std::move(sample));
  }

  void measure(const JointVec& error, Demonstration& out) const {
    const JointVec q_ref = sim_.arm_state(robot_.arm).q + error;
    const Pose X_WT = fk(robot_.arm, as_span(q_ref));
    out.tool_error = std::max(out.tool_error, (X_WT.p - sim_.tool(robot_.arm).p).norm());
    out.joint_error = std::max(out.joint_error, error.cwiseAbs().maxCoeff());
  }

  [[nodiscard]] std::vector<Pose> poses() const {
    std::vector<Pose> out;
    for (const int body : bodies_) out.push_back(sim_.body_pose(body));
    return out;
  }

  /// What the scene says counts; what was noticed on the way is a reason as well.
  void judge_end(const Execution& execution, GripFault fault, Demonstration& out) const {
    const std::vector<Pose> after = poses();
    out.verdict = task_.judge({sim_, sim_.tool(robot_.arm), after, out.goal});
    std::string_view noticed = name(fault);
    for (const ObservedObject& object : execution.objects()) {
      if (noticed.empty() && object.fault != ObjectFault::none) noticed = name(object.fault);
    }
    if (noticed.empty() && execution.outcome().first_contact) noticed = "contact";
    if (!noticed.empty()) out.verdict.reason = noticed;
  }

  const Robot& robot_;
  const EpisodeOptions& options_;
  Task& task_;
  const StopCheck& stop_;
  Sim sim_;
  std::vector<int> bodies_;  ///< of the objects
  SceneState before_;
};

}  // namespace

Verdict judge(const Pose& X_WB, const Pose& goal, std::span<const Pose> before,
              std::span<const Pose> after) {
  const PoseError error = pose_error(goal, X_WB);
  Verdict out{.reason = {}, .position = error.position, .rotation = error.rotation};
  for (std::size_t i = 0; i < before.size(); ++i) {
    out.others = std::max(out.others, (after[i].p - before[i].p).norm());
  }
  // The comparisons are false for what is no number.
  if (!(out.position <= kAtGoal && out.rotation <= kTurnedAtGoal)) {
    out.reason = "off_goal";
  } else if (!(out.others <= kOthersMoved)) {
    out.reason = "others_moved";
  }
  return out;
}

Result<Demonstration> demonstrate(const Robot& robot, const std::optional<Jaws>& jaws,
                                  const EpisodeOptions& options, Task& task, const StopCheck& stop,
                                  EpisodeTimes& times) {
  Demonstration out;
  const Stopwatch planning;
  Demonstrator demonstrator(robot, options, task, stop);
  demonstrator.plan(jaws, out);
  times.planning += planning.us();
  if (is_stopped(stop)) return fail(stopped());
  if (!out.verdict.success()) return out;
  const Stopwatch physics;
  if (auto done = demonstrator.execute(out); !done) return fail(std::move(done.error()));
  times.physics += physics.us();
  return out;
}

}  // namespace mjarm::episode
