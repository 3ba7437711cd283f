#include "mjarm/execution/motion_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mjarm/core/messages/execution.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
namespace {

/// Whether a motion is part of what is measured: something happens, and it was asked for.
bool is_measured(const MotionPlan& plan, std::size_t i) {
  const PlannedMove& move = plan.moves[i];
  return (i + 1 == plan.moves.size() || move.trajectory.duration() > 0) && !move.is_approach();
}

/// The frame of tool `i`, in that of the first.
Pose tool_in_tool(const MotionPlan& plan, std::size_t i) {
  return plan.arms.front().X_JT.inverse() * plan.arms[i].X_JT;
}

}  // namespace

MotionRun::MotionRun(const Model& model, const Arm& arm)
    : model_(model), arm_(arm), sim_(model), recorder_(model, arm) {
  sim_.reset_home();
  sim_.hold_others(arm_);
  q_command_ = sim_.arm_state(arm).q;
}

void MotionRun::start_at(std::span<const double> q) {
  sim_.place(arm_, q);
  q_command_ = joint_vec(q);
}

void MotionRun::add(const FollowOutcome& outcome) {
  total_.add(outcome);
  if (!outcome.stopped) return;
  end_reason_ = "stopped";
  end_detail_ = text(msg::execution_stopped, sim_.time());
}

void MotionRun::add_span(const Curve* curve, double from, double to, const Pose& X_TU) {
  spans_.push_back({.curve = curve != nullptr ? std::optional(*curve) : std::nullopt,
                    .from = from,
                    .to = to,
                    .X_TU = X_TU});
}

Result<void> MotionRun::execute(const MotionPlan& plan, ControlMode mode, double rest) {
  start_at(as_span(plan.q_start));
  return go_on(plan, mode, rest);
}

Result<void> MotionRun::go_on(const MotionPlan& plan, ControlMode mode, double rest) {
  if (ended_early()) return {};
  q_command_ = plan.q_end();
  // What the plan before had at the tool in the end is gone.
  if (sim_.model().raw() != model_.raw()) sim_.take_masses(model_);
  Result<Execution> execution = Execution::create(
      model_, plan, {.control = mode, .contact = contact_, .rest = rest, .recorder = &recorder_});
  if (!execution) return fail(std::move(execution.error()));
  const Result<FollowOutcome> outcome = execution->run_to_end(
      sim_, [&](const Sim& sim) { return !after_step_ || after_step_(sim, execution->part()); });
  if (!outcome) return fail(outcome.error());
  objects_ = execution->objects();
  if (const std::optional<Presser>& presser = execution->presser()) {
    ink_.insert(ink_.end(), presser->ink().begin(), presser->ink().end());
    strokes_.insert(strokes_.end(), presser->strokes().begin(), presser->strokes().end());
  }
  felt_ = execution->felt();
  for (const ExecutedMotion& motion : execution->motions()) {
    const PlannedMove& move = plan.moves[motion.move];
    add(motion.outcome);
    if (move.is_approach()) continue;
    // A tool that presses is off its curves on purpose; its strokes are looked at by themselves.
    const bool to_measure = move.curve && !execution->presser();
    add_span(to_measure ? &*move.curve : nullptr, motion.from, motion.to,
             tool_in_tool(plan, move.tool));
  }
  if (felt_) {
    end_reason_ = "contact";
    end_detail_ = text(msg::execution_felt, felt_->link, felt_->force, felt_->time);
  }
  return {};
}

Result<void> MotionRun::follow(const Trajectory& trajectory, ControlMode mode, double rest,
                               const Curve* curve) {
  MotionPlan plan = MotionPlan::of(arm_, trajectory);
  if (curve != nullptr) plan.moves.front().curve = *curve;
  return go_on(plan, mode, rest);
}

Result<void> MotionRun::approach(std::span<const double> q, ControlMode mode) {
  constexpr double kRest = 0.2;  // [s]
  Result<Trajectory> move = time_joint_move(as_span(q_command_), q, arm_.limits);
  if (!move) return fail(std::move(move.error()));
  MotionPlan plan = MotionPlan::of(arm_, std::move(*move));
  plan.moves.front().word = "approach";
  return go_on(plan, mode, kRest);
}

Result<void> MotionRun::jump(const JointVec& q, ControlMode mode, double seconds) {
  const JointState rest = JointState::at_rest(q);
  const Result<Trajectory> stay = Trajectory::through({0, seconds}, {rest, rest});
  if (!stay) return fail(stay.error());
  return follow(*stay, mode, 0);
}

Result<void> MotionRun::wait_through(std::span<const JointVec> waypoints,
                                     std::span<const Eigen::Vector3d> points, ControlMode mode,
                                     const Curve* curve) {
  if (ended_early()) return {};
  if (!waypoints.empty()) q_command_ = waypoints.back();
  Result<Controller> controller = Controller::create(model_, arm_, mode);
  if (!controller) return fail(std::move(controller.error()));
  const FollowSetup setup{.sim = sim_,
                          .controller = *controller,
                          .arm = arm_,
                          .recorder = &recorder_,
                          .after_step = [this](const Sim& sim) {
                            return !after_step_ || after_step_(sim, MotionPart::work);
                          }};
  const double from = sim_.time();
  const Result<FollowOutcome, FollowFailure> outcome =
      points.empty() ? follow_joints(setup, waypoints) : follow_tool(setup, waypoints, points);
  if (!outcome && outcome.error().error) return fail(*outcome.error().error);
  add(outcome ? *outcome : outcome.error().outcome);
  if (!outcome) {
    end_reason_ = "waypoint_not_reached";
    end_detail_ = describe(outcome.error(), arm_);
  }
  add_span(curve, from, sim_.time());
  return {};
}

std::vector<MeasuredRun> MotionRun::measured_runs() const {
  return mjarm::measured_runs(recorder_, spans_);
}

Report MotionRun::report(const MotionPlan& plan, std::span<const MeasuredRun> runs,
                         double tolerance, Report begun) const {
  Report out = std::move(begun);
  out.facts.push_back({"cycle_time", plan.duration()});
  std::size_t k = 0;
  for (std::size_t i = 0; i < plan.moves.size(); ++i) {
    const PlannedMove& move = plan.moves[i];
    add_motion(move, plan.arms[move.tool], out);
    ReportedMove& told = out.moves.emplace_back();
    told.line = move.place.line;
    told.word = move.word;
    told.duration = move.trajectory.duration();
    told.stopping = move.stopping;
    if (is_measured(plan, i) && k < runs.size()) told.path_error = runs[k++].error;
  }
  out.objects = objects_;
  if (!ended_early() && !plan.moves.empty()) {
    const Arm& arm = plan.arms.front();
    out.done = 1;
    out.static_error = pose_error(fk(arm, as_span(plan.q_end())), sim_.tool(arm));
  }
  out = report(runs, tolerance, std::move(out));
  look_at_strokes(tolerance, out);
  look_at_contacts(out);
  return out;
}

/// How near the ink is to the strokes, and how hard the tool pressed.
void MotionRun::look_at_strokes(double tolerance, Report& report) const {
  if (strokes_.empty()) return;
  double off = 0, squares = 0, landing = 0;
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const InkPoint& point : ink_) {
    off = std::max(off, point.off);
    squares += point.off * point.off;
  }
  for (const PressedStroke& stroke : strokes_) {
    landing = std::max(landing, stroke.landing);
    if (!stroke.touched) continue;
    least = std::min(least, stroke.least);
    most = std::max(most, stroke.most);
  }
  const double count = static_cast<double>(std::max<std::size_t>(1, ink_.size()));
  report.facts.push_back(
      {"ink", std::map<std::string, double>{{"max", off},
                                            {"rms", std::sqrt(squares / count)},
                                            {"force_min", ink_.empty() ? 0 : least},
                                            {"force_max", most},
                                            {"force_landing", landing}}});
  const auto missed = std::ranges::find(strokes_, false, &PressedStroke::touched);
  if (!report.ok || (missed == strokes_.end() && off <= tolerance)) return;
  report.ok = false;
  const bool met = missed == strokes_.end();
  report.reason = met ? "path_error" : "nothing_met";
  report.detail =
      met ? text(msg::execution_off_path, 1e3 * off, 1e3 * tolerance, 100.0)
          : text(msg::execution_press_nothing, missed - strokes_.begin() + 1, strokes_.size());
}

/// What went wrong beside the path says more about it than how far off the arm was.
void MotionRun::look_at_contacts(Report& report) const {
  if (ended_early()) return;
  const auto lost = std::ranges::find_if(
      objects_, [](const ObservedObject& one) { return one.fault != ObjectFault::none; });
  if (lost != objects_.end()) {
    report.reason = name(lost->fault);
    report.detail = describe(*lost);
  } else if (total_.first_contact) {
    const TimedContact& first = *total_.first_contact;
    report.reason = "contact";
    report.detail =
        text(msg::execution_touched, first.contact.first, first.contact.second, first.time);
  } else {
    return;
  }
  report.ok = false;
}

Report MotionRun::report(std::span<const MeasuredRun> runs, double tolerance, Report begun) const {
  Report out = std::move(begun);
  out.model = model_.name();
  put_outcome(total_, out);
  if (const std::optional<double> speed = max_tool_speed(runs)) {
    out.tool_speed_max = std::max(out.tool_speed_max.value_or(0), *speed);
  }
  if (const std::optional<PathError> error = path_error(runs)) {
    out.path_error = error;
    out.done = error->coverage;
  }
  out.held = sim_.held();
  out.ok = !ended_early();
  out.reason = end_reason_;
  out.detail = end_detail_;
  const bool off_path = out.path_error && (out.path_error->max > tolerance || out.done < 0.999);
  const bool off_goal = out.static_error && out.static_error->position > tolerance;
  if (out.ok && (off_path || off_goal)) {
    const double error = off_path ? out.path_error->max : out.static_error->position;
    out.ok = false;
    out.reason = off_path ? "path_error" : "static_error";
    out.detail =
        text(msg::execution_off_path, 1e3 * error, 1e3 * tolerance, 100 * out.done) + why_off();
  }
  return out;
}

/// What the simulation shows of why the arm was off, to be added; empty where it shows nothing.
std::string MotionRun::why_off() const {
  constexpr double kOften = 0.05;
  const double limited = static_cast<double>(total_.limited_steps);
  const double share = limited / std::max(1.0, static_cast<double>(total_.steps));
  if (share > kOften) return text(msg::execution_off_force, 100 * share);
  for (const Contact& contact : sim_.contacts()) {
    if (!is_by_design(arm_, contact)) continue;
    return text(msg::execution_off_rubs, contact.first, contact.second);
  }
  return {};
}

}  // namespace mjarm
