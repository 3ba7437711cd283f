#include "mjarm/session/teleop_run.hpp"

#include <utility>
#include <vector>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/teleop.hpp"
#include "mjarm/core/output_folder.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/episode/led_episode.hpp"
#include "mjarm/model/scene_bodies.hpp"
#include "mjarm/sim/recorder.hpp"

namespace mjarm::session {
namespace {

/// The first contact of the arm in a simulation that it should not have.
std::string wrong_contact(const Sim& sim, const SceneBodies& scene, const Arm& arm) {
  const auto role = [&](int body) {
    return body < 0 ? BodyRole::scene : scene.role[static_cast<std::size_t>(body)];
  };
  for (const Contact& contact : sim.contacts(arm)) {
    const BodyRole a = role(contact.body1), b = role(contact.body2);
    const bool grips = (a == BodyRole::hand && b == BodyRole::object) ||
                       (b == BodyRole::hand && a == BodyRole::object);
    if (grips || (a == BodyRole::hand && b == BodyRole::hand) || contact.depth <= 0) continue;
    return text(msg::teleop_touched, contact.first, contact.second, sim.time());
  }
  return {};
}

class InputRun {
 public:
  InputRun(const Robot& robot, const TeleopRunOptions& options, Teleop teleop)
      : robot_(robot),
        options_(options),
        teleop_(std::move(teleop)),
        sim_(robot.model),
        scene_(scene_bodies(robot.model, robot.arm)),
        recorder_(robot.model, robot.arm) {
    sim_.reset_home();
    sim_.place(robot.arm, as_span(robot.arm.home));
    teleop_.begin(sim_);
    start_ = sim_.time();
  }

  Result<void> play(std::span<const TimedInput> inputs) {
    const Stopwatch watch;
    take();
    Eigen::Vector3d p = sim_.tool(robot_.arm).p;
    std::size_t at = 0;
    const double end = inputs.back().time - 1e-9;
    while (sim_.time() - start_ < end) {
      report_.stopped = is_stopped(options_.stop);
      if (report_.stopped) break;
      const double now = sim_.time() - start_ + 1e-9;
      while (at + 1 < inputs.size() && inputs[at + 1].time <= now) ++at;
      const bool begun = inputs[at].time <= now;
      if (auto done = teleop_.advance(sim_, begun ? inputs[at].input : TeleopInput()); !done) {
        return done;
      }
      take();
      report_.way += (sim_.tool(robot_.arm).p - p).norm();
      p = sim_.tool(robot_.arm).p;
    }
    report_.duration = sim_.time() - start_;
    report_.rtf = report_.duration / (1e-6 * watch.us());
    return {};
  }

  Result<void> write(const std::filesystem::path& folder) const {
    if (auto done = recorder_.write_csv(folder / "log.csv"); !done) return done;
    if (!options_.task.empty()) {
      const auto kept = episode::keep_led_episode(
          folder, robot_, {options_.robot, options_.task, options_.fps}, samples_);
      if (!kept) return fail(kept.error());
    }
    return write_file(folder / "report.json", report_.json(options_.timing).document());
  }

  [[nodiscard]] const TeleopRunReport& report() const { return report_; }

 private:
  void take() {
    recorder_.record(sim_, teleop_.reference());
    const TeleopState state = teleop_.state();
    if (state.limit == TeleopLimit::near) report_.slowed += teleop_.period();
    if (state.near && (!report_.nearest || state.near->distance < report_.nearest->distance)) {
      report_.nearest = state.near;
    }
    if (report_.touched.empty()) report_.touched = wrong_contact(sim_, scene_, robot_.arm);
    const double due = start_ + static_cast<double>(samples_.size()) / options_.fps;
    if (options_.task.empty() || sim_.time() < due - 1e-9) return;
    samples_.push_back({sim_.snapshot(), teleop_.reference(), state.grip});
  }

  const Robot& robot_;
  const TeleopRunOptions& options_;
  Teleop teleop_;
  Sim sim_;
  SceneBodies scene_;
  Recorder recorder_;
  double start_ = 0;
  TeleopRunReport report_;
  std::vector<episode::LedSample> samples_;
};

}  // namespace

JsonDoc TeleopRunReport::json(bool timing) const {
  JsonDoc out{{"ok", ok()},         {"duration", duration}, {"way", way},        {"slowed", slowed},
              {"stopped", stopped}, {"touched", touched},   {"nearest", nullptr}};
  if (nearest) {
    out.set(
        "nearest",
        {{"body1", nearest->body1}, {"body2", nearest->body2}, {"distance", nearest->distance}});
  }
  if (timing) out.set("rtf", rtf);
  return out;
}

Result<TeleopRunReport> play_inputs(const Robot& robot, std::span<const TimedInput> inputs,
                                    const TeleopRunOptions& options) {
  if (inputs.empty()) return fail(Errc::bad_input, text(msg::teleop_input_empty, "-"));
  Result<Teleop> teleop = Teleop::create(robot, options.teleop);
  if (!teleop) return fail(std::move(teleop.error()));
  std::optional<OutputFolder> folder;
  if (!options.out.empty()) {
    Result<OutputFolder> opened = OutputFolder::open(options.out, options.replace);
    if (!opened) return fail(std::move(opened.error()));
    folder.emplace(std::move(*opened));
  }
  InputRun run(robot, options, std::move(*teleop));
  if (auto played = run.play(inputs); !played) return fail(std::move(played.error()));
  if (folder) {
    if (auto written = run.write(folder->path()); !written) return fail(std::move(written.error()));
    folder->made();
  }
  return run.report();
}

}  // namespace mjarm::session
