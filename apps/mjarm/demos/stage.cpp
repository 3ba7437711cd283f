#include "apps/mjarm/demos/stage.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "apps/mjarm/demos/output.hpp"
#include "apps/mjarm/install/installed.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/render/camera.hpp"

namespace mjarm::app {
namespace {

/// Fewer than six joints cannot turn the tool as they like.
IkTask task_of(const Arm& arm) { return arm.dof() < 6 ? IkTask::position : IkTask::pose; }

IkOptions without_contact(const Model& model, const Arm& arm) {
  IkOptions options;
  options.task = task_of(arm);
  options.valid = ExactChecker(model, arm).predicate();
  return options;
}

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Stage::Stage(std::string demo, const DemoOptions& options, Model model, Arm arm, Show show)
    : demo_(std::move(demo)),
      options_(options),
      model_(std::move(model)),
      arm_(std::move(arm)),
      reach_(arm_, {.task = task_of(arm_)}),
      ik_(arm_, without_contact(model_, arm_)),
      sim_(model_),
      recorder_(model_, arm_),
      show_(std::move(show)) {
  start_at(as_span(arm_.home));
  show_.let_push(sim_);
}

Result<Robot> load_stage_robot(const std::string& demo, const DemoOptions& options, int dof) {
  RobotChoice chosen = options.robot;
  if (options.meshes) {
    const Result<std::filesystem::path> scene = find_mesh_scene(chosen.robot);
    if (!scene) return fail(scene.error());
    chosen.robot = scene->string();
  }
  Result<Robot> robot = load_robot(chosen);
  if (!robot) return robot;
  const int joints = robot->arm.dof();
  if (dof != 0 && joints != dof) {
    return fail(Errc::usage, text(msg::demo_other_joints, demo, dof, joints));
  }
  return robot;
}

Result<std::unique_ptr<Stage>> Stage::open(const std::string& demo, const DemoOptions& options,
                                           int dof) {
  const Result<Robot> robot = load_stage_robot(demo, options, dof);
  if (!robot) return fail(robot.error());
  return open(demo, options, *robot);
}

Result<std::unique_ptr<Stage>> Stage::open(const std::string& demo, const DemoOptions& options,
                                           const Robot& robot) {
  tell_warnings(robot.model);
  if (task_of(robot.arm) == IkTask::position) {
    log_info(text(msg::demo_position_only, robot.arm.dof()));
  }
  if (auto made = make_folder(options.out); !made) return fail(std::move(made.error()));
  Result<Show> show = Show::open(robot.model, "mjarm " + demo, options.headless);
  if (!show) return fail(std::move(show.error()));
  return std::unique_ptr<Stage>(new Stage(demo, options, robot.model, robot.arm, std::move(*show)));
}

ControlMode Stage::control(ControlMode fallback) {
  const ControlMode mode = options_.control.value_or(fallback);
  control_ = name(mode);
  return mode;
}

void Stage::start_at(std::span<const double> q) {
  sim_.place(arm_, q);
  q_command_ = joint_vec(q);
}

FollowSetup Stage::setup(Controller& controller, bool measured) {
  show_.set_trail(measured);
  return {.sim = sim_,
          .controller = controller,
          .arm = arm_,
          .recorder = &recorder_,
          .after_step = [this](const Sim& sim, const JointVec&) { return show_step(sim); }};
}

bool Stage::show_step(const Sim& sim) {
  if (options_.seconds > 0 && sim.time() >= options_.seconds) return false;
  if (tick_) tick_();
  return show_.step(sim, sim.tool(arm_).p);
}

void Stage::add(const FollowOutcome& outcome) {
  total_.steps += outcome.steps;
  total_.duration += outcome.duration;
  total_.limited_steps += outcome.limited_steps;
  total_.velocity_use = std::max(total_.velocity_use, outcome.velocity_use);
  total_.torque_use = std::max(total_.torque_use, outcome.torque_use);
  total_.reached += outcome.reached;
  if (!total_.first_contact) total_.first_contact = outcome.first_contact;
}

std::string Stage::known_camera() const {
  const std::vector<std::string> cameras = camera_names(model_);
  return std::ranges::find(cameras, camera_) != cameras.end() ? camera_ : std::string();
}

Result<void> Stage::follow(ControlMode mode, bool measured, const Curve* curve,
                           const Follower& follower) {
  if (ended_early()) return {};
  if (options_.video && !show_.is_filming()) {
    auto filming = show_.film(model_, options_.out / kVideoFile, known_camera());
    if (!filming) return filming;
  }
  Result<Controller> controller = Controller::make(model_, arm_, mode);
  if (!controller) return fail(std::move(controller.error()));
  const double from = sim_.time();
  const double wall = seconds_now();
  const Result<FollowOutcome, FollowFailure> outcome = follower(setup(*controller, measured));
  wall_seconds_ += seconds_now() - wall;

  if (!outcome && outcome.error().error) return fail(*outcome.error().error);
  add(outcome ? *outcome : outcome.error().outcome);
  if (!outcome) {
    end_reason_ = "waypoint_not_reached";
    end_detail_ = describe(outcome.error(), arm_);
  } else if (outcome->stopped) {
    end_reason_ = "stopped";
    end_detail_ = text(msg::demo_stopped, sim_.time());
  }
  if (measured) {
    measured_.push_back(
        {curve != nullptr ? std::optional(*curve) : std::nullopt, from, sim_.time(), {}});
  }
  return {};
}

Result<void> Stage::approach(std::span<const double> q, ControlMode mode) {
  const Result<Trajectory> move = time_joint_move(as_span(q_command_), q, arm_.limits);
  if (!move) return fail(move.error());
  return approach(*move, mode, 0.2);
}

Result<void> Stage::approach(const Trajectory& move, ControlMode mode, double settle) {
  q_command_ = move.at(move.duration()).q;
  return follow(mode, false, nullptr, [&](const FollowSetup& setup) {
    return follow_time(setup, move, {.settle = settle});
  });
}

Result<void> Stage::run(const Trajectory& trajectory, ControlMode mode, double settle,
                        const Curve* curve, const Pose& X_TU) {
  q_command_ = trajectory.at(trajectory.duration()).q;
  const std::size_t before = measured_.size();
  Result<void> done = follow(mode, true, curve, [&](const FollowSetup& setup) {
    return follow_time(setup, trajectory, {.settle = settle});
  });
  if (measured_.size() > before) measured_.back().X_TU = X_TU;
  return done;
}

Result<void> Stage::jump(const JointVec& q, ControlMode mode, double seconds) {
  const JointState rest = JointState::at_rest(q);
  const Result<Trajectory> stay = Trajectory::through({0, seconds}, {rest, rest});
  if (!stay) return fail(stay.error());
  return run(*stay, mode, 0);
}

Result<void> Stage::wait_through(std::span<const JointVec> waypoints,
                                 std::span<const Eigen::Vector3d> points, ControlMode mode,
                                 const Curve* curve) {
  if (!waypoints.empty()) q_command_ = waypoints.back();
  return follow(mode, true, curve, [&](const FollowSetup& setup) {
    return points.empty() ? follow_joints(setup, waypoints) : follow_tool(setup, waypoints, points);
  });
}

Result<MeasuredRun> Stage::rehearse(const Trajectory& trajectory, ControlMode mode,
                                    const Curve& curve) {
  Result<Controller> controller = Controller::make(model_, arm_, mode);
  if (!controller) return fail(std::move(controller.error()));
  Sim sim(model_);
  sim.place(arm_, as_span(trajectory.at(0).q));
  show_.set_trail(false);
  show_.set_filming(false);
  Recorder recorder(model_, arm_);
  const auto outcome = follow_time(
      {.sim = sim,
       .controller = *controller,
       .arm = arm_,
       .recorder = &recorder,
       .after_step = [this](const Sim& other, const JointVec&) { return show_step(other); }},
      trajectory, {.settle = 0.3});
  show_.set_filming(true);
  if (!outcome && outcome.error().error) return fail(*outcome.error().error);
  MeasuredRun run{.rows = {}, .curve = &curve};
  for (std::size_t i = 0; i < recorder.size(); ++i) run.rows.push_back(recorder.row(i));
  return run;
}

void Stage::tell(const ToolMotion& motion, Report& report) const {
  add_motion(motion, arm_, report);
  for (const SpeedDip& dip : motion.dips) log_info(describe(dip, arm_));
}

Result<void> Stage::save_comparison(const Plot& page) const {
  const std::filesystem::path stem = options_.out / "comparison";
  log_info(text(msg::demo_compared, stem.string() + ".png"));
  return save_plot(page, stem);
}

std::vector<MeasuredRun> Stage::measured_runs() const {
  std::vector<MeasuredRun> runs;
  for (const Measured& part : measured_) {
    runs.push_back({.rows = {}, .curve = part.curve ? &*part.curve : nullptr});
  }
  // Runs follow each other; a row at the border of two belongs to both.
  std::size_t first = 0;
  for (std::size_t i = 0; i < recorder_.size(); ++i) {
    const RecordRow row = recorder_.row(i);
    while (first < runs.size() && measured_[first].to < row.time) ++first;
    for (std::size_t k = first; k < runs.size() && measured_[k].from <= row.time; ++k) {
      RecordRow& kept = runs[k].rows.emplace_back(row);
      kept.X_ref = kept.X_ref * measured_[k].X_TU;
      kept.X_WT = kept.X_WT * measured_[k].X_TU;
    }
  }
  for (MeasuredRun& run : runs) {
    if (run.curve == nullptr) continue;
    std::vector<Eigen::Vector3d> p_W;
    for (const RecordRow& row : run.rows) p_W.push_back(row.X_WT.p);
    run.error = path_error(*run.curve, p_W);
  }
  return runs;
}

/// Errors of the measured runs together.
void Stage::measure(std::span<const MeasuredRun> runs, Report& report) const {
  PathError all;
  double sum2 = 0, covered = 0, length = 0;
  std::size_t count = 0;
  for (const MeasuredRun& run : runs) {
    if (!run.error) continue;
    const PathError& error = *run.error;
    sum2 += error.rms * error.rms * static_cast<double>(run.rows.size());
    count += run.rows.size();
    covered += error.coverage * run.curve->length();
    length += run.curve->length();
    if (error.max >= all.max) {
      all.max = error.max;
      all.at = error.at;
    }
    for (std::size_t i = 1; i < run.rows.size(); ++i) {
      const RecordRow &before = run.rows[i - 1], &row = run.rows[i];
      const double speed = (row.X_WT.p - before.X_WT.p).norm() / (row.time - before.time);
      report.tool_speed_max = std::max(report.tool_speed_max.value_or(0), speed);
    }
  }
  if (count == 0 || length == 0) return;
  all.rms = std::sqrt(sum2 / static_cast<double>(count));
  all.coverage = covered / length;
  report.path_error = all;
  report.coverage = all.coverage;
}

Result<Report> Stage::finish(Report report, double tolerance) {
  return finish(std::move(report), tolerance, measured_runs());
}

Result<Report> Stage::finish(Report report, double tolerance, std::span<const MeasuredRun> runs) {
  measure(runs, report);
  report.ok = !ended_early();
  report.reason = end_reason_;
  report.detail = end_detail_;
  const bool off_path =
      report.path_error && (report.path_error->max > tolerance || report.coverage < 0.999);
  const bool off_goal = report.static_error && report.static_error->position > tolerance;
  if (report.ok && (off_path || off_goal)) {
    const double error = off_path ? report.path_error->max : report.static_error->position;
    report.ok = false;
    report.reason = off_path ? "path_error" : "static_error";
    report.detail = text(msg::demo_off_path, 1e3 * error, 1e3 * tolerance, 100 * report.coverage);
  }
  Plot plot = motion_plot(demo_, arm_, runs, tolerance);
  if (report.path_error) {
    plot.note = text(msg::demo_plot_note, control_, 1e3 * report.path_error->max,
                     1e3 * report.path_error->rms, 100 * report.coverage);
  }
  return write(std::move(report), std::move(plot));
}

Result<Report> Stage::write(Report report, Plot plot) {
  report.name = demo_;
  report.model = model_.name();
  if (report.control.empty()) report.control = control_;
  report.duration = total_.duration;
  report.steps = static_cast<long>(total_.steps);
  report.velocity_use = total_.velocity_use;
  report.torque_use = total_.torque_use;
  report.saturated_steps = static_cast<long>(total_.limited_steps);
  if (total_.first_contact) {
    const Contact& contact = total_.first_contact->contact;
    report.first_contact =
        contact.first + " - " + contact.second + " at " + number(total_.first_contact->time) + " s";
  }
  if (options_.timing && !show_.has_window() && !show_.is_filming() && wall_seconds_ > 0) {
    report.rtf = total_.duration / wall_seconds_;
  }
  const DemoOutput output{report, std::move(plot), show_.overlay(), known_camera()};
  auto written = recorder_.write_csv(options_.out / "log.csv").and_then([&] {
    return write_output(options_.out, model_, sim_.snapshot(), output);
  });
  if (written) written = show_.end_film();
  if (!written) return fail(std::move(written.error()));
  show_.linger(sim_);
  return report;
}

Result<Report> Stage::refuse(std::string_view reason, const std::string& detail, Report report) {
  report.ok = false;
  report.reason = reason;
  report.detail = detail;
  return write(std::move(report), {});
}

Result<Report> Stage::refuse(const MotionFailure& failure) {
  return refuse(failure.path ? name(failure.path->code) : "timing", describe(failure, arm_));
}

}  // namespace mjarm::app
