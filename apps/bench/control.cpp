#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/bench/bumps.hpp"
#include "apps/bench/calligraphy.hpp"
#include "apps/bench/identify.hpp"
#include "apps/bench/messages/bench.hpp"
#include "apps/bench/robust.hpp"
#include "apps/bench/suite.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/cli/table.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "mjarm/collision/exact.hpp"
#include "mjarm/control/controller.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/program.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/execution/metrics.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/path/ellipse.hpp"
#include "mjarm/path/solve_path.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::app {
namespace {

/// One lap of an ellipse, its plane level, the tool pointing down: quintic in arc length from rest
/// to rest, a new IK answer for every time step.
struct LapOptions {
  std::string name;
  ControlMode mode = ControlMode::computed_torque;
  double seconds = 10;  ///< [s] of the lap, > 0
  double payload = 0;   ///< [kg] >= 0 at the tool, which the controller does not know
  ControlOptions control = {};
  std::optional<double> acceleration_limit = {};  ///< [rad/s^2] raised for this one
};

/// How a lap went.
struct LapResult {
  PathError error;         ///< of the tool against the ellipse, over the whole lap
  double second_half = 0;  ///< [m] worst distance from the ellipse from half way on
  double lag = 0;          ///< [m] worst distance of the tool from where it should be just then
  double peak_speed = 0;   ///< [m/s] of the tool, as asked for
  double peak_acceleration = 0;  ///< [rad/s^2] largest of any joint, as asked for
  double velocity_use = 0;       ///< largest share of a joint's velocity limit, as asked for
  long limited_steps = 0;        ///< in which a limit cut the command
  double rtf = 0;                ///< simulated seconds a second of wall clock, all in one thread
};

/// The share of the way that a quintic has gone after the share `x` of the time.
double quintic(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * (10 - x * (15 - 6 * x));
}

/// Drives one lap; everything it needs besides the options.
class Lap {
 public:
  Lap(const Model& world, const Arm& arm, Controller controller, Curve curve, JointVec q_start,
      double seconds)
      : arm_(arm),
        ik_(arm),
        controller_(std::move(controller)),
        curve_(std::move(curve)),
        sim_(world),
        h_(world.timestep()),
        steps_(static_cast<long>(std::ceil(seconds / h_))),
        seconds_(seconds),
        ctrl_(static_cast<std::size_t>(world.nu()), 0.0) {
    sim_.place(arm, as_span(q_start));
    std::ranges::copy(sim_.ctrl(), ctrl_.begin());
    reference_ = hold(as_span(q_start));
  }

  Result<LapResult> drive() {
    LapResult out;
    std::vector<Eigen::Vector3d> p_W{sim_.tool(arm_).p};
    const Stopwatch watch;
    for (long i = 0; i < steps_; ++i) {
      if (interrupted()) return fail(stopped());
      if (Result<void> done = step(i, out); !done) return fail(std::move(done.error()));
      const Eigen::Vector3d p = sim_.tool(arm_).p;
      out.lag = std::max(out.lag, (p - goal_.p).norm());
      p_W.push_back(p);
    }
    out.rtf = static_cast<double>(steps_) * h_ / (1e-6 * watch.us());
    out.error = path_error(curve_, p_W);
    const std::span<const Eigen::Vector3d> half = std::span(p_W).subspan(p_W.size() / 2);
    out.second_half = path_error(curve_, half).max;
    return out;
  }

 private:
  Result<void> step(long i, LapResult& out) {
    const double s = curve_.end() * quintic(static_cast<double>(i + 1) * h_ / seconds_);
    out.peak_speed = std::max(out.peak_speed, (s - s_) / h_);
    s_ = s;
    goal_ = curve_.at(s);
    const auto answer = ik_.solve(goal_, as_span(reference_.next));
    if (!answer) return fail(Errc::impossible, describe(answer.error(), arm_));
    reference_ = {reference_.now, reference_.next, answer->q};
    const JointVec v = (reference_.next - reference_.now) / h_;
    out.velocity_use =
        std::max(out.velocity_use, v.cwiseQuotient(arm_.limits.velocity).cwiseAbs().maxCoeff());
    out.peak_acceleration =
        std::max(out.peak_acceleration, reference_.acceleration(h_).cwiseAbs().maxCoeff());
    out.limited_steps += controller_.command(sim_.qpos(), sim_.qvel(), reference_, ctrl_) ? 1 : 0;
    return sim_.step(ctrl_);
  }

  const Arm& arm_;
  IkSolver ik_;
  Controller controller_;
  Curve curve_;
  Sim sim_;
  double h_;
  long steps_;
  double seconds_;
  std::vector<double> ctrl_;
  StepReference reference_;
  Pose goal_;
  double s_ = 0;
};

Result<LapResult> drive_lap(const Model& model, Arm arm, const LapOptions& options) {
  if (options.acceleration_limit) arm.limits.acceleration.setConstant(*options.acceleration_limit);
  const Ellipse ellipse{
      {0, -0.45, 0.4}, 0.3, 0.15, Eigen::Vector3d::UnitZ(), from_euler({std::numbers::pi, 0, 0})};
  const Result<Curve> curve = Curve::ellipse(ellipse);
  if (!curve) return fail(curve.error());
  constexpr int kPoints = 200;
  const std::vector<Pose> poses = ellipse_points(ellipse, kPoints);
  const auto path = solve_path(IkSolver(arm), poses, as_span(arm.home));
  if (!path) return fail(Errc::impossible, describe(path.error(), arm));
  Result<Controller> controller = Controller::create(model, arm, options.mode, options.control);
  if (!controller) return fail(std::move(controller.error()));
  Result<Model> world = model;
  if (options.payload > 0) world = model.with_point_mass(arm.tip, options.payload);
  if (!world) return fail(world.error());
  return Lap(*world, arm, std::move(*controller), *curve, path->q.front(), options.seconds).drive();
}

/// Errors at rest, the worst over many poses.
struct RestResult {
  ControlMode mode;
  int poses = 0;
  PoseError worst = {};
};
/// Asks the arm to stand at each of `poses` random postures that touch nothing, from 0.05 rad
/// beside them; the errors are read after 2 s.
Result<RestResult> rest_errors(const Model& model, const Arm& arm, ControlMode mode, int poses) {
  constexpr double kSeconds = 2;
  constexpr int kMaxDraws = 1000;  // for each pose
  constexpr double kNudge = 0.05;  // [rad or m] so far off it begins
  Rng rng(1);
  ExactChecker checker(model, arm);
  RestResult out{mode};
  for (int draw = 0; out.poses < poses && draw < kMaxDraws * poses; ++draw) {
    if (interrupted()) return fail(stopped());
    JointVec q(arm.dof());
    for (int i = 0; i < arm.dof(); ++i) {
      q[i] = rng.uniform(std::max(arm.limits.lower[i], -std::numbers::pi),
                         std::min(arm.limits.upper[i], std::numbers::pi));
    }
    if (!checker.is_free(as_span(q))) continue;
    Result<Controller> controller = Controller::create(model, arm, mode);
    if (!controller) return fail(std::move(controller.error()));
    JointVec q_start = q;
    for (double& value : q_start) value += rng.uniform(-kNudge, kNudge);
    Sim sim(model);
    sim.place(arm, as_span(clamp_to_limits(arm, as_span(q_start))));
    std::vector<double> ctrl(sim.ctrl().begin(), sim.ctrl().end());
    const StepReference reference = hold(as_span(q));
    bool touched = false;
    for (double t = 0; t < kSeconds && !touched; t += model.timestep()) {
      controller->command(sim.qpos(), sim.qvel(), reference, ctrl);
      if (Result<void> done = sim.step(ctrl); !done) return fail(std::move(done.error()));
      touched = !sim.contacts(arm).empty();
    }
    if (touched) continue;
    const PoseError error = pose_error(fk(arm, as_span(q)), sim.tool(arm));
    out.worst.position = std::max(out.worst.position, error.position);
    out.worst.rotation = std::max(out.worst.rotation, error.rotation);
    ++out.poses;
  }
  return out;
}

/// A lap and what it was asked for.
struct LapRun {
  LapOptions options;
  LapResult result = {};
};

constexpr ControlMode kModes[] = {ControlMode::servo, ControlMode::servo_gravity,
                                  ControlMode::feed_forward, ControlMode::computed_torque};
constexpr ControlOptions kWithIntegral{.stiffness = 4800, .damping = 120, .integral = 64000};

std::vector<LapRun> laps() {
  std::vector<LapRun> out;
  for (const ControlMode mode : kModes) out.push_back({{.name = "10 s", .mode = mode}});
  out.push_back({{.name = "4 s", .seconds = 4, .acceleration_limit = 15}});
  out.push_back({{.name = "10 s, 1 kg", .payload = 1}});
  out.push_back({{.name = "10 s, 1 kg, integral", .payload = 1, .control = kWithIntegral}});
  return out;
}

std::string millimetres(double metres) { return fmt::format("{:.4g}", 1e3 * metres); }

std::string to_table(const std::vector<RestResult>& rests, const std::vector<LapRun>& runs,
                     bool timing) {
  std::vector<std::vector<std::string>> rows{
      {text(msg::control_suite_rest), text(msg::control_suite_poses), "mm", "deg"}};
  for (const RestResult& rest : rests) {
    rows.push_back({std::string(name(rest.mode)), std::to_string(rest.poses),
                    millimetres(rest.worst.position),
                    fmt::format("{:.3g}", rest.worst.rotation * 180 / std::numbers::pi)});
  }
  std::string out = timing ? bench_occasion() + "\n\n" : std::string();
  out += markdown_table(rows) + "\n";
  rows = {{text(msg::control_suite_lap), text(msg::control_suite_control), "max mm", "rms mm",
           text(msg::control_suite_half), text(msg::control_suite_lag),
           text(msg::control_suite_covered), "m/s", "rad/s2", text(msg::control_suite_cut)}};
  if (timing) rows.front().emplace_back("rtf");
  for (const LapRun& run : runs) {
    const LapResult& lap = run.result;
    rows.push_back(
        {run.options.name, std::string(name(run.options.mode)), millimetres(lap.error.max),
         millimetres(lap.error.rms), millimetres(lap.second_half), millimetres(lap.lag),
         fmt::format("{:.1f} %", 100 * lap.error.coverage), fmt::format("{:.3f}", lap.peak_speed),
         fmt::format("{:.2f}", lap.peak_acceleration), std::to_string(lap.limited_steps)});
    if (timing) rows.back().push_back(fmt::format("{:.0f}", lap.rtf));
  }
  return out + markdown_table(rows);
}

std::string to_table(const std::vector<SheetResult>& sheets) {
  std::vector<std::vector<std::string>> rows{
      {text(msg::control_suite_sheet), text(msg::control_suite_characters),
       text(msg::control_suite_strokes), text(msg::control_suite_missed),
       text(msg::control_suite_ink), "rms mm", text(msg::control_suite_force),
       text(msg::control_suite_landing)}};
  for (const SheetResult& one : sheets) {
    std::string sheet = fmt::format("{:.1f} deg", one.sheet.tilt * 180 / std::numbers::pi);
    if (one.sheet.payload > 0) sheet += fmt::format(", {:g} kg", one.sheet.payload);
    rows.push_back({std::move(sheet), std::to_string(one.characters), std::to_string(one.strokes),
                    std::to_string(one.missed), fmt::format("{:.3f}", 1e3 * one.ink_max),
                    fmt::format("{:.3f}", 1e3 * one.ink_rms),
                    fmt::format("{:.3f} .. {:.3f}", one.least, one.most),
                    fmt::format("{:.2f}", one.landing)});
  }
  return "\n" + markdown_table(rows);
}

std::vector<JsonDoc> to_docs(const std::vector<SheetResult>& sheets) {
  std::vector<JsonDoc> docs;
  for (const SheetResult& one : sheets) {
    docs.push_back({{"tilt", one.sheet.tilt},
                    {"payload", one.sheet.payload},
                    {"characters", one.characters},
                    {"strokes", one.strokes},
                    {"missed", one.missed},
                    {"ink_max", one.ink_max},
                    {"ink_rms", one.ink_rms},
                    {"force_min", one.least},
                    {"force_max", one.most},
                    {"force_landing", one.landing}});
  }
  return docs;
}

JsonDoc to_json(const Robot& robot, const std::vector<RestResult>& rests,
                const std::vector<LapRun>& runs, bool timing) {
  std::vector<JsonDoc> rest_docs, lap_docs;
  for (const RestResult& rest : rests) {
    rest_docs.push_back({{"control", name(rest.mode)},
                         {"poses", rest.poses},
                         {"position", rest.worst.position},
                         {"rotation", rest.worst.rotation}});
  }
  for (const LapRun& run : runs) {
    const LapResult& lap = run.result;
    JsonDoc doc{{"name", run.options.name},
                {"control", name(run.options.mode)},
                {"seconds", run.options.seconds},
                {"payload", run.options.payload},
                {"integral", run.options.control.integral},
                {"path_error_max", lap.error.max},
                {"path_error_rms", lap.error.rms},
                {"second_half_max", lap.second_half},
                {"lag_max", lap.lag},
                {"coverage", lap.error.coverage},
                {"peak_speed", lap.peak_speed},
                {"peak_acceleration", lap.peak_acceleration},
                {"velocity_use", lap.velocity_use},
                {"limited_steps", static_cast<double>(lap.limited_steps)}};
    if (timing) doc.set("rtf", lap.rtf);
    lap_docs.push_back(std::move(doc));
  }
  return {
      {"model", robot.model.name()}, {"rest", std::move(rest_docs)}, {"laps", std::move(lap_docs)}};
}

struct ControlWords : ReportOptions {
  RobotChoice robot{.robot = "ur5e", .tip = {}};
  std::string poses = "100", characters = "100";
  bool robust = false, identify = false, bumps = false;
  RobustWords wrong;
  BumpWords pushed;
};

Result<int> run_control(const ControlWords& options) {
  constexpr int kMaxPoses = 100'000;
  const Result<int> poses = parse_count("--poses", options.poses, kMaxPoses);
  if (!poses) return fail(poses.error());
  const Result<int> characters = parse_count("--characters", options.characters, kCharacters);
  if (!characters) return fail(characters.error());
  const Result<Robot> robot = load_robot(options.robot);
  if (!robot) return fail(robot.error());
  if (options.identify) return run_identify(options, options.wrong, *robot);
  if (options.bumps) {
    return run_bumps(options, options.pushed, options.wrong.seed, options.wrong.plot, *robot);
  }
  if (options.robust) return run_robust(options, options.wrong, *robot);
  std::vector<LapRun> runs = laps();
  const int written = *characters * sheet_count();
  Progress progress(text(msg::control_suite_progress),
                    std::size(kModes) + runs.size() + static_cast<std::size_t>(written));
  std::vector<RestResult> rests;
  for (const ControlMode mode : kModes) {
    const auto rest = rest_errors(robot->model, robot->arm, mode, *poses);
    if (!rest) return fail(rest.error());
    rests.push_back(*rest);
    progress.advance();
  }
  for (LapRun& run : runs) {
    const auto lap = drive_lap(robot->model, robot->arm, run.options);
    if (!lap) return fail(lap.error());
    run.result = *lap;
    progress.advance();
  }
  std::vector<SheetResult> sheets;
  if (auto done = write_characters(*characters, [&] { progress.advance(); })) {
    sheets = std::move(*done);
  } else if (done.error().code == Errc::not_available) {
    log_info(done.error().what);
  } else {
    return fail(std::move(done.error()));
  }
  const bool timing = !options.no_timing;
  JsonDoc doc = to_json(*robot, rests, runs, timing);
  if (!sheets.empty()) doc.set("calligraphy", to_docs(sheets));
  const std::string table =
      to_table(rests, runs, timing) + (sheets.empty() ? "" : to_table(sheets));
  std::fputs((options.json ? doc.document() : table).c_str(), stdout);
  return 0;
}

}  // namespace

Command control_suite() {
  return {"control", msg::control_suite_summary, msg::control_suite_examples,
          [](CLI::App& app) -> Run {
            auto options = std::make_shared<ControlWords>();
            add_robot_options(app, options->robot);
            add_option(app, "--poses", options->poses, msg::control_suite_option_poses, "N");
            add_option(app, "--characters", options->characters,
                       msg::control_suite_option_characters, "N");
            add_flag(app, "--robust", options->robust, msg::control_suite_option_robust);
            add_flag(app, "--identify", options->identify, msg::control_suite_option_identify);
            add_robust_options(app, options->wrong);
            add_flag(app, "--bumps", options->bumps, msg::control_suite_option_bumps);
            add_bump_options(app, options->pushed);
            add_report_options(app, *options);
            return [options] { return run_control(*options); };
          }};
}

}  // namespace mjarm::app
