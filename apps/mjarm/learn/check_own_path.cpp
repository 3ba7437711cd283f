#include <cmath>
#include <limits>
#include <variant>

#include "apps/mjarm/learn/exercise.hpp"
#include "apps/mjarm/learn/program_steps.hpp"
#include "apps/mjarm/messages/learn.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/program/load_program.hpp"

namespace mjarm::app {
namespace {

// What the page itself writes, and how.
constexpr const char* kPageName = "ANNA";
constexpr double kPageHeight = 0.1;  // [m]
const Eigen::Vector3d kPageRight(1, 0, 0), kPageUp(0, 0, 1);

void judge_text(const program::Program& program, LearnReport& out) {
  bool any = false, other = false;
  for (const program::Instruction* step : steps_of(program)) {
    const auto* const written = std::get_if<program::DrawText>(&step->what);
    if (written == nullptr) continue;
    any = true;
    if (written->text == kPageName) {
      out.wrong(text(msg::learn_path_page_name, step->place.line, kPageName));
      return;
    }
    const Eigen::Matrix3d& R = written->plane.X_FT.R;
    const bool page_plane = (R.col(0) - kPageRight).norm() < 1e-6 &&
                            (R.col(1) - kPageUp).norm() < 1e-6 && written->plane.frame.name.empty();
    other = other || !page_plane || written->height > kPageHeight + 1e-9;
  }
  if (!any) {
    out.wrong(text(msg::learn_path_no_text));
    return;
  }
  out.right(text(msg::learn_path_own_text));
  if (!other) out.note(text(msg::learn_path_same_plane));
}

/// A straight leg of the tool, and how far the mean of the joint values at its ends is from its
/// middle.
struct StraightLeg {
  double length = 0, off = 0;  // [m]
};

/// Joint values of the motion where its tool is nearest to `p_W`, not before the time `from`, which
/// becomes that time.
JointVec values_at(const PlannedMove& move, const Arm& arm, const Eigen::Vector3d& p_W,
                   double& from) {
  constexpr int kSamples = 2000;
  const double begin = from, duration = move.trajectory.duration();
  double least = std::numeric_limits<double>::infinity();
  JointVec best;
  for (int i = 0; i <= kSamples; ++i) {
    const double t = begin + (duration - begin) * i / kSamples;
    const JointVec q = move.trajectory.at(t).q;
    const double distance = (fk(arm, as_span(q)).p - p_W).norm();
    if (distance < least - 1e-9) {
      least = distance;
      best = q;
      from = t;
    }
  }
  return best;
}

StraightLeg leg_of(const PlannedMove& move, const Arm& arm, std::size_t corner) {
  const Eigen::Vector3d begin = move.points[corner].X_WT.p, end = move.points[corner + 1].X_WT.p;
  double from = 0;
  const JointVec q0 = values_at(move, arm, begin, from), q1 = values_at(move, arm, end, from);
  const JointVec middle = 0.5 * (q0 + q1);
  return {(end - begin).norm(), (fk(arm, as_span(middle)).p - 0.5 * (begin + end)).norm()};
}

/// For the curious: what interpolating joint values would make of the longest straight leg.
void tell_longest_leg(const program::ProgramPlan& plan, LearnReport& out) {
  const PlannedMove* longest = nullptr;
  std::size_t at = 0;
  double length = 0.01;  // [m] shorter ones tell nothing
  for (const PlannedMove& move : plan.moves) {
    if (move.word != "movel" && move.word != "polyline") continue;
    for (std::size_t i = 0; i + 1 < move.points.size(); ++i) {
      const double leg = (move.points[i + 1].X_WT.p - move.points[i].X_WT.p).norm();
      if (!(leg > length)) continue;
      longest = &move;
      at = i;
      length = leg;
    }
  }
  if (longest == nullptr) return;
  const StraightLeg leg = leg_of(*longest, plan.arms[longest->tool], at);
  out.note(text(msg::learn_path_leg, leg.length, longest->place.line, 1e3 * leg.off));
}

double tool_way(const program::ProgramPlan& plan) {
  double length = 0;
  for (const PlannedMove& move : plan.moves) {
    if (move.curve) length += move.curve->length();
  }
  return length;
}

}  // namespace

Result<LearnReport> check_own_path(const Exercise& exercise) {
  const Result<program::LoadedProgram> loaded = program::load_program(exercise.file, interrupted);
  if (!loaded) return fail(loaded.error());
  LearnReport out;
  judge_text(loaded->program, out);
  const program::ProgramPlan& plan = loaded->plan;
  if (!plan.ok()) {
    out.wrong(program::line_of(*loaded, plan.faults.front()));
    out.note(text(msg::learn_program_see_all, exercise.file));
    return out;
  }
  out.right(text(msg::learn_path_right, plan.moves.size(), tool_way(plan), plan.duration()));
  tell_longest_leg(plan, out);
  return out;
}

}  // namespace mjarm::app
