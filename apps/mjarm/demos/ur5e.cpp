#include <algorithm>

#include "apps/mjarm/demos/demo_stage.hpp"
#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/demos/tutorial.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm::app {
namespace {

constexpr double kSeconds = 3;  // [s] the tutorial's servo has settled long before

/// The tutorial's first move: the arm starts at one posture and all servos jump to another.
struct Jump {
  JointVec start, goal;  ///< [rad or m] (dof,)
};

/// The tutorial's postures, with those that the user gives in their place.
Result<Jump> read_jump(const DemoValues& values, const Arm& arm) {
  const bool tutorials = arm.dof() == 6;
  Jump jump{
      .start = tutorials ? joint_vec(std::vector<double>{0, -1.0, 2.2, -1.3, 1.55, 0}) : arm.home,
      .goal = tutorials ? joint_vec(tutorial_seed()) : arm.home};
  const auto read = [&arm](const char* option, const std::string& words,
                           JointVec& out) -> Result<void> {
    if (words.empty()) return {};
    const auto q = read_posture(option, words, arm);
    if (!q) return fail(q.error());
    out = joint_vec(*q);
    return {};
  };
  Result<void> done = read("--start", values.start, jump.start).and_then([&] {
    return read("--ctrl", values.ctrl, jump.goal);
  });
  if (!done) return fail(std::move(done.error()));
  return jump;
}

Result<Report> jump(const std::string& demo, const DemoOptions& options, bool vision) {
  // The tutorial's target is for six joints; one of the user's is for as many as it has.
  const Result<Robot> robot = load_demo_robot(demo, options, options.values.ctrl.empty() ? 6 : 0);
  if (!robot) return fail(robot.error());
  const Result<Jump> wanted = read_jump(options.values, robot->arm);
  if (!wanted) return fail(wanted.error());
  const auto& [start, goal] = *wanted;
  Result<std::unique_ptr<session::Stage>> opened = session::Stage::open(demo, options, *robot);
  if (!opened) return fail(std::move(opened.error()));
  session::Stage& stage = **opened;
  stage.run().start_at(as_span(start));
  if (vision) {
    stage.show().set_balls(true);
    stage.show().plot_tool();
  }

  Report report;
  report.max_joint_step = (goal - start).cwiseAbs().maxCoeff();
  const ControlMode mode = stage.control(ControlMode::servo);
  const double seconds = options.seconds > 0 ? options.seconds : kSeconds;
  auto done = stage.move([&](MotionRun& run) { return run.jump(goal, mode, seconds); });
  if (!done) return fail(std::move(done.error()));
  const JointVec q = stage.run().sim().arm_state(stage.arm()).q;
  const PoseError error =
      pose_error(fk(stage.arm(), as_span(goal)), stage.run().sim().tool(stage.arm()));
  report.static_error = error;
  const double way = (goal - start).norm();
  report.done = way > 0 ? std::max(0.0, 1 - (goal - q).norm() / way) : 1;
  log_info(text(msg::demo_arrived, 1e3 * error.position, (goal - q).cwiseAbs().maxCoeff()));
  return stage.finish(std::move(report), 0.02);
}

}  // namespace

Result<Report> run_ur5e(const DemoOptions& options) { return jump("ur5e", options, false); }

Result<Report> run_ur5e_vision(const DemoOptions& options) {
  return jump("ur5e_vision", options, true);
}

}  // namespace mjarm::app
