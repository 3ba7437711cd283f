#include "mjarm/session/program_scene.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "mjarm/render/overlay_shapes.hpp"

namespace mjarm::session {
namespace {

constexpr render::Rgba kJointMoveColor = {0.55F, 0.55F, 0.60F, 1};

}  // namespace

render::Pen pen_of(MotionPart part) {
  if (part == MotionPart::approach) return render::Pen::up;
  return part == MotionPart::travel ? render::Pen::travel : render::Pen::down;
}

void add_planned_paths(render::Overlay& overlay, const MotionPlan& plan) {
  // A tool that presses is not where its motion is: add_ink() shows where it was.
  if (plan.presses()) return;
  std::vector<std::vector<Pose>> paths;
  for (const PlannedMove& move : plan.moves) {
    if (!move.curve && move.corners.empty()) continue;
    paths.push_back(planned_tool_path(move, plan.arms[move.tool]));
  }
  render::add_planned_paths(overlay, paths);
}

void add_ink(render::Overlay& overlay, std::span<const InkPoint> ink) {
  constexpr double kWidth = 0.002, kApart = 5e-4;  // [m]
  constexpr render::Rgba kBlack = {0.08F, 0.08F, 0.10F, 1};
  std::size_t move = 0;
  for (const InkPoint& point : ink) {
    if (overlay.lines.empty() || &point == ink.data() || point.move != move) {
      overlay.lines.push_back({.width = kWidth, .color = kBlack});
    }
    move = point.move;
    std::vector<Eigen::Vector3d>& line = overlay.lines.back().points_W;
    if (line.empty() || (point.X_WT.p - line.back()).norm() > kApart) line.push_back(point.X_WT.p);
  }
}

ProgramScene::ProgramScene(const program::LoadedProgram& loaded, int first_figure)
    : loaded_(&loaded), figures_(loaded.robot.arm, first_figure, {true, true}) {
  std::vector<std::vector<Pose>> curves, joint_moves;
  for (const PlannedMove& move : loaded.plan.moves) {
    std::vector<Pose> X_WT = planned_tool_path(move, loaded.plan.arms[move.tool]);
    if (X_WT.size() > 1) (move.curve ? curves : joint_moves).push_back(std::move(X_WT));
  }
  render::add_planned_paths(paths_, curves);
  render::add_planned_paths(paths_, joint_moves, {.color = kJointMoveColor});
}

void ProgramScene::add(const Sim& sim, double time, std::size_t motion, const JointVec& q_ref) {
  const program::ProgramPlan& plan = loaded_->plan;
  if (plan.moves.empty()) return;
  const std::size_t move = std::min(motion, plan.moves.size() - 1);
  const Arm& arm = plan.arms[plan.moves[move].tool];
  trail_.set_pen(pen_of(plan.part(move)));
  trail_.add(sim.tool(arm).p);
  figures_.add(sim, time, arm, q_ref);
  has_curves_ = true;
}

void ProgramScene::clear() {
  trail_.clear();
  figures_.clear();
  has_curves_ = false;
}

render::Overlay ProgramScene::overlay(const Choice& choice,
                                      std::optional<std::size_t> motion) const {
  render::Overlay out;
  if (choice.paths) out = paths_;
  if (choice.trail) trail_.draw(out);
  const std::vector<PlannedMove>& moves = loaded_->plan.moves;
  if (choice.goal && motion && *motion < moves.size()) {
    const Trajectory& way = moves[*motion].trajectory;
    out.ghosts.push_back(render::ghost_of(loaded_->robot.arm, as_span(way.at(way.duration()).q)));
  }
  return out;
}

std::vector<view::LivePlot> ProgramScene::plots() const {
  return has_curves_ ? figures_.plots() : std::vector<view::LivePlot>();
}

}  // namespace mjarm::session
