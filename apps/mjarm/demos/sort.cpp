#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/output_folder.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/execution/measured_run.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/scene_bodies.hpp"
#include "mjarm/render/fonts.hpp"
#include "mjarm/session/run_charts.hpp"
#include "mjarm/session/run_output.hpp"
#include "mjarm/session/run_show.hpp"
#include "mjarm/session/see_scene.hpp"
#include "mjarm/session/sort_objects.hpp"

namespace mjarm::app {
namespace {

constexpr double kOffSpot = 0.01;        // [m] of an object from its spot
constexpr double kOffPath = 5e-4;        // [m] of the tool from its straight ways, for the plot
constexpr std::size_t kMaxRows = 20000;  // of the log

/// The two kinds of the scenes; bodies and sites begin with their names.
struct SortKind {
  const char* name;
  double standing;  ///< [m] height of its middle then
  double lying;     ///< [m] likewise on its side, 0: it has none
};
constexpr std::array<SortKind, 2> kSortKinds = {{{"cube", 0.018, 0}, {"can", 0.035, 0.025}}};

/// What a site `KIND_spotN` of the scene's bins is for, and all objects of that kind.
std::vector<session::SortBin> bins_of(const Robot& robot) {
  std::vector<session::SortBin> bins;
  for (const SortKind& kind : kSortKinds) {
    session::SortBin& bin = bins.emplace_back();
    for (const SceneObject& object : scene_bodies(robot.model, robot.arm).objects) {
      if (object.name.starts_with(kind.name)) bin.objects.push_back(object.name);
    }
    for (int k = 1;; ++k) {
      const auto spot =
          frame_pose(robot.model, std::string(kind.name) + "_spot" + std::to_string(k));
      if (!spot) break;
      bin.spots_W.push_back(spot->p);
    }
  }
  return bins;
}

/// Places on the table between the bins, so far from each other that fingers get between most.
std::vector<Eigen::Vector2d> places_apart(Rng& rng, std::size_t count) {
  constexpr double kApart = 0.075;                          // [m]
  constexpr double kMinX = 0.31, kMaxX = 0.65, kY = 0.145;  // [m]
  constexpr int kDraws = 1000;                              // before all is begun anew
  std::vector<Eigen::Vector2d> out;
  for (int draw = 1; out.size() < count; ++draw) {
    if (draw % kDraws == 0) out.clear();
    const double x = rng.uniform(kMinX, kMaxX);
    const Eigen::Vector2d at(x, rng.uniform(-kY, kY));
    const auto is_near = [&](const Eigen::Vector2d& other) { return (other - at).norm() < kApart; };
    if (std::ranges::none_of(out, is_near)) out.push_back(at);
  }
  return out;
}

/// Puts all objects there, turned at will, every third can on its side.
void scatter(Rng& rng, const std::vector<session::SortBin>& bins, Sim& sim) {
  constexpr double kTable = 0.2;  // [m] height
  std::size_t count = 0;
  for (const session::SortBin& bin : bins) count += bin.objects.size();
  std::vector<Eigen::Vector2d> places = places_apart(rng, count);
  for (std::size_t b = 0; b < bins.size(); ++b) {
    const SortKind& kind = kSortKinds[b];
    for (const std::string& object : bins[b].objects) {
      const bool lies = kind.lying > 0 && rng.below(3) == 0;
      const double z = kTable + (lies ? kind.lying : kind.standing);
      const double roll = lies ? std::numbers::pi / 2 : 0;
      const double yaw = rng.uniform(-std::numbers::pi, std::numbers::pi);
      sim.place_free(object, {.p = {places.back().x(), places.back().y(), z},
                              .R = from_euler({roll, 0, yaw})});
      places.pop_back();
    }
  }
}

/// All that the demo works with.
class SortDemo {
 public:
  SortDemo(const DemoOptions& options, const Robot& robot, session::SceneEye eye,
           session::RunShow show)
      : options_(options),
        robot_(robot),
        bins_(bins_of(robot)),
        sim_(robot.model),
        recorder_(robot.model, robot.arm, {.max_rows = kMaxRows}),
        eye_(std::move(eye)),
        show_(std::move(show)) {
    sim_.reset_home();
    sim_.hold_others(robot_.arm);
    Rng rng(options.values.seed);
    scatter(rng, bins_, sim_);
  }

  Result<Report> run() {
    if (options_.record) show_.record(sim_, &robot_.arm);
    if (options_.video) {
      auto filming = show_.film(robot_.model, options_.out / session::kVideoFile,
                                session::default_camera(robot_.model));
      if (!filming) return fail(std::move(filming.error()));
    }
    const Pose X_WT = sim_.tool(robot_.arm);
    const session::Look look = [&](const SceneState& scene, std::span<const double> q) {
      return eye_.look(scene, q);
    };
    // Where the arm stands at first it hides nothing.
    const session::SortOptions options{
        .pick = {.pick = {.stop = [this] { return ended_ || interrupted(); }},
                 .control = options_.control.value_or(ControlMode::computed_torque),
                 .vantages = {{X_WT, look}},
                 .recorder = &recorder_,
                 .after_step = [this](const Sim& sim) { show_step(sim); }},
        .after_object = [this](const session::SortedObject& object) { tell(object); }};
    auto outcome = session::sort_objects(robot_, sim_, look, bins_, options);
    if (!outcome) return fail(std::move(outcome.error()));
    return write(*outcome, options.pick.control);
  }

  /// Keeps the window open, if there is one.
  void linger() { show_.linger(sim_); }
  [[nodiscard]] bool has_window() const { return show_.has_window(); }

 private:
  void show_step(const Sim& sim) {
    const bool enough = options_.seconds > 0 && sim.time() >= options_.seconds;
    if (!show_.step(sim, sim.tool(robot_.arm).p) || enough) ended_ = true;
  }

  void tell(const session::SortedObject& object) const {
    log_info(object.spot ? text(msg::demo_sort_put, object.name, *object.spot + 1, sim_.time())
                         : text(msg::demo_sort_left, object.name, object.what));
  }

  /// [m] The level distance of an object from its spot, as the simulation has both.
  [[nodiscard]] double off_spot(const session::SortedObject& object) const {
    const auto pose = frame_pose(robot_.model, object.name, sim_.qpos());
    const Eigen::Vector3d& spot = bins_[object.bin].spots_W[*object.spot];
    return (pose->p - spot).head<2>().norm();
  }

  /// What was measured in all grasps, and what became of the objects in them.
  void add_tries(const session::SortOutcome& outcome, FollowOutcome& total,
                 std::vector<MeasuredSpan>& spans, Report& report) const {
    std::map<std::string, ObservedObject> objects;
    for (const session::PickTry& one : outcome.tries) {
      const MotionPlan& plan = one.planned.plan;
      for (const ExecutedMotion& motion : one.motions) {
        const PlannedMove& move = plan.moves[motion.move];
        total.add(motion.outcome);
        add_motion(move, robot_.arm, report);
        if (move.is_approach()) continue;
        spans.push_back({.curve = move.curve, .from = motion.from, .to = motion.to});
      }
      // Of an object that was carried more than once the last time counts, but for faults.
      for (const ObservedObject& object : one.objects) {
        const auto known = objects.find(object.name);
        if (known != objects.end() && known->second.fault != ObjectFault::none) continue;
        objects.insert_or_assign(object.name, object);
      }
    }
    for (auto& [name, object] : objects) report.objects.push_back(std::move(object));
  }

  /// What is wrong with how it was done, the worst first.
  void judge(const session::SortOutcome& outcome, double worst, Report& report) const {
    const std::size_t placed = outcome.placed(), all = outcome.objects.size();
    const auto left = std::ranges::find_if(
        outcome.objects, [](const session::SortedObject& one) { return !one.spot.has_value(); });
    const auto harmed = std::ranges::find_if(report.objects, [](const ObservedObject& object) {
      return object.fault != ObjectFault::none;
    });
    if (ended_ || interrupted()) {
      report.reason = "stopped";
      report.detail =
          text(msg::demo_sort_some, placed, all, text(msg::demo_sort_stopped, sim_.time()));
    } else if (left != outcome.objects.end()) {
      report.reason = "left";
      report.detail =
          text(msg::demo_sort_some, placed, all, text(msg::demo_sort_left, left->name, left->what));
    } else if (worst > kOffSpot) {
      report.reason = "off_spot";
      report.detail = text(msg::demo_sort_off, 1e3 * worst, 1e3 * kOffSpot);
    } else if (harmed != report.objects.end()) {
      report.reason = name(harmed->fault);
      report.detail = describe(*harmed);
    } else {
      report.ok = true;
    }
  }

  Result<Report> write(const session::SortOutcome& outcome, ControlMode mode) {
    Report report;
    report.name = "sort";
    report.model = robot_.model.name();
    report.control = name(mode);
    FollowOutcome total;
    std::vector<MeasuredSpan> spans;
    add_tries(outcome, total, spans, report);
    put_outcome(total, report);
    report.duration = sim_.time();
    const std::vector<MeasuredRun> runs = measured_runs(recorder_, spans);
    report.path_error = path_error(runs);
    report.tool_speed_max = max_tool_speed(runs);
    report.held = sim_.held();
    report.done =
        static_cast<double>(outcome.placed()) / static_cast<double>(outcome.objects.size());
    std::map<std::string, double> errors;
    double worst = 0;
    for (const session::SortedObject& object : outcome.objects) {
      if (!object.spot) continue;
      errors[object.name] = off_spot(object);
      worst = std::max(worst, errors[object.name]);
    }
    judge(outcome, worst, report);
    report.facts = {{"seed", static_cast<double>(options_.values.seed)},
                    {"placed", static_cast<double>(outcome.placed())},
                    {"of", static_cast<double>(outcome.objects.size())},
                    {"grasps", static_cast<double>(outcome.tries.size())},
                    {"spot_error_max", worst},
                    {"spot_errors", std::move(errors)}};
    log_info(text(msg::demo_sort_summary, outcome.placed(), outcome.objects.size(), 1e3 * worst,
                  outcome.tries.size(), sim_.time()));
    const LanguageScope drawn(render::picture_language());
    const session::RunOutput output{
        report, session::motion_plot("sort", robot_.arm, runs, kOffPath), show_.overlay(),
        session::default_camera(robot_.model), show_.is_filming()};
    auto written =
        recorder_.write_csv(options_.out / "log.csv")
            .and_then([&] {
              return session::write_output(options_.out, robot_.model, sim_.snapshot(), output);
            })
            .and_then([&] {
              return show_.end_record(robot_.model, sim_.snapshot(), output, options_.record);
            })
            .and_then([&] { return show_.end_film(); });
    if (!written) return fail(std::move(written.error()));
    return report;
  }

  const DemoOptions& options_;
  const Robot& robot_;
  std::vector<session::SortBin> bins_;
  Sim sim_;
  Recorder recorder_;
  session::SceneEye eye_;
  session::RunShow show_;
  bool ended_ = false;  ///< by the user, or by --seconds
};

}  // namespace

Result<Report> run_sort(const DemoOptions& options) {
  static const std::map<std::string, std::string> kScenes = {
      {"ur5e", "universal_robots_ur5e/sort.xml"}, {"panda", "franka_emika_panda/sort.xml"}};
  const auto scene = kScenes.find(options.robot.robot);
  if (scene == kScenes.end()) return fail(Errc::usage, text(msg::demo_own_scenes, "sort"));
  const Result<Robot> robot = load_robot({.robot = scene->second, .tip = options.robot.tip});
  if (!robot) return fail(robot.error());
  Result<session::SceneEye> eye =
      session::SceneEye::open(*robot, "rgbd", {.seed = options.values.seed});
  if (!eye) return fail(std::move(eye.error()));
  const Result<OutputFolder> folder = OutputFolder::open(options.out, options.replace);
  if (!folder) return fail(folder.error());
  Result<session::RunShow> show =
      session::RunShow::open(robot->model, "mjarm sort", options.headless);
  if (!show) return fail(std::move(show.error()));
  SortDemo demo(options, *robot, std::move(*eye), std::move(*show));
  Result<Report> report = demo.run();
  if (!report) return report;
  if (!demo.has_window()) folder->made();
  demo.linger();
  return report;
}

}  // namespace mjarm::app
