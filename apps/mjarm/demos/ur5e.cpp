#include "apps/mjarm/demos/demo_stage.hpp"
#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm::app {
namespace {

constexpr double kSeconds = 3;  // [s] the tutorial's servo has settled long before

/// The tutorial's first move: the arm starts at one posture and all servos jump to another.
Result<Report> jump(const std::string& demo, const DemoOptions& options, bool vision) {
  Result<std::unique_ptr<session::Stage>> opened = open_stage(demo, options, 6);
  if (!opened) return fail(std::move(opened.error()));
  session::Stage& stage = **opened;
  const JointVec start = joint_vec(std::vector<double>{0, -1.0, 2.2, -1.3, 1.55, 0});
  const JointVec goal = joint_vec(std::vector<double>{-1.57, -1.34, 2.65, -1.3, 1.55, 0});
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
  report.done = 1 - (goal - q).norm() / (goal - start).norm();
  log_info(text(msg::demo_arrived, 1e3 * error.position, (goal - q).cwiseAbs().maxCoeff()));
  return stage.finish(std::move(report), 0.02);
}

}  // namespace

Result<Report> run_ur5e(const DemoOptions& options) { return jump("ur5e", options, false); }

Result<Report> run_ur5e_vision(const DemoOptions& options) {
  return jump("ur5e_vision", options, true);
}

}  // namespace mjarm::app
