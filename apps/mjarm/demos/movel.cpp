#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/demos/stage.hpp"
#include "apps/mjarm/demos/tutorial.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/path/solve_path.hpp"

namespace mjarm::app {
namespace {

constexpr int kPoses = 100;

/// The tutorial's follower: every pose is commanded until the tool is within 10 mm of it.
Result<void> follow_as_tutorial(Stage& stage, const JointPath& path, std::span<const Pose> poses,
                                const Curve& line) {
  std::vector<Eigen::Vector3d> points;
  for (const Pose& pose : poses) points.push_back(pose.p);
  return stage.wait_through(path.q, points, stage.control(ControlMode::servo), &line);
}

}  // namespace

Result<Report> run_movel(const DemoOptions& options) {
  Result<std::unique_ptr<Stage>> opened = Stage::open("movel", options, 6);
  if (!opened) return fail(std::move(opened.error()));
  Stage& stage = **opened;
  const std::vector<double> seed = tutorial_seed();
  const Result<Curve> line = Curve::line(fk(stage.arm(), seed), tutorial_goal());
  if (!line) return fail(line.error());

  std::vector<Pose> poses;
  std::vector<double> s;
  for (int i = 0; i < kPoses; ++i) {
    s.push_back(line->length() * i / (kPoses - 1));
    poses.push_back(line->at(s.back()));
  }
  stage.show().add_points(poses, 2);
  const Result<JointPath, PathFailure> path =
      solve_path(stage.ik(), poses, s, seed, {.keep_start = true});
  if (!path) return stage.refuse({.path = path.error(), .timing = {}});
  const Result<ToolMotion, MotionFailure> motion =
      plan_tool_motion(stage.ik(), *line, seed, {.path = {.keep_start = true}});
  if (!motion) return stage.refuse(motion.error());

  stage.start_at(seed);
  Report report;
  report.max_joint_step = path->max_step();
  stage.tell(*motion, report);
  auto done = options.guide ? follow_as_tutorial(stage, *path, poses, *line)
                            : stage.run(motion->trajectory,
                                        stage.control(ControlMode::computed_torque), 0.3, &*line);
  if (!done) return fail(std::move(done.error()));
  return stage.finish(std::move(report));
}

}  // namespace mjarm::app
