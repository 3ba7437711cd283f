#include "apps/mjarm/demos/demo_stage.hpp"
#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/demos/program_demo.hpp"
#include "apps/mjarm/demos/tutorial.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/path/solve_path.hpp"

namespace mjarm::app {
namespace {

/// The tutorial's follower: 100 poses, each commanded until the tool is within 10 mm of it.
Result<Report> run_follower(const DemoOptions& options) {
  Result<std::unique_ptr<session::Stage>> opened = open_stage("movel", options, 6);
  if (!opened) return fail(std::move(opened.error()));
  session::Stage& stage = **opened;
  const std::vector<double> seed = tutorial_seed();
  const Result<Curve> line = Curve::line(fk(stage.arm(), seed), tutorial_goal());
  if (!line) return fail(line.error());

  constexpr int kPoses = 100;
  std::vector<Pose> poses;
  std::vector<double> s;
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < kPoses; ++i) {
    s.push_back(line->length() * i / (kPoses - 1));
    poses.push_back(line->at(s.back()));
    points.push_back(poses.back().p);
  }
  stage.show().add_points(poses, 2);
  const Result<JointPath, PathFailure> path = solve_path(free_solver(stage.robot()), poses, s, seed,
                                                         {.keep_start = true, .stop = interrupted});
  if (!path) return stage.refuse({.path = path.error(), .timing = {}});

  stage.run().start_at(seed);
  Report report;
  report.max_joint_step = path->max_step();
  const ControlMode mode = stage.control(ControlMode::servo);
  auto done =
      stage.move([&](MotionRun& run) { return run.wait_through(path->q, points, mode, &*line); });
  if (!done) return fail(std::move(done.error()));
  return stage.finish(std::move(report));
}

}  // namespace

Result<Report> run_movel(const DemoOptions& options) {
  return options.guide ? run_follower(options) : run_program_demo("movel", options);
}

}  // namespace mjarm::app
