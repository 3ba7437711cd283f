#include <algorithm>
#include <utility>

#include "mjarm/core/messages/program.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/identification/excitation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/path/joint_path.hpp"
#include "mjarm/program/detour_chain_internal.hpp"
#include "mjarm/program/lifted_detour_internal.hpp"
#include "mjarm/program/step_motion_internal.hpp"
#include "mjarm/program/step_planner_internal.hpp"
#include "mjarm/trajectory/tool_motion.hpp"

namespace mjarm::program::detail {
namespace {

constexpr std::size_t kMaxAnswers = 16;  ///< to one pose that are tried

Attempt failed(std::size_t i, const Stand& at, PlanFault fault) {
  return {{}, i, at, std::move(fault)};
}

PlanFault motion_fault(std::size_t i, const Arm& arm, const MotionFailure& failure) {
  return {i, failure.path ? std::string(name(failure.path->code)) : "timing",
          describe(failure, arm)};
}

}  // namespace

Attempt StepPlanner::from(std::size_t i, const Stand& at) {
  Attempt out = begin(i, at);
  if (!out.pending.empty()) tool_moves(out);
  return out;
}

Attempt StepPlanner::only(std::size_t i, const Stand& at) {
  Attempt out = begin(i, at);
  await(out, 0);
  return out;
}

/// Plans step `i`; motions may be pending.
Attempt StepPlanner::begin(std::size_t i, const Stand& at) {
  switch (steps_[i].kind) {
    case Step::Kind::joints:
      return to_joints(i, at);
    case Step::Kind::pose:
      return to_pose(i, at);
    case Step::Kind::curve:
      return to_curve(i, at);
    case Step::Kind::line:
    case Step::Kind::arc:
      return tool_move(i, at);
    case Step::Kind::wait:
      return rest(i, at, steps_[i].seconds);
    case Step::Kind::grip:
      return grip(i, at);
    case Step::Kind::excite:
      return excite(i, at);
    case Step::Kind::plan:
    case Step::Kind::look:  // ProgramPlanner's
    case Step::Kind::pick:
    case Step::Kind::place:
      break;
  }
  return detour(i, at);
}

PlannedMove StepPlanner::begun(std::size_t i, std::size_t scene) const {
  const Step& step = steps_[i];
  PlannedMove move;
  move.word = step.word;
  move.place = step.place;
  move.tool = step.tool;
  move.attached = places_.attached(scene);
  move.allowed = places_.allowed();
  move.payload = step.payload;
  return move;
}

Attempt StepPlanner::rest(std::size_t i, const Stand& at, double seconds) const {
  const JointState still = JointState::at_rest(at.q);
  const bool moment = !(seconds > 0);
  Result<Trajectory> trajectory = moment ? Trajectory::through({0.0}, {still})
                                         : Trajectory::through({0, seconds}, {still, still});
  if (!trajectory) return failed(i, at, {i, "bad_input", trajectory.error().what});
  PlannedMove move = begun(i, at.scene);
  move.trajectory = std::move(*trajectory);
  return {{std::move(move)}, i + 1, at, {}};
}

/// To and fro about where the arm stands, free of contact all along.
Attempt StepPlanner::excite(std::size_t i, const Stand& at) const {
  constexpr double kLook = 0.01;  // [s] from look to look
  const Step& step = steps_[i];
  const ToolPtr with = tool(i, at);
  Result<Trajectory> motion =
      free_excitation(places_.model(), with->arm, at.q, with->judge.clearance(),
                      {.seconds = step.seconds, .seed = step.seed});
  if (!motion) return failed(i, at, {i, "collision", motion.error().what});
  PlannedMove move = begun(i, at.scene);
  std::vector<JointVec> way;
  for (double t = 0; t < step.seconds; t += kLook) way.push_back(motion->at(t).q);
  move.measures = with->judge.measure(with->ik, way);
  if (const auto fault = with->judge.touches(*move.measures)) {
    return failed(i, at, {i, "collision", text(msg::program_move_touches, *fault)});
  }
  move.trajectory = std::move(*motion);
  return {{std::move(move)}, i + 1, at, {}};
}

/// What stands where, and what the arm carries, is another matter from then on.
Attempt StepPlanner::grip(std::size_t i, const Stand& at) {
  constexpr double kSeconds = 1;  // [s] for the fingers to get there
  const Result<std::size_t> scene = places_.gripped(at, steps_[i].close);
  if (!scene) return failed(i, at, {i, "not_available", scene.error().what});
  Attempt attempt = rest(i, {at.q, *scene}, kSeconds);
  if (!attempt.fault) attempt.moves.back().close = steps_[i].close;
  return attempt;
}

/// A joint move to `goal`; adds to `moves`.
std::optional<PlanFault> StepPlanner::joint_move(std::size_t i, const Stand& at,
                                                 const JointVec& goal, const char* word,
                                                 std::vector<PlannedMove>& moves) const {
  const ToolPtr with = tool(i, at);
  if (const auto fault = with->judge.beyond_limits(goal)) {
    return PlanFault{i, "joint_limit", *fault};
  }
  Result<Trajectory> trajectory = time_joint_move(as_span(at.q), as_span(goal), with->arm.limits,
                                                  {.joint_share = steps_[i].share});
  if (!trajectory) return PlanFault{i, "bad_input", trajectory.error().what};
  PlannedMove move = begun(i, at.scene);
  if (word != nullptr) move.word = word;
  const std::vector<JointVec> way = joint_way(at.q, goal);
  move.measures = with->judge.measure(with->ik, way);
  if (const auto fault = with->judge.touches(*move.measures)) {
    return PlanFault{i, "collision", text(msg::program_move_touches, *fault)};
  }
  move.trajectory = std::move(*trajectory);
  moves.push_back(std::move(move));
  return std::nullopt;
}

Attempt StepPlanner::to_joints(std::size_t i, const Stand& at) {
  Attempt out{{}, i, at, {}};
  out.fault = joint_move(i, at, steps_[i].q, nullptr, out.moves);
  if (!out.fault) {
    out.next = i + 1;
    out.at.q = steps_[i].q;
  }
  return out;
}

/// To the answer from which the tool moves that follow go farthest; of equals to the first.
Attempt StepPlanner::to_pose(std::size_t i, const Stand& at) {
  const auto answers = tool(i, at)->answers.to(steps_[i], steps_[i].X_WT, at.q);
  if (!answers) return failed(i, at, {i, answers.error().reason, answers.error().what});
  std::optional<Attempt> best;
  for (std::size_t k = 0; k < std::min(answers->q.size(), kMaxAnswers); ++k) {
    Attempt attempt{{}, i, at, {}};
    attempt.fault = joint_move(i, at, answers->q[k], nullptr, attempt.moves);
    if (!attempt.fault) {
      attempt.next = i + 1;
      attempt.at.q = answers->q[k];
      tool_moves(attempt);
    }
    if (!attempt.fault) return attempt;
    if (!best || attempt.next > best->next) best = std::move(attempt);
  }
  return std::move(*best);
}

/// Round what stands in the way, to a goal in good posture if that can be had.
Attempt StepPlanner::detour(std::size_t i, const Stand& at) {
  const ToolPtr with = tool(i, at);
  const auto goals = with->answers.goals(steps_[i], with->detours, at.q);
  if (!goals) return failed(i, at, {i, goals.error().reason, goals.error().what});
  Attempt best = detour_to(i, at, goals->good_ones());
  if (!best.fault || goals->others().empty()) return best;
  Attempt other = detour_to(i, at, goals->others());
  return !other.fault || other.next > best.next ? std::move(other) : std::move(best);
}

/// The same to one of `to`: to that from which the tool moves that follow go farthest.
Attempt StepPlanner::detour_to(std::size_t i, const Stand& at, std::span<const JointVec> to) {
  const Step& step = steps_[i];
  const ToolPtr with = tool(i, at);
  std::vector<JointVec> goals(to.begin(), to.end());
  const auto move_to = [&](const JointVec& from, const JointVec& goal, const char* word,
                           std::vector<PlannedMove>& moves) {
    return !joint_move(i, {from, at.scene}, goal, word, moves);
  };
  std::optional<Attempt> best;
  for (std::size_t k = 0; k < kMaxAnswers && !goals.empty(); ++k) {
    auto found = plan_lifted(*with, at.q, goals, {step.share, step.clearance}, move_to);
    if (!found && best) break;
    if (!found) return failed(i, at, {i, found.error().reason, found.error().what});
    Attempt attempt{{}, i + 1, {goals[found->goal], at.scene}, {}};
    const std::size_t goal = found->goal;
    if (found->before.empty() && found->after.empty()) attempt.detour = found->motion.paths.front();
    std::ranges::move(found->before, std::back_inserter(attempt.moves));
    put(std::move(found->motion), attempt.moves.emplace_back(begun(i, at.scene)));
    std::ranges::move(found->after, std::back_inserter(attempt.moves));
    tool_moves(attempt);
    if (!attempt.fault || (!best && is_closed(attempt))) return attempt;
    if (!best || attempt.next > best->next) best = std::move(attempt);
    goals.erase(goals.begin() + static_cast<std::ptrdiff_t>(goal));
  }
  return std::move(*best);
}

/// Whether the way of the tool that ended `attempt` can be gone from no answer to its first pose:
/// then those to an earlier pose need not be tried one by one.
bool StepPlanner::is_closed(const Attempt& attempt) const {
  const PlanFault& fault = *attempt.fault;
  if (!fault.way || is_stopped(options_.stop)) return false;
  ClosedWay way = *fault.way;
  way.options.path.keep_start = false;
  return !solve_curve(tool(fault.step, attempt.at)->ik, way.curve, as_span(way.q_start),
                      way.options);
}

/// Along a whole curve, from the answer to its first pose from which it and the tool moves that
/// follow go farthest.
Attempt StepPlanner::to_curve(std::size_t i, const Stand& at) {
  const Step& step = steps_[i];
  const Pose X_first = step.curve->at(0);
  const ToolPtr with = tool(i, at);
  const bool there = same_pose(fk(with->arm, as_span(at.q)), X_first);
  std::optional<Attempt> best;
  if (there || step.branch.empty()) {
    best = along(i, at, *step.curve, false);
    if (!best->fault) tool_moves(*best);
    if (!best->fault || there) return std::move(*best);
  }
  const auto answers = with->answers.to(step, X_first, at.q);
  if (!answers && !best) return failed(i, at, {i, answers.error().reason, answers.error().what});
  for (std::size_t k = 0; answers && k < std::min(answers->q.size(), kMaxAnswers); ++k) {
    Attempt attempt{{}, i, at, {}};
    attempt.fault = joint_move(i, at, answers->q[k], "approach", attempt.moves);
    if (attempt.fault) {
      if (!best) best = std::move(attempt);
      continue;
    }
    Attempt rest = along(i, {answers->q[k], at.scene}, *step.curve, true);
    if (!rest.fault) tool_moves(rest);
    rest.moves.insert(rest.moves.begin(), std::move(attempt.moves.front()));
    if (!rest.fault) return rest;
    if (!best || rest.next > best->next) best = std::move(rest);
  }
  return std::move(*best);
}

/// Goes on with all that needs no other answer: straight moves, arcs and rests.
void StepPlanner::tool_moves(Attempt& attempt) {
  const auto ahead = static_cast<std::size_t>(core_count());
  while (attempt.next < steps_.size() && !attempt.fault && !is_stopped(options_.stop)) {
    tell_(attempt.next);
    const Step::Kind kind = steps_[attempt.next].kind;
    if (kind != Step::Kind::line && kind != Step::Kind::arc && kind != Step::Kind::wait &&
        kind != Step::Kind::grip) {
      break;
    }
    Attempt more = begin(attempt.next, attempt.at);
    for (PendingMotion& one : more.pending) {
      one.first += attempt.moves.size();
      one.move += attempt.moves.size();
      attempt.pending.push_back(std::move(one));
    }
    std::ranges::move(more.moves, std::back_inserter(attempt.moves));
    attempt.next = more.next;
    attempt.at = std::move(more.at);
    attempt.fault = std::move(more.fault);
    await(attempt, ahead);
  }
  await(attempt, 0);
}

/// Takes over motions until so many are left. The first that fails ends the attempt before its
/// step, whatever came after it.
void StepPlanner::await(Attempt& attempt, std::size_t left) {
  while (attempt.pending.size() > left) {
    PendingMotion one = std::move(attempt.pending.front());
    attempt.pending.pop_front();
    auto [motion, measures] = one.judged.get();
    if (motion) {
      PlannedMove& move = attempt.moves[one.move];
      move.trajectory = std::move(motion->trajectory);
      // A tool that presses slows down in its bends as it is.
      if (!move.press) move.dips = std::move(motion->dips);
      move.measures = std::move(measures);
      continue;
    }
    PlanFault fault = motion_fault(one.step, tool(one.step, one.at)->arm, motion.error());
    if (motion.error().path) fault.way = ClosedWay{one.curve, one.at.q, {.path = one.options}};
    attempt.pending.clear();
    attempt.moves.erase(attempt.moves.begin() + static_cast<std::ptrdiff_t>(one.first),
                        attempt.moves.end());
    attempt.next = one.step;
    attempt.at = std::move(one.at);
    attempt.fault = std::move(fault);
  }
}

/// Why a pose that step `i` goes to is no place for the tool, whatever the way.
std::optional<PlanFault> StepPlanner::out_of_place(std::size_t i, const Pose& X_WT,
                                                   const Stand& at) const {
  const ToolPtr with = tool(i, at);
  const auto answer = with->reach.solve(X_WT, as_span(at.q));
  if (answer || answer.error().code == IkErrc::no_convergence) return std::nullopt;
  return PlanFault{i, std::string(name(answer.error().code)), describe(answer.error(), with->arm)};
}

/// Straight moves and arcs as far as they are blended into one.
Attempt StepPlanner::tool_move(std::size_t i, const Stand& at) {
  Pose X = fk(tool(i, at)->arm, as_span(at.q));
  if (steps_[i].kind == Step::Kind::line && same_pose(X, steps_[i].X_WT)) return rest(i, at, 0);
  std::vector<Curve> legs;
  std::vector<double> blends;
  std::vector<PlannedPoint> told{{X, steps_[i].place}};
  for (std::size_t k = i;; ++k) {
    const Step& step = steps_[k];
    std::optional<PlanFault> fault;
    if (step.kind == Step::Kind::arc) fault = out_of_place(k, step.X_via, at);
    if (!fault) fault = out_of_place(k, step.X_WT, at);
    Result<Curve> leg = leg_of(step, X);
    if (fault && leg) fault->way = ClosedWay{*leg, at.q};
    if (fault) return failed(i, at, std::move(*fault));
    if (!leg) return failed(i, at, {k, "bad_input", leg.error().what});
    legs.push_back(std::move(*leg));
    if (step.kind == Step::Kind::arc) told.push_back({step.X_via, step.place});
    told.push_back({step.X_WT, step.place});
    if (!is_blended(steps_, k)) break;
    blends.push_back(step.blend);
    X = step.X_WT;
  }
  const Result<Curve> curve = Curve::joined(legs, blends);
  if (!curve) return failed(i, at, {i, "bad_input", curve.error().what});
  Attempt out = along(i, at, *curve, true, legs.size());
  const bool alike = legs.size() == 1 || told.size() == legs.size() + 1;
  if (!out.fault && alike) out.moves.back().points = std::move(told);
  return out;
}

/// The tool along `curve`, which does `count` steps; approached by a joint move unless `here`.
Attempt StepPlanner::along(std::size_t i, const Stand& at, const Curve& curve, bool here,
                           std::size_t count) {
  const Step& step = steps_[i];
  const ToolPtr with = tool(i, at);
  for (const CurveBlend& blend : curve.blends()) {
    const std::size_t corner = step.kind == Step::Kind::curve ? i : i + blend.point - 1;
    const double asked = steps_[corner].blend;
    if (blend.radius > 0 && blend.radius < asked * (1 - 1e-9)) {
      return failed(
          i, at, {corner, "blend_overlap", text(msg::program_blend_overlap, asked, blend.radius)});
    }
  }
  MotionOptions options = motion_options(steps_.subspan(i, count), curve, options_.tool_speed);
  options.at_speed = at.passes;
  options.path.keep_start = here;
  options.path.best_posture = step.is_free && !here;
  options.path.stop = options_.stop;
  options.path.clearance = with->judge.clearance();
  if (!here) {
    const Pose X_now = fk(with->arm, as_span(at.q));
    options.path.keep_start = same_pose(X_now, curve.at(0));
  }
  Result<JointPath, PathFailure> path = plan_tool_path(with->ik, curve, as_span(at.q), options);
  if (!path) {
    PlanFault fault = motion_fault(i, with->arm, {std::move(path.error()), {}});
    fault.way = ClosedWay{curve, at.q, {.path = options.path}};
    return failed(i, at, std::move(fault));
  }
  Attempt out{{}, i, at, {}};
  const JointVec& first = path->q.front();
  constexpr double kThere = 1e-9;
  if ((first - at.q).cwiseAbs().maxCoeff() > kThere && !here) {
    out.fault = joint_move(i, at, first, "approach", out.moves);
    if (out.fault) return out;
  }
  const auto judge = [with, curve, path = *path, options] {
    JudgedMotion judged{time_tool_motion(with->ik, curve, path, options), {}};
    if (judged.motion) judged.measures = with->judge.measure(with->ik, path.q);
    return judged;
  };
  // Without another thread the work is done when it is asked for.
  constexpr auto kHow = std::launch::async | std::launch::deferred;
  out.pending.push_back({i, at, 0, out.moves.size(), curve, options.path, std::async(kHow, judge)});
  PlannedMove move = begun(i, at.scene);
  move.instructions = count;
  for (std::size_t k = i + 1; k < i + count; ++k) {
    if (move.word.find(steps_[k].word) == std::string::npos) {
      move.word += "+" + std::string(steps_[k].word);
    }
  }
  move.curve = curve;
  move.press = step.press;
  move.right_W = step.right_W;
  for (const Pose& X_WT : step.points) move.points.push_back({X_WT, step.place});
  out.at.q = path->q.back();
  out.moves.push_back(std::move(move));
  out.next = i + count;
  return out;
}

}  // namespace mjarm::program::detail
