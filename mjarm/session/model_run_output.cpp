#include "mjarm/session/model_run_output.hpp"

#include <algorithm>
#include <utility>

#include "mjarm/core/file.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/show.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/output_folder.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/session/run_output.hpp"
#include "mjarm/session/run_video.hpp"

namespace mjarm::session {
namespace {

std::vector<double> copy_of(std::span<const double> values) {
  return {values.begin(), values.end()};
}

JsonDoc contacts_of(const Sim& sim) {
  std::vector<JsonDoc> all;
  for (const Contact& contact : sim.contacts()) {
    all.push_back({{"first", contact.first}, {"second", contact.second}, {"depth", contact.depth}});
  }
  return all;
}

std::string json_of(const ModelRunReport& report, const Sim& end) {
  const Model& model = end.model();
  JsonDoc doc{{"name", "sim"}, {"model", std::string(model.name())}, {"ok", report.ok}};
  if (!report.ok) {
    doc.set("reason", report.reason);
    doc.set("detail", report.detail);
  }
  doc.set_all({{"duration", report.duration},
               {"steps", report.steps},
               {"timestep", model.timestep()},
               {"qpos_start", report.qpos_start},
               {"qpos_end", report.qpos_end},
               {"qvel_end", copy_of(end.qvel())},
               {"ctrl_end", copy_of(end.ctrl())},
               {"contacts_end", contacts_of(end)}});
  if (report.rtf) doc.set("rtf", *report.rtf);
  return doc.document();
}

/// One simulation with all that watches it.
class Watched {
 public:
  explicit Watched(const Model& model) : log_(model) {}

  Result<void> film(const Model& model, const ModelOutput& output) {
    Result<VideoOfRun> video =
        VideoOfRun::open(model, {.out = output.out / kVideoFile, .video = true}, output.camera);
    if (!video) return fail(std::move(video.error()));
    video_.emplace(std::move(*video));
    return {};
  }

  bool look(const Sim& sim, std::span<const double> ctrl) {
    log_.record(sim, ctrl);
    ++looks_;
    last_ = sim.snapshot();
    return !video_ || video_->step(sim, {});
  }

  Result<void> end_film(bool whole) {
    if (!video_ || (!whole && interrupted())) return {};
    Result<void> finished = video_->finish();
    if (finished) log_info(video_->summary());
    return finished;
  }

  [[nodiscard]] const StateLog& log() const { return log_; }
  [[nodiscard]] const Snapshot& last() const { return last_; }
  [[nodiscard]] long steps() const { return looks_ - 1; }
  [[nodiscard]] bool films() const { return video_.has_value(); }

 private:
  StateLog log_;
  std::optional<VideoOfRun> video_;
  Snapshot last_;
  long looks_ = 0;
};

/// Runs it to its end, whatever that is.
ModelRunReport run_watched(Sim& sim, const ModelRunOptions& options, Watched& watched) {
  ModelRunReport report;
  report.qpos_start = copy_of(sim.qpos());
  const double start = sim.time();
  const Stopwatch watch;
  const Result<bool> whole = run_model(
      sim, options,
      [&](const Sim& now, std::span<const double> ctrl) { return watched.look(now, ctrl); });
  const double wall = 1e-6 * watch.us();
  report.ok = whole && *whole;
  if (!whole) {
    report.reason = "unstable";
    report.detail = whole.error().what;
    (void)sim.restore(watched.last());  // the last moment that was sound
  } else if (!*whole) {
    report.reason = "stopped";
    report.detail = stopped().what;
  }
  report.duration = sim.time() - start;
  report.steps = watched.steps();
  report.qpos_end = copy_of(sim.qpos());
  if (wall > 0 && !watched.films()) report.rtf = report.duration / wall;
  return report;
}

}  // namespace

Result<ModelRunReport> simulate_model(const Model& model, const ModelRunOptions& options,
                                      const ModelOutput& output) {
  if (Result<void> length = check_run_length(model, options.seconds); !length) {
    return fail(length.error());
  }
  Result<Sim> sim = start_model(model, options.start);
  if (!sim) return fail(std::move(sim.error()));
  const Result<OutputFolder> folder = OutputFolder::open(output.out, output.replace);
  if (!folder) return fail(folder.error());
  Watched watched(model);
  if (!output.video) remove_stale(output.out, {kVideoFile});
  if (output.video) {
    if (Result<void> filming = watched.film(model, output); !filming) return fail(filming.error());
  }
  ModelRunReport report = run_watched(*sim, options, watched);
  if (!output.timing) report.rtf.reset();
  const Result<void> written =
      watched.log()
          .write_csv(output.out / "log.csv")
          .and_then([&] { return write_file(output.out / "report.json", json_of(report, *sim)); })
          .and_then([&] {
            const render::Plot plot = state_plot(std::string(model.name()), watched.log());
            return plot.panels.empty() ? Result<void>()
                                       : render::save_plot(plot, output.out / "plot");
          })
          .and_then([&] {
            return write_end_picture(output.out, model, sim->snapshot(), output.camera, {});
          })
          .and_then([&] { return watched.end_film(report.ok); });
  if (!written) return fail(written.error());
  return report;
}

}  // namespace mjarm::session
