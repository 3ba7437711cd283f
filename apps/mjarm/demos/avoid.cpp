#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "apps/mjarm/commands/program_run.hpp"
#include "apps/mjarm/demos/demo_stage.hpp"
#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/demos/program_demo.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/render/overlay_shapes.hpp"
#include "mjarm/session/posture_rods.hpp"

namespace mjarm::app {
namespace {

constexpr render::Rgba kHit = {0.90F, 0.15F, 0.10F, 0.5F};
constexpr render::Rgba kNearest = {0.95F, 0.65F, 0.10F, 1};
constexpr double kStep = 0.005;  // [rad] between configurations that are looked at

/// Where a motion touches something first.
struct FirstTouch {
  JointVec q;
  ContactPoint contact;
  double share = 0;  ///< of the time
};

/// The places of a motion that are looked at, as shares of its time.
std::vector<double> looks(const Trajectory& motion, const JointLimits& limits) {
  const auto count =
      static_cast<int>(std::ceil(motion.duration() * limits.velocity.maxCoeff() / kStep));
  std::vector<double> out{0};
  for (int i = 1; i <= count; ++i) out.push_back(static_cast<double>(i) / count);
  return out;
}

std::optional<FirstTouch> first_touch(ExactChecker& checker, const Trajectory& motion,
                                      const JointLimits& limits) {
  for (const double share : looks(motion, limits)) {
    const JointVec q = motion.at(share * motion.duration()).q;
    const auto report = checker.check(as_span(q));
    if (report && !report->free) return FirstTouch{q, report->contacts.front(), share};
  }
  return std::nullopt;
}

/// The two geoms that come nearest to each other during the planned ways round.
std::optional<NearestPair> nearest_pair(ExactChecker& checker, const program::ProgramPlan& plan,
                                        const JointLimits& limits) {
  std::optional<NearestPair> out;
  for (const PlannedMove& move : plan.moves) {
    if (move.corners.empty()) continue;
    for (const double share : looks(move.trajectory, limits)) {
      const JointVec q = move.trajectory.at(share * move.trajectory.duration()).q;
      const auto report = checker.check(as_span(q));
      if (!report || !report->nearest) continue;
      if (!out || report->nearest->distance < out->distance) out = report->nearest;
    }
  }
  return out;
}

/// Tries the straight way of the tool to where the last way round ends, in geometry alone, and
/// tells and draws what it would hit.
Result<void> try_straight(session::Stage& stage, ExactChecker& checker, const PlannedMove& round,
                          Report& report) {
  const JointVec q = round.corners[round.passed.empty() ? 0 : round.passed.back()];
  const Result<Curve> line =
      Curve::line(fk(stage.arm(), as_span(q)), fk(stage.arm(), as_span(round.corners.back())));
  if (!line) return fail(line.error());
  const auto straight = plan_tool_motion(reach_solver(stage.robot()), *line, as_span(q), {});
  if (!straight) {
    log_info(text(msg::demo_avoid_no_line, describe(straight.error(), stage.arm())));
    return {};
  }
  const auto touch = first_touch(checker, straight->trajectory, stage.arm().limits);
  if (!touch) {
    log_info(text(msg::demo_avoid_free));
    return {};
  }
  const Eigen::Vector3d p_W = fk(stage.arm(), as_span(touch->q)).p;
  const double way = (p_W - line->at(0).p).norm();
  const ContactPoint& contact = touch->contact;
  log_info(text(msg::demo_avoid_hits, contact.pair.geom1, contact.pair.geom2, way, line->length(),
                contact.point_W.x(), contact.point_W.y(), contact.point_W.z()));
  report.facts.push_back({"straight_reason", "collision"});
  report.facts.push_back({"straight_hits", contact.pair.geom1 + " - " + contact.pair.geom2});
  report.facts.push_back({"straight_free", way / line->length()});
  render::Overlay overlay;
  render::add_planned_path(overlay, std::vector<Pose>{line->at(0), line->at(line->end())});
  overlay.spheres.push_back({.p_W = contact.point_W, .radius = 0.015, .color = {0.9F, 0, 0, 1}});
  overlay.labels.push_back({contact.point_W, contact.pair.geom1 + " - " + contact.pair.geom2});
  session::add_posture_rods(overlay, stage.arm(), touch->q, kHit, 0.012);
  stage.show().add(overlay);
  return {};
}

/// Tells of the way round and draws where the arm comes nearest to something on it.
void tell_round(session::Stage& stage, ExactChecker& checker, const program::ProgramPlan& plan,
                const PlannedMove& round, Report& report) {
  double length = 0;
  for (std::size_t i = 1; i < round.corners.size(); ++i) {
    length += (round.corners[i] - round.corners[i - 1]).norm();
  }
  report.facts.push_back({"edges", static_cast<double>(round.corners.size() - 1)});
  report.facts.push_back({"cost", length});
  log_info(text(msg::demo_avoid_round, round.corners.size() - 1, length,
                round.trajectory.duration(), round.stopping.value_or(round.trajectory.duration())));
  const auto nearest = nearest_pair(checker, plan, stage.arm().limits);
  if (!nearest) return;
  const GeomPair& pair = nearest->pair;
  report.facts.push_back({"clearance", nearest->distance});
  report.facts.push_back({"nearest", pair.geom1 + " - " + pair.geom2});
  log_info(text(msg::demo_avoid_nearest, pair.geom1, pair.geom2, 1e3 * nearest->distance));
  render::Overlay overlay;
  overlay.lines.push_back(
      {.points_W = {nearest->p1_W, nearest->p2_W}, .width = 0.006, .color = kNearest});
  for (const Eigen::Vector3d& p_W : {nearest->p1_W, nearest->p2_W}) {
    overlay.spheres.push_back({.p_W = p_W, .radius = 0.008, .color = kNearest});
  }
  stage.show().add(overlay);
}

/// The program in its own scene.
Result<program::LoadedProgram> plan_in_its_scene(const DemoOptions& options) {
  if (options.robot.robot != "ur5e" || options.meshes) {
    return fail(Errc::usage, text(msg::demo_avoid_scene));
  }
  Result<program::Program> program = demo_program("avoid");
  if (!program) return fail(std::move(program.error()));
  if (!options.robot.tip.empty()) program->tool = options.robot.tip;
  if (options.control) program->control = options.control;
  Result<Robot> robot = program::load_program_robot(*program, "avoid.yaml");
  if (!robot) return fail(std::move(robot.error()));
  return program::plan_loaded("avoid.yaml", std::move(*program), std::move(*robot), interrupted);
}

}  // namespace

Result<Report> run_avoid(const DemoOptions& options) {
  constexpr double kTolerance = 5e-4;  // [m]
  const Result<program::LoadedProgram> loaded = plan_in_its_scene(options);
  if (!loaded) return fail(loaded.error());
  const Result<std::unique_ptr<session::Stage>> opened =
      session::Stage::open("avoid", options, loaded->robot);
  if (!opened) return fail(opened.error());
  session::Stage& stage = **opened;
  const program::ProgramPlan& plan = loaded->plan;
  if (!plan.ok()) {
    return stage.refuse(plan.faults.front().reason, program::first_fault(*loaded).what);
  }
  Report report;
  ExactChecker checker(loaded->robot.model, loaded->robot.arm, {.margin = 0.3});
  const auto round = std::find_if(plan.moves.rbegin(), plan.moves.rend(),
                                  [](const PlannedMove& move) { return !move.corners.empty(); });
  if (round != plan.moves.rend()) {
    if (auto done = try_straight(stage, checker, *round, report); !done) {
      return fail(std::move(done.error()));
    }
    tell_round(stage, checker, plan, *round, report);
  }
  return run_plan(stage, *loaded, kTolerance, std::move(report));
}

}  // namespace mjarm::app
