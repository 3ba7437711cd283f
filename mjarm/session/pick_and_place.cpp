#include "mjarm/session/pick_and_place.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "mjarm/core/messages/program.hpp"
#include "mjarm/execution/execution.hpp"
#include "mjarm/model/scene_bodies.hpp"

namespace mjarm::session {
namespace {

constexpr double kNeighbour = 0.15;  // [m] a thing so far off may be in the way of fingers

class PickRunner {
 public:
  PickRunner(const Robot& robot, Sim& sim, const PickAndPlaceOptions& options)
      : robot_(robot), sim_(sim), options_(options) {
    const JointVec from = q();
    begun_.assign(from.data(), from.data() + from.size());
  }

  Result<PickAndPlaceOutcome> run(const Look& look, program::PickTask task) {
    PickAndPlaceOutcome out;
    program::PickOptions how = options_.pick;
    while (!out.done && static_cast<int>(out.tries.size()) < options_.tries) {
      const Result<program::SeenScene> seen = look_for(task.object, look);
      if (!seen) return fail(seen.error());
      if (const auto unseen = seen->unseen.find(task.object); unseen != seen->unseen.end()) {
        out.failure = {program::PickErrc::not_seen,
                       text(msg::program_not_seen, task.object, unseen->second),
                       {}};
        break;
      }
      const auto same = seen->same.find(task.object);
      if (task.place && same != seen->same.end()) task.place->same = same->second;
      auto planned = program::plan_pick(robot_, seen->scene, as_span(q()), task, how);
      if (!planned) {
        out.failure = std::move(planned.error());
        break;
      }
      how.avoid.push_back(planned->grasp);
      Result<PickTry> done = execute(std::move(*planned), seen->scene);
      if (!done) return fail(std::move(done.error()));
      out.tries.push_back(std::move(*done));
      if (is_stopped(options_.pick.stop)) {
        out.failure = {program::PickErrc::stopped, stopped().what, {}};
        break;
      }
      out.done = out.tries.back().fault == GripFault::none;
      if (out.tries.back().fault == GripFault::blocked) break;
      if (!out.done) {
        if (auto back = draw_back(seen->scene); !back) return fail(std::move(back.error()));
      }
    }
    return out;
  }

  /// Looks, from elsewhere too where that does not find the object, or something beside it.
  Result<program::SeenScene> look_for(const std::string& object, const Look& look) {
    Result<program::SeenScene> seen = look(truth(), as_span(q()));
    bool looked_again = false;
    for (const Vantage& vantage : options_.vantages) {
      if (!seen || is_stopped(options_.pick.stop)) break;
      const bool hidden = seen->unseen.contains(object);
      if (!hidden && (looked_again || !hides_neighbour(*seen, object))) break;
      const Result<bool> there = move({plan_to(vantage.X_WT)}, seen->scene);
      if (!there) return fail(there.error());
      if (!*there) continue;
      Result<program::SeenScene> more = vantage.look(truth(), as_span(q()));
      if (!more) return more;
      add_unseen(*seen, *more);
      seen = std::move(more);
      looked_again = true;
    }
    return seen;
  }

 private:
  [[nodiscard]] JointVec q() const { return sim_.arm_state(robot_.arm).q; }
  [[nodiscard]] SceneState truth() const {
    return {.qpos = {sim_.qpos().begin(), sim_.qpos().end()}, .attached = {}};
  }

  /// Whether fingers that close on the object may meet something of which no pose is known: it
  /// seems to be near, or may be anywhere.
  [[nodiscard]] bool hides_neighbour(const program::SeenScene& seen,
                                     const std::string& object) const {
    const auto place = [&](const std::string& body) {
      return frame_pose(robot_.model, body, seen.scene.qpos).value_or(Pose{}).p;
    };
    if (!seen.anywhere.empty()) return true;
    return std::ranges::any_of(seen.unseen, [&](const auto& one) {
      return (place(one.first) - place(object)).norm() < kNeighbour;
    });
  }

  /// Adds to `seen` what only an earlier look found.
  void add_unseen(const program::SeenScene& earlier, program::SeenScene& seen) const {
    for (const SceneObject& object : scene_bodies(robot_.model, robot_.arm).objects) {
      if (!seen.unseen.contains(object.name) || earlier.unseen.contains(object.name)) continue;
      std::copy_n(earlier.scene.qpos.begin() + object.qpos, 7,
                  seen.scene.qpos.begin() + object.qpos);
      seen.unseen.erase(object.name);
      seen.anywhere.erase(object.name);
      const auto same = earlier.same.find(object.name);
      if (same != earlier.same.end()) seen.same.insert(*same);
    }
  }

  /// Executes a plan until something goes wrong.
  Result<PickTry> execute(program::PickPlan planned, const SceneState& scene) {
    PickTry out{.planned = std::move(planned)};
    const MotionPlan& plan = out.planned.plan;
    Result<Execution> execution = Execution::create(
        robot_.model, plan, {.control = options_.control, .recorder = options_.recorder});
    if (!execution) return fail(std::move(execution.error()));
    GripWatch watch(robot_.model, plan, scene);
    const double begun = sim_.time();
    const auto done = execution->run_to_end(sim_, [&](const Sim& sim) {
      out.fault = watch.look(sim, execution->motions().back().move, execution->error(sim));
      if (options_.after_step) options_.after_step(sim);
      return out.fault == GripFault::none && !is_stopped(options_.pick.stop);
    });
    if (!done) return fail(done.error());
    out.what = watch.what();
    if (auto rested = rest(*execution); !rested) return fail(std::move(rested.error()));
    out.seconds = sim_.time() - begun;
    out.motions = execution->motions();
    out.objects = execution->objects();
    out.contact = execution->outcome().first_contact;
    return out;
  }

  /// Lets an arm that was stopped on its way come to rest.
  Result<void> rest(Execution& execution) {
    execution.stop();
    while (execution.state() == Execution::State::stopping) {
      if (auto stepped = execution.step(sim_); !stepped) return stepped;
      if (options_.after_step) options_.after_step(sim_);
    }
    return {};
  }

  /// Opens the gripper and goes straight up and back to the beginning, out of the camera's sight;
  /// as far as it may.
  Result<void> draw_back(const SceneState& scene) {
    Pose above = sim_.tool(robot_.arm);
    above.p.z() += options_.pick.lift;
    const Result<bool> there = move({{program::Grip{.close = false}},
                                     program::move_l(above),
                                     {program::PlanMove{.goal = program::JointValues{begun_}}}},
                                    scene);
    return there ? Result<void>() : fail(there.error());
  }

  static program::Instruction plan_to(const Pose& X_WT) {
    return {program::PlanMove{.goal = program::ProgramPose{.X_FT = X_WT}}};
  }

  /// From where the arm stands, as far as it may. @return whether that was all of it.
  Result<bool> move(std::vector<program::Instruction> instructions, const SceneState& scene) {
    program::Program program;
    program.name = "move";
    const JointVec from = q();
    program.start.values.assign(from.data(), from.data() + from.size());
    program.instructions = std::move(instructions);
    const program::ProgramPlan plan =
        program::plan_program(robot_.model, robot_.arm, program, {.scene = scene});
    Result<Execution> execution = Execution::create(
        robot_.model, plan, {.control = options_.control, .recorder = options_.recorder});
    if (!execution) return fail(std::move(execution.error()));
    const auto done = execution->run_to_end(sim_, [&](const Sim& sim) {
      if (options_.after_step) options_.after_step(sim);
      return !is_stopped(options_.pick.stop);
    });
    if (!done) return fail(done.error());
    return plan.ok();
  }

  const Robot& robot_;
  Sim& sim_;
  const PickAndPlaceOptions& options_;
  std::vector<double> begun_;  ///< (dof,) [rad or m] where the arm stood at first
};

}  // namespace

Result<PickAndPlaceOutcome> pick_and_place(const Robot& robot, Sim& sim, const Look& look,
                                           const program::PickTask& task,
                                           const PickAndPlaceOptions& options) {
  return PickRunner(robot, sim, options).run(look, task);
}

Result<program::SeenScene> look_for(const Robot& robot, Sim& sim, const Look& look,
                                    const std::string& object, const PickAndPlaceOptions& options) {
  return PickRunner(robot, sim, options).look_for(object, look);
}

}  // namespace mjarm::session
