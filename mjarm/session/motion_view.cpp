#include "mjarm/session/motion_view.hpp"

#include <algorithm>

#include "mjarm/render/clear_view.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::session {
namespace {

constexpr std::size_t kPostures = 30;  ///< that are looked at, about

}  // namespace

MotionOutline outline_of(const MotionPlan& plan, double until) {
  MotionOutline out{{plan.q_start}};
  const double period = std::max(plan.duration() / kPostures, 1e-3);
  double begin = 0;  // [s] of the move
  for (std::size_t i = 0; i < plan.moves.size(); ++i) {
    const PlannedMove& move = plan.moves[i];
    const double duration = move.trajectory.duration();
    for (double t = 0; t < duration && begin + t <= until; t += period) {
      out.postures.push_back(move.trajectory.at(t).q);
    }
    if (begin <= until && begin + duration > until) {
      out.postures.push_back(move.trajectory.at(until - begin).q);
    }
    begin += duration;
    if (plan.part(i) != MotionPart::work) continue;
    if (!out.right_W) out.right_W = move.right_W;
    for (const Pose& X_WT : planned_tool_path(move, plan.arms[move.tool])) {
      out.marks_W.push_back(X_WT.p);
    }
  }
  if (begin <= until) out.postures.push_back(plan.q_end());
  return out;
}

MotionOutline outline_of(const Recorder& recorder) {
  MotionOutline out;
  const std::size_t rows = recorder.size();
  for (std::size_t k = 0; k <= kPostures && rows > 0; ++k) {
    const RecordRow row = recorder.row(k * (rows - 1) / kPostures);
    out.postures.push_back(row.q);
    out.marks_W.push_back(row.X_WT.p);
  }
  return out;
}

render::CameraView motion_view(const Model& model, const Arm& arm, const MotionOutline& outline,
                               bool film, double aspect) {
  Sim sim(model);
  sim.reset_home();
  std::vector<Snapshot> moments;
  // A picture shows the end only.
  const std::size_t first = film || outline.postures.empty() ? 0 : outline.postures.size() - 1;
  for (std::size_t i = first; i < outline.postures.size(); ++i) {
    sim.place(arm, as_span(outline.postures[i]));
    moments.push_back(sim.snapshot());
  }
  render::ViewSubject subject{
      render::moving_parts(model, moments), outline.marks_W, {}, outline.right_W};
  for (const Eigen::Vector3d& p_W : outline.marks_W) subject.balls.push_back({p_W, 0});
  if (!moments.empty()) subject.moments.push_back(moments.back());
  if (film && !moments.empty()) {
    for (const std::size_t part : {1, 2})
      subject.moments.push_back(moments[part * moments.size() / 3]);
  }
  return render::clear_view(model, subject, aspect);
}

}  // namespace mjarm::session
