#include "mjarm/program/program_plan.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "mjarm/core/messages/program.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/program/detour_chain_internal.hpp"
#include "mjarm/program/pick_place.hpp"
#include "mjarm/program/step_motion_internal.hpp"
#include "mjarm/program/step_planner_internal.hpp"

namespace mjarm::program {
namespace {

using detail::Attempt;
using detail::PlanFault;
using detail::Stand;
using detail::Step;

class ProgramPlanner {
 public:
  ProgramPlanner(const Model& model, detail::Steps steps, FilePlace start_place,
                 const ProgramPlanOptions& options)
      : model_(model),
        steps_(std::move(steps.steps)),
        start_place_(start_place),
        options_(options),
        plan_(begun(steps)),
        places_(model, plan_.arms, options),
        planner_(steps_, options_, places_, [this](std::size_t i) { tell(i); }) {}

  ProgramPlan plan() {
    look_at_start();
    Stand at{plan_.q_start, 0};
    bool known = true;  // whether the arm's posture is known after a fault
    for (std::size_t i = 0; i < steps_.size();) {
      tell(i);
      if (is_stopped(options_.stop)) break;
      if (!known && !(known = stands_somewhere(steps_[i], at))) {
        ++i;
        continue;
      }
      if (steps_[i].kind == Step::Kind::look) {
        look(steps_[i++], at);
        continue;
      }
      if (steps_[i].kind == Step::Kind::pick || steps_[i].kind == Step::Kind::place) {
        known = carry(i, at);
        continue;
      }
      Attempt attempt = planner_.from(i, at);
      if (is_stopped(options_.stop)) break;
      const std::size_t moves = attempt.moves.size();
      if (attempt.detour) {
        const auto with = places_.tool(at.scene, steps_[i].tool);
        chain_.add(i, steps_[i], std::move(*attempt.detour), with->detours, plan_.moves,
                   attempt.moves);
      }
      std::ranges::move(attempt.moves, std::back_inserter(plan_.moves));
      if (attempt.detour && attempt.next > i + 1) pass_goal(i, at.scene, moves - 1);
      i = attempt.next;
      at = std::move(attempt.at);
      if (!attempt.fault) continue;
      if (options_.to_first_fault) {
        note(*attempt.fault, {}, {});
        break;
      }
      const std::optional<Detour> detour = find_detour(*attempt.fault, at);
      note(*attempt.fault, detour, detour ? std::nullopt : find_fix(*attempt.fault, at.scene));
      known = detour || recover(steps_[attempt.fault->step], at);
      i = attempt.fault->step + 1;
    }
    if (is_stopped(options_.stop)) end_early();
    plan_.scene_end = places_.state(at.scene);
    std::ranges::stable_sort(plan_.faults, {}, &ProgramFault::place);
    return std::move(plan_);
  }

 private:
  /// Nothing is planned yet.
  static ProgramPlan begun(detail::Steps& steps) {
    ProgramPlan plan;
    plan.arms = std::move(steps.arms);
    plan.faults = std::move(steps.faults);
    plan.q_start = std::move(steps.q_start);
    return plan;
  }

  /// A step that cannot be done, with nothing to be had in its place.
  void refuse(const Step& step, std::string_view reason, std::string what, Errc code) {
    detail::add_fault(plan_.faults, {.place = step.place,
                                     .word = std::string(step.word),
                                     .reason = std::string(reason),
                                     .what = std::move(what),
                                     .code = code});
  }

  /// Things stand where the camera sees them.
  void look(const Step& step, Stand& at) {
    if (!options_.see) {
      return refuse(step, "not_available", text(msg::program_nobody_looks), Errc::not_available);
    }
    Result<SeenScene> seen = options_.see({model_, plan_.arms[step.tool]}, step.object,
                                          places_.state(at.scene), as_span(at.q));
    if (!seen) {
      const bool named = seen.error().code == Errc::bad_input;
      return refuse(step, named ? "unknown_name" : "not_available", seen.error().what,
                    seen.error().code);
    }
    at.scene = places_.enter(std::move(seen->scene));
    unseen_ = std::move(seen->unseen);
    same_ = std::move(seen->same);
  }

  /// Picks up, puts down, or both where one follows the other; goes on behind them. False where the
  /// arm's posture is not known then.
  bool carry(std::size_t& i, Stand& at) {
    const Step& step = steps_[i];
    const bool picks = step.kind == Step::Kind::pick;
    const Step* const place = !picks ? &step : i + 1 < steps_.size() ? &steps_[i + 1] : nullptr;
    std::optional<PlaceGoal> goal;
    if (place != nullptr && place->kind == Step::Kind::place) {
      goal = PlaceGoal{place->X_WT, place->any_turn};
      const std::vector<AttachedBody>& held = places_.attached(at.scene);
      const auto same = same_.find(picks || held.empty() ? step.object : held.front().body);
      if (same != same_.end()) goal->same = same->second;
    }
    const PickOptions how{.tool_speed = step.speed > 0 ? step.speed : PickOptions().tool_speed,
                          .stop = options_.stop};
    const Robot robot{model_, plan_.arms[step.tool]};
    const SceneState& scene = places_.state(at.scene);
    if (const auto unseen = unseen_.find(step.object); picks && unseen != unseen_.end()) {
      i += goal ? 2 : 1;
      refuse(step, name(PickErrc::not_seen),
             text(msg::program_not_seen, step.object, unseen->second), Errc::impossible);
      return false;
    }
    auto planned = picks ? plan_pick(robot, scene, as_span(at.q), {step.object, goal}, how)
                         : plan_place(robot, scene, as_span(at.q), *goal, how);
    i += picks && goal ? 2 : 1;
    if (!planned) {
      const bool named = planned.error().code == PickErrc::no_object;
      refuse(step, name(planned.error().code), planned.error().what,
             named ? Errc::bad_input : Errc::impossible);
      return false;
    }
    for (PlannedMove& move : planned->plan.moves) {
      move.place = step.place;
      move.tool = step.tool;
      move.dips.clear();  // nobody asked for a speed
      plan_.moves.push_back(std::move(move));
    }
    at = {plan_.moves.back().trajectory.at(plan_.moves.back().trajectory.duration()).q,
          places_.enter(std::move(planned->plan.scene_end))};
    return true;
  }

  /// Where the program begins is within the limits, else it is a fault and taken to be home.
  void look_at_start() {
    if (const auto fault = places_.tool(0, 0)->judge.beyond_limits(plan_.q_start)) {
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

  void note(const PlanFault& fault, const std::optional<Detour>& detour,
            const std::optional<PathFix>& fix) {
    const Step& step = steps_[fault.step];
    const std::string what =
        fix ? text(msg::program_mended, fault.what, describe(*fix)) : fault.what;
    detail::add_fault(plan_.faults, {step.place, std::string(step.word), fault.reason, what,
                                     fault.code, detour, fix});
  }

  /// The least change that mends a way of the tool; each is looked for once.
  std::optional<PathFix> find_fix(const PlanFault& fault, std::size_t scene) {
    if (!fault.way || !mended_.insert(steps_[fault.step].place).second) return std::nullopt;
    return detail::find_fix(places_.tool(scene, steps_[fault.step].tool)->ik, *fault.way);
  }

  /// Lets the detour of step `i` pass into the straight move after it, without a stop at its goal.
  void pass_goal(std::size_t i, std::size_t scene, std::size_t moves_after) {
    const Step &detour = steps_[i], &line = steps_[i + 1];
    if (line.kind != Step::Kind::line || line.tool != detour.tool ||
        detail::is_blended(steps_, i + 1)) {
      return;
    }
    PlannedMove& way = *(plan_.moves.end() - static_cast<std::ptrdiff_t>(moves_after) - 1);
    PlannedMove& after = *(&way + 1);
    if (!after.curve) return;
    Attempt fast = planner_.only(i + 1, {way.corners.back(), scene, true});
    if (fast.fault || fast.moves.size() != 1) return;
    Trajectory& motion = fast.moves.front().trajectory;
    const auto with = places_.tool(scene, line.tool);
    if (motion.duration() < after.trajectory.duration() &&
        chain_.pass_into(motion.at(0), with->detours, way)) {
      after = std::move(fast.moves.front());
    }
  }

  /// What `plan` would do in the place of a move that something blocks; `at` is then where it ends.
  std::optional<Detour> find_detour(const PlanFault& fault, Stand& at) {
    const Step& step = steps_[fault.step];
    const bool one = step.kind == Step::Kind::joints || step.kind == Step::Kind::pose ||
                     (step.kind == Step::Kind::line && !detail::is_blended(steps_, fault.step));
    if (!one || fault.reason != "collision") return std::nullopt;
    const auto with = places_.tool(at.scene, step.tool);
    const auto goals = with->answers.goals(step, with->detours, at.q);
    if (!goals) return std::nullopt;
    auto found = with->detours.plan(at.q, goals->good_ones(), step.share, step.clearance);
    if (!found && !goals->others().empty()) {
      found = with->detours.plan(at.q, goals->others(), step.share, step.clearance);
    }
    if (!found) return std::nullopt;
    at.q = found->corners.back();
    return Detour{found->corners.size() - 1, found->motion.trajectory.duration(),
                  found->measures.clearance};
  }

  /// After a fault the arm is taken to be where the step should have ended.
  bool recover(const Step& step, Stand& at) {
    const auto with = places_.tool(at.scene, step.tool);
    const auto& valid = with->ik.options().valid;
    if (step.q.size() > 0) {
      at.q = clamp_to_limits(with->arm, as_span(step.q));
      return !valid || valid(as_span(at.q));
    }
    const bool has_end = step.kind == Step::Kind::pose || step.kind == Step::Kind::line ||
                         step.kind == Step::Kind::arc || step.kind == Step::Kind::plan;
    if (!has_end && step.kind != Step::Kind::curve) return true;
    const Pose X = has_end ? step.X_WT : step.curve->at(step.curve->end());
    const auto answer = with->ik.solve(X, as_span(at.q));
    if (answer) at.q = answer->q;
    return answer.has_value();
  }

  /// Whether a step can be begun by an arm that may stand anywhere; then it stands at home.
  bool stands_somewhere(const Step& step, Stand& at) const {
    const bool free = step.kind == Step::Kind::joints || step.kind == Step::Kind::pose ||
                      step.kind == Step::Kind::curve || step.kind == Step::Kind::plan ||
                      step.kind == Step::Kind::pick;
    if (free) at.q = plan_.q_start;
    return free;
  }

  const Model& model_;
  std::vector<Step> steps_;
  FilePlace start_place_;
  const ProgramPlanOptions& options_;
  std::size_t told_ = 0;                       // steps that were told of
  detail::DetourChain chain_;                  // the last one
  std::set<FilePlace> mended_;                 // places of faults for which a change was looked for
  std::map<std::string, std::string> unseen_;  // objects that no camera saw, and why
  std::map<std::string, std::vector<Pose>> same_;  // objects known up to symmetry
  ProgramPlan plan_;
  detail::Workplaces places_;  // of the plan's arms
  detail::StepPlanner planner_;
};

}  // namespace

ProgramPlan plan_program(const Model& model, const Arm& arm, const Program& program,
                         const ProgramPlanOptions& options) {
  return ProgramPlanner(model, detail::steps_of(program, model, arm), program.start_place, options)
      .plan();
}

}  // namespace mjarm::program
