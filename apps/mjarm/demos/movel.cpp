#include <variant>

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
  const DemoValues& values = options.values;
  const Result<Robot> robot = load_demo_robot("movel", options, tutorial_dof(values));
  if (!robot) return fail(robot.error());
  const auto read = tutorial_seed(values, robot->arm);
  if (!read) return fail(read.error());
  std::vector<double> seed = *read;
  Result<std::unique_ptr<session::Stage>> opened = session::Stage::open("movel", options, *robot);
  if (!opened) return fail(std::move(opened.error()));
  session::Stage& stage = **opened;
  const Pose goal = changed(tutorial_goal(), values.to, values);
  if (values.from) {
    const auto begin = free_solver(stage.robot()).solve({*values.from, goal.R}, seed);
    if (!begin) return stage.refuse(name(begin.error().code), describe(begin.error(), stage.arm()));
    seed.assign(begin->q.begin(), begin->q.end());
  }
  const Result<Curve> line = Curve::line(fk(stage.arm(), seed), goal);
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

/// The ends of the program's first line as the user wants them.
Result<void> change_ends(program::Program& program, const DemoValues& values) {
  auto* move = std::get_if<program::MoveL>(&program.instructions.front().what);
  if (move == nullptr) return {};
  move->goal.X_FT = changed(move->goal.X_FT, values.to, values);
  if (!values.from) return {};
  const Pose begin{*values.from, move->goal.X_FT.R};
  program.instructions.insert(program.instructions.begin(), program::move_j(begin));
  return {};
}

}  // namespace

Result<Report> run_movel(const DemoOptions& options) {
  if (options.guide) return run_follower(options);
  return run_program_demo("movel", options,
                          [&values = options.values](program::Program& program, const Arm&) {
                            return change_ends(program, values);
                          });
}

}  // namespace mjarm::app
