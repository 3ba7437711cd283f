#include <array>
#include <string_view>

#include "apps/mjarm/commands/rule_options.hpp"
#include "apps/mjarm/demos/demo_stage.hpp"
#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/collision/exact.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/program/start_posture.hpp"

namespace mjarm::app {
namespace {

constexpr double kSide = 0.1;  // [m]

/// A plane of the world, by its two directions.
struct Plane {
  std::string_view name;
  Eigen::Vector3d right;
  Eigen::Vector3d up;
};

std::array<Plane, 3> planes() {
  using Eigen::Vector3d;
  return {{{"xy", Vector3d::UnitX(), Vector3d::UnitY()},
           {"xz", Vector3d::UnitX(), Vector3d::UnitZ()},
           {"yz", Vector3d::UnitY(), Vector3d::UnitZ()}}};
}

/// The corners of the square round `X_WT`, the first one again at the end.
std::vector<Pose> square(const Pose& X_WT, const Plane& plane) {
  constexpr double kHalf = kSide / 2;
  std::vector<Pose> corners;
  for (const auto& [right, up] : {std::pair(-kHalf, -kHalf), std::pair(kHalf, -kHalf),
                                  std::pair(kHalf, kHalf), std::pair(-kHalf, kHalf)}) {
    corners.push_back({X_WT.p + right * plane.right + up * plane.up, X_WT.R});
  }
  corners.push_back(corners.front());
  return corners;
}

/// A square that can be drawn, and where it starts.
struct Choice {
  program::StartPosture start;
  std::string_view plane;
  std::vector<Pose> corners;
  ToolMotion motion;
};

/// The first square that can be drawn: postures in their order, planes in theirs. Each posture that
/// fails in every plane is told.
Result<Choice, MotionFailure> choose(const IkSolver& ik,
                                     std::span<const program::StartPosture> starts) {
  MotionFailure nearest;
  for (const program::StartPosture& start : starts) {
    const Pose X_WT = fk(ik.arm(), as_span(start.q));
    for (const Plane& plane : planes()) {
      std::vector<Pose> corners = square(X_WT, plane);
      const Result<Curve> curve = Curve::polyline(corners);
      if (!curve) return fail(MotionFailure{{}, curve.error()});
      auto motion = plan_tool_motion(ik, *curve, as_span(start.q));
      if (motion) return Choice{start, plane.name, std::move(corners), std::move(*motion)};
      log_debug(text(msg::demo_square_not, plane.name, describe(motion.error(), ik.arm())));
      const bool farther = motion.error().path && (!nearest.path || motion.error().path->fraction >
                                                                        nearest.path->fraction);
      if (farther || motion.error().timing) nearest = std::move(motion.error());
    }
  }
  return fail(std::move(nearest));
}

/// What may touch besides what the file allows.
Result<ExactChecker> checker_of(const Robot& robot, const std::vector<std::string>& allow) {
  return rules_of({.hold = {}, .allow = allow}, robot, as_span(robot.arm.home))
      .and_then([&](const ContactRules& rules) {
        return ExactChecker::create(robot.model, robot.arm, {.rules = rules});
      });
}

/// Why there is no posture to start from, and what may end it.
std::string no_start(ExactChecker& checker, const Arm& arm) {
  const Result<CollisionReport> at_home = checker.check(as_span(arm.home));
  if (!at_home || at_home->contacts.empty()) return text(msg::demo_no_start);
  const GeomPair& pair = at_home->contacts.front().pair;
  return text(msg::demo_no_start) + text(msg::demo_home_touches, pair.body1, pair.body2);
}

void tell(const session::Stage& stage, const Choice& choice) {
  const Pose X_WT = fk(stage.arm(), as_span(choice.start.q));
  std::string q;
  append_numbers(q, as_span(choice.start.q));
  log_info(text(choice.start.is_home ? msg::demo_start_home : msg::demo_start_picked, q,
                stage.arm().tip, X_WT.p.x(), X_WT.p.y(), X_WT.p.z()));
  log_info(text(msg::demo_square_plane, choice.plane));
}

}  // namespace

Result<Report> run_square(const DemoOptions& options) {
  const Result<Robot> robot = load_demo_robot("square", options);
  if (!robot) return fail(robot.error());
  Result<ExactChecker> checker = checker_of(*robot, options.allow);
  if (!checker) return fail(std::move(checker.error()));
  Result<std::unique_ptr<session::Stage>> opened = session::Stage::open("square", options, *robot);
  if (!opened) return fail(std::move(opened.error()));
  session::Stage& stage = **opened;
  const IkSolver ik(stage.arm(), {.task = task_for(stage.arm()), .valid = checker->predicate()});
  Rng rng(1);
  const std::vector<program::StartPosture> starts =
      program::start_postures(stage.arm(), ik.options().valid, rng);
  if (starts.empty()) return stage.refuse("collision", no_start(*checker, stage.arm()));
  const Result<Choice, MotionFailure> choice = choose(ik, starts);
  if (!choice) return stage.refuse(choice.error());
  tell(stage, *choice);

  const ToolMotion& motion = choice->motion;
  log_info(text(msg::demo_plan, motion.curve.length(), motion.trajectory.duration(),
                motion.path.max_step()));
  stage.show().add_line(choice->corners);
  stage.run().start_at(as_span(choice->start.q));
  Report report;
  stage.tell(motion, report);
  const ControlMode mode = stage.control(ControlMode::computed_torque);
  const Result<void> done = stage.move([&](MotionRun& run) {
    return run.approach(as_span(motion.path.q.front()), mode).and_then([&] {
      return run.follow(motion.trajectory, mode, 0.3, &motion.curve);
    });
  });
  if (!done) return fail(done.error());
  return stage.finish(std::move(report));
}

}  // namespace mjarm::app
