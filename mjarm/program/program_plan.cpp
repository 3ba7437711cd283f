#include "mjarm/program/program_plan.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <utility>

#include "mjarm/core/messages/execution.hpp"
#include "mjarm/core/messages/program.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik_all.hpp"
#include "mjarm/path/joint_path.hpp"
#include "mjarm/program/closed_way_internal.hpp"
#include "mjarm/program/detour_chain_internal.hpp"
#include "mjarm/program/detour_planner_internal.hpp"
#include "mjarm/program/move_measures_internal.hpp"
#include "mjarm/program/program_steps_internal.hpp"
#include "mjarm/program/step_motion_internal.hpp"
#include "mjarm/trajectory/tool_motion.hpp"

namespace mjarm::program {
namespace {

using detail::Step;

/// Ends the work on one step.
struct PlanFault {
  std::size_t step;
  std::string reason;
  std::string what;
  Errc code = Errc::impossible;
  std::optional<detail::ClosedWay> way = {};
};

/// Moves that follow each other, and what ended them early.
struct Attempt {
  std::vector<PlannedMove> moves;
  std::size_t next = 0;  ///< the first step that is not done
  JointVec q;            ///< where the arm is then
  std::optional<PlanFault> fault;
  std::optional<WorldPath> detour = {};  ///< of the first move, where it is one
};

/// What can be asked of one tool.
struct Tool {
  Arm arm;
  IkSolver reach;  ///< geometry alone
  IkSolver ik;     ///< without contact
  MoveJudge judge;
  detail::DetourPlanner detours;
};

class ProgramPlanner {
 public:
  ProgramPlanner(const Model& model, detail::Steps steps, FilePlace start_place,
                 const ProgramPlanOptions& options)
      : steps_(std::move(steps.steps)), start_place_(start_place), options_(options) {
    plan_.arms = std::move(steps.arms);
    plan_.faults = std::move(steps.faults);
    plan_.q_start = std::move(steps.q_start);
    for (const Arm& arm : plan_.arms) {
      IkOptions ik;
      ik.task = task_for(arm);
      std::optional<ExactChecker> checker;
      if (options.collision) checker.emplace(model, arm);
      if (checker) ik.valid = checker->predicate();
      const IkSolver solver(arm, ik);
      const MoveJudge judge(arm, checker);
      tools_.push_back({arm, IkSolver(arm, {.task = ik.task}), solver, judge,
                        detail::DetourPlanner({model, arm}, solver, judge, options.stop)});
    }
  }

  ProgramPlan plan() {
    look_at_start();
    JointVec q = plan_.q_start;
    bool known = true;  // whether the arm's posture is known after a fault
    for (std::size_t i = 0; i < steps_.size();) {
      tell(i);
      if (is_stopped(options_.stop)) break;
      if (!known && !(known = stands_somewhere(steps_[i], q))) {
        ++i;
        continue;
      }
      Attempt attempt = from(i, q);
      if (is_stopped(options_.stop)) break;
      if (attempt.detour) {
        chain_.add(i, steps_[i], std::move(*attempt.detour), tools_[steps_[i].tool].detours,
                   plan_.moves, attempt.moves);
      }
      std::ranges::move(attempt.moves, std::back_inserter(plan_.moves));
      i = attempt.next;
      q = std::move(attempt.q);
      if (!attempt.fault) continue;
      const std::optional<Detour> detour = find_detour(*attempt.fault, q);
      note(*attempt.fault, detour);
      known = detour || recover(steps_[attempt.fault->step], q);
      i = attempt.fault->step + 1;
    }
    if (is_stopped(options_.stop)) end_early();
    std::ranges::stable_sort(plan_.faults, {}, &ProgramFault::place);
    return std::move(plan_);
  }

 private:
  static constexpr std::size_t kMaxAnswers = 16;  ///< to one pose that are tried

  const Tool& tool(const Step& step) const { return tools_[step.tool]; }

  /// Where the program begins is within the limits, else it is a fault and taken to be home.
  void look_at_start() {
    if (const auto fault = tools_.front().judge.beyond_limits(plan_.q_start)) {
      detail::add_fault(plan_.faults,
                        {start_place_, "start", "joint_limit", *fault, Errc::impossible});
      plan_.q_start = plan_.arms.front().home;
    }
  }

  /// That the first `done` steps are planned, in one way or another.
  void tell(std::size_t done) {
    if (done < told_) return;
    told_ = done + 1;
    if (options_.after_step) options_.after_step(done, steps_.size());
  }

  /// What was not planned is a fault: nobody is to run a part for the whole.
  void end_early() {
    detail::add_fault(plan_.faults, {.place = start_place_,
                                     .word = "program",
                                     .reason = "stopped",
                                     .what = stopped().what,
                                     .code = stopped().code});
  }

  void note(const PlanFault& fault, const std::optional<Detour>& detour) {
    const Step& step = steps_[fault.step];
    const std::optional<PathFix> fix = detour ? std::nullopt : find_fix(fault);
    const std::string what =
        fix ? text(msg::program_mended, fault.what, describe(*fix)) : fault.what;
    detail::add_fault(plan_.faults, {step.place, std::string(step.word), fault.reason, what,
                                     fault.code, detour, fix});
  }

  /// The least change that mends a way of the tool; each is looked for once.
  std::optional<PathFix> find_fix(const PlanFault& fault) {
    if (!fault.way || !mended_.insert(steps_[fault.step].place).second) return std::nullopt;
    return detail::find_fix(tool(steps_[fault.step]).ik, *fault.way);
  }

  /// What `plan` would do in the place of a move that something blocks; `q` is then where it ends.
  std::optional<Detour> find_detour(const PlanFault& fault, JointVec& q) {
    const Step& step = steps_[fault.step];
    const bool one = step.kind == Step::Kind::joints || step.kind == Step::Kind::pose ||
                     (step.kind == Step::Kind::line && !detail::is_blended(steps_, fault.step));
    if (!one || fault.reason != "collision") return std::nullopt;
    detail::DetourPlanner& planner = tools_[step.tool].detours;
    const auto goals = goals_of(planner, step, q);
    if (!goals) return std::nullopt;
    const auto found = planner.plan(q, *goals, step.share, step.clearance);
    if (!found) return std::nullopt;
    q = found->corners.back();
    return Detour{found->corners.size() - 1, found->motion.trajectory.duration(),
                  found->measures.clearance};
  }

  /// After a fault the arm is taken to be where the step should have ended.
  bool recover(const Step& step, JointVec& q) const {
    const auto& valid = tool(step).ik.options().valid;
    if (step.q.size() > 0) {
      q = clamp_to_limits(tool(step).arm, as_span(step.q));
      return !valid || valid(as_span(q));
    }
    const bool has_end = step.kind == Step::Kind::pose || step.kind == Step::Kind::line ||
                         step.kind == Step::Kind::arc || step.kind == Step::Kind::plan;
    if (!has_end && step.kind != Step::Kind::curve) return true;
    const Pose X = has_end ? step.X_WT : step.curve->at(step.curve->end());
    const auto answer = tool(step).ik.solve(X, as_span(q));
    if (answer) q = answer->q;
    return answer.has_value();
  }

  /// Whether a step can be begun by an arm that may stand anywhere; then it stands at home.
  bool stands_somewhere(const Step& step, JointVec& q) const {
    const bool free = step.kind == Step::Kind::joints || step.kind == Step::Kind::pose ||
                      step.kind == Step::Kind::curve || step.kind == Step::Kind::plan;
    if (free) q = plan_.q_start;
    return free;
  }

  /// Plans step `i`, and what hangs on its answer.
  Attempt from(std::size_t i, const JointVec& q) {
    const Step& step = steps_[i];
    switch (step.kind) {
      case Step::Kind::joints:
        return to_joints(i, q);
      case Step::Kind::pose:
        return to_pose(i, q);
      case Step::Kind::curve:
        return to_curve(i, q);
      case Step::Kind::line:
      case Step::Kind::arc:
        return tool_move(i, q);
      case Step::Kind::wait:
        return rest(i, q, step.seconds);
      case Step::Kind::grip:
        return grip(i, q);
      case Step::Kind::plan:
        break;
    }
    return detour(i, q);
  }

  static Attempt failed(std::size_t i, const JointVec& q, PlanFault fault) {
    return {{}, i, q, std::move(fault)};
  }

  PlannedMove begun(const Step& step) const {
    PlannedMove move;
    move.word = step.word;
    move.place = step.place;
    move.tool = step.tool;
    return move;
  }

  Attempt rest(std::size_t i, const JointVec& q, double seconds) const {
    const JointState still = JointState::at_rest(q);
    const bool moment = !(seconds > 0);
    Result<Trajectory> trajectory = moment ? Trajectory::through({0.0}, {still})
                                           : Trajectory::through({0, seconds}, {still, still});
    if (!trajectory) return failed(i, q, {i, "bad_input", trajectory.error().what});
    PlannedMove move = begun(steps_[i]);
    move.trajectory = std::move(*trajectory);
    return {{std::move(move)}, i + 1, q, {}};
  }

  Attempt grip(std::size_t i, const JointVec& q) const {
    constexpr double kSeconds = 1;  // [s] for the fingers to get there
    if (!tool(steps_[i]).arm.gripper) {
      return failed(i, q, {i, "not_available", text(msg::execution_no_gripper)});
    }
    Attempt attempt = rest(i, q, kSeconds);
    if (!attempt.fault) attempt.moves.back().close = steps_[i].close;
    return attempt;
  }

  /// A joint move from `q` to `goal`; adds to `moves`.
  std::optional<PlanFault> joint_move(std::size_t i, const JointVec& q, const JointVec& goal,
                                      const char* word, std::vector<PlannedMove>& moves) {
    const Step& step = steps_[i];
    const Tool& with = tool(step);
    if (const auto fault = with.judge.beyond_limits(goal)) {
      return PlanFault{i, "joint_limit", *fault};
    }
    Result<Trajectory> trajectory =
        time_joint_move(as_span(q), as_span(goal), with.arm.limits, {.joint_share = step.share});
    if (!trajectory) return PlanFault{i, "bad_input", trajectory.error().what};
    PlannedMove move = begun(step);
    if (word != nullptr) move.word = word;
    const std::vector<JointVec> way = joint_way(q, goal);
    move.measures = with.judge.measure(with.ik, way);
    if (const auto fault = with.judge.touches(*move.measures)) {
      return PlanFault{i, "collision", text(msg::program_move_touches, *fault)};
    }
    move.trajectory = std::move(*trajectory);
    moves.push_back(std::move(move));
    return std::nullopt;
  }

  Attempt to_joints(std::size_t i, const JointVec& q) {
    Attempt out{{}, i, q, {}};
    out.fault = joint_move(i, q, steps_[i].q, nullptr, out.moves);
    if (!out.fault) {
      out.next = i + 1;
      out.q = steps_[i].q;
    }
    return out;
  }

  /// To the answer from which the tool moves that follow go farthest; the nearest of equals.
  Attempt to_pose(std::size_t i, const JointVec& q) {
    const Tool& with = tool(steps_[i]);
    const auto answers = solve_all(with.ik, steps_[i].X_WT, as_span(q));
    if (!answers) {
      return failed(
          i, q, {i, std::string(name(answers.error().code)), describe(answers.error(), with.arm)});
    }
    std::optional<Attempt> best;
    for (std::size_t k = 0; k < std::min(answers->size(), kMaxAnswers); ++k) {
      Attempt attempt{{}, i, q, {}};
      attempt.fault = joint_move(i, q, (*answers)[k].q, nullptr, attempt.moves);
      if (!attempt.fault) {
        attempt.next = i + 1;
        attempt.q = (*answers)[k].q;
        tool_moves(attempt);
      }
      if (!attempt.fault) return attempt;
      if (!best || attempt.next > best->next) best = std::move(attempt);
    }
    return std::move(*best);
  }

  /// Where a `plan` may end: its joint values, or every answer to its pose.
  static Result<std::vector<JointVec>, detail::DetourFault> goals_of(
      const detail::DetourPlanner& planner, const Step& step, const JointVec& q) {
    return step.q.size() > 0 ? planner.goals(q, step.q) : planner.goals(q, step.X_WT);
  }

  /// Round what stands in the way, to a goal from which the tool moves that follow go farthest.
  Attempt detour(std::size_t i, const JointVec& q) {
    const Step& step = steps_[i];
    Tool& with = tools_[step.tool];
    auto goals = goals_of(with.detours, step, q);
    if (!goals) return failed(i, q, {i, goals.error().reason, goals.error().what});
    std::optional<Attempt> best;
    for (std::size_t k = 0; k < kMaxAnswers && !goals->empty(); ++k) {
      auto found = with.detours.plan(q, *goals, step.share, step.clearance);
      if (!found && best) break;
      if (!found) return failed(i, q, {i, found.error().reason, found.error().what});
      Attempt attempt{{begun(step)}, i + 1, found->corners.back(), {}};
      PlannedMove& move = attempt.moves.back();
      const std::size_t goal = found->goal();
      attempt.detour = found->paths.front();
      detail::put(std::move(*found), move);
      tool_moves(attempt);
      if (!attempt.fault) return attempt;
      if (!best || attempt.next > best->next) best = std::move(attempt);
      goals->erase(goals->begin() + static_cast<std::ptrdiff_t>(goal));
    }
    return std::move(*best);
  }

  /// Along a whole curve, from the answer to its first pose from which it and the tool moves that
  /// follow go farthest.
  Attempt to_curve(std::size_t i, const JointVec& q) {
    const Step& step = steps_[i];
    const Pose X_first = step.curve->at(0);
    Attempt best = along(i, q, *step.curve, false);
    if (!best.fault) tool_moves(best);
    if (!best.fault || detail::same_pose(fk(tool(step).arm, as_span(q)), X_first)) return best;
    const auto answers = solve_all(tool(step).ik, X_first, as_span(q));
    for (std::size_t k = 0; answers && k < std::min(answers->size(), kMaxAnswers); ++k) {
      Attempt attempt{{}, i, q, {}};
      attempt.fault = joint_move(i, q, (*answers)[k].q, "approach", attempt.moves);
      if (attempt.fault) continue;
      Attempt rest = along(i, (*answers)[k].q, *step.curve, true);
      if (!rest.fault) tool_moves(rest);
      rest.moves.insert(rest.moves.begin(), std::move(attempt.moves.front()));
      if (!rest.fault) return rest;
      if (rest.next > best.next) best = std::move(rest);
    }
    return best;
  }

  /// Goes on with all that needs no other answer: straight moves, arcs and rests.
  void tool_moves(Attempt& attempt) {
    while (attempt.next < steps_.size() && !attempt.fault && !is_stopped(options_.stop)) {
      tell(attempt.next);
      const Step::Kind kind = steps_[attempt.next].kind;
      if (kind != Step::Kind::line && kind != Step::Kind::arc && kind != Step::Kind::wait &&
          kind != Step::Kind::grip) {
        return;
      }
      Attempt more = from(attempt.next, attempt.q);
      std::ranges::move(more.moves, std::back_inserter(attempt.moves));
      attempt.next = more.next;
      attempt.q = std::move(more.q);
      attempt.fault = std::move(more.fault);
    }
  }

  /// Why a pose that step `i` goes to is no place for the tool, whatever the way.
  std::optional<PlanFault> out_of_place(std::size_t i, const Pose& X_WT, const JointVec& q) const {
    const Tool& with = tool(steps_[i]);
    const auto answer = with.reach.solve(X_WT, as_span(q));
    if (answer || answer.error().code == IkErrc::no_convergence) return std::nullopt;
    return PlanFault{i, std::string(name(answer.error().code)), describe(answer.error(), with.arm)};
  }

  /// Straight moves and arcs as far as they are blended into one.
  Attempt tool_move(std::size_t i, const JointVec& q) {
    Pose X = fk(tool(steps_[i]).arm, as_span(q));
    if (steps_[i].kind == Step::Kind::line && detail::same_pose(X, steps_[i].X_WT))
      return rest(i, q, 0);
    std::vector<Curve> legs;
    std::vector<double> blends;
    std::vector<PlannedPoint> told{{X, steps_[i].place}};
    for (std::size_t k = i;; ++k) {
      const Step& step = steps_[k];
      std::optional<PlanFault> fault;
      if (step.kind == Step::Kind::arc) fault = out_of_place(k, step.X_via, q);
      if (!fault) fault = out_of_place(k, step.X_WT, q);
      Result<Curve> leg = detail::leg_of(step, X);
      if (fault && leg) fault->way = detail::ClosedWay{*leg, q};
      if (fault) return failed(i, q, std::move(*fault));
      if (!leg) return failed(i, q, {k, "bad_input", leg.error().what});
      legs.push_back(std::move(*leg));
      if (step.kind == Step::Kind::arc) told.push_back({step.X_via, step.place});
      told.push_back({step.X_WT, step.place});
      if (!detail::is_blended(steps_, k)) break;
      blends.push_back(step.blend);
      X = step.X_WT;
    }
    const Result<Curve> curve = Curve::joined(legs, blends);
    if (!curve) return failed(i, q, {i, "bad_input", curve.error().what});
    Attempt out = along(i, q, *curve, true, legs.size());
    const bool alike = legs.size() == 1 || told.size() == legs.size() + 1;
    if (!out.fault && alike) out.moves.back().points = std::move(told);
    return out;
  }

  /// The tool along `curve`, which does `count` steps; approached by a joint move unless `here`.
  Attempt along(std::size_t i, const JointVec& q, const Curve& curve, bool here,
                std::size_t count = 1) {
    const Step& step = steps_[i];
    const Tool& with = tool(step);
    for (const CurveBlend& blend : curve.blends()) {
      const std::size_t at = step.kind == Step::Kind::curve ? i : i + blend.point - 1;
      const double asked = steps_[at].blend;
      if (blend.radius > 0 && blend.radius < asked * (1 - 1e-9)) {
        return failed(i, q,
                      {at, "blend_overlap", text(msg::program_blend_overlap, asked, blend.radius)});
      }
    }
    MotionOptions options =
        detail::motion_options(std::span(steps_).subspan(i, count), curve, options_.tool_speed);
    options.path.keep_start = here;
    options.path.stop = options_.stop;
    options.path.clearance = with.judge.clearance();
    if (!here) {
      const Pose X_now = fk(with.arm, as_span(q));
      options.path.keep_start = detail::same_pose(X_now, curve.at(0));
    }
    Result<ToolMotion, MotionFailure> motion =
        plan_tool_motion(with.ik, curve, as_span(q), options);
    if (!motion) {
      PlanFault fault = motion_fault(i, with.arm, motion.error());
      if (motion.error().path) fault.way = detail::ClosedWay{curve, q, {.path = options.path}};
      return failed(i, q, std::move(fault));
    }
    Attempt out{{}, i, q, {}};
    const JointVec& first = motion->path.q.front();
    constexpr double kThere = 1e-9;
    if ((first - q).cwiseAbs().maxCoeff() > kThere && !here) {
      out.fault = joint_move(i, q, first, "approach", out.moves);
      if (out.fault) return out;
    }
    PlannedMove move = begun(step);
    move.instructions = count;
    for (std::size_t k = i + 1; k < i + count; ++k) {
      if (move.word.find(steps_[k].word) == std::string::npos) {
        move.word += "+" + std::string(steps_[k].word);
      }
    }
    move.measures = with.judge.measure(with.ik, motion->path.q);
    move.trajectory = std::move(motion->trajectory);
    move.curve = curve;
    for (const Pose& X_WT : step.points) move.points.push_back({X_WT, step.place});
    move.dips = std::move(motion->dips);
    out.q = motion->path.q.back();
    out.moves.push_back(std::move(move));
    out.next = i + count;
    return out;
  }

  static PlanFault motion_fault(std::size_t i, const Arm& arm, const MotionFailure& failure) {
    return {i, failure.path ? std::string(name(failure.path->code)) : "timing",
            describe(failure, arm)};
  }

  std::vector<Step> steps_;
  FilePlace start_place_;
  const ProgramPlanOptions& options_;
  std::vector<Tool> tools_;
  std::size_t told_ = 0;        // steps that were told of
  detail::DetourChain chain_;   // the last one
  std::set<FilePlace> mended_;  // places of faults for which a change was looked for
  ProgramPlan plan_;
};

}  // namespace

ProgramPlan plan_program(const Model& model, const Arm& arm, const Program& program,
                         const ProgramPlanOptions& options) {
  return ProgramPlanner(model, detail::steps_of(program, model, arm), program.start_place, options)
      .plan();
}

}  // namespace mjarm::program
