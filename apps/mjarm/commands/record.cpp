#include "apps/mjarm/messages/record.hpp"

#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/print.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/commands/processes.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/episode/dataset.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxEpisodes = 1'000'000;

struct Options {
  std::string task, out;
  std::string episodes = "10", first = "0", seed = "1", processes = "1", robot = "panda",
              size = "128", fps = "10";
  bool json = false;
};

Result<episode::DatasetOptions> parsed(const Options& options) {
  if (options.task.empty()) {
    const std::vector<std::string> tasks = episode::task_names();
    return fail(Errc::usage, text(msg::record_which, listed(tasks)));
  }
  const Result<int> episodes = parse_count("--episodes", options.episodes, kMaxEpisodes);
  if (!episodes) return fail(episodes.error());
  const Result<std::uint64_t> first = parse_whole("--first", options.first);
  if (!first) return fail(first.error());
  const auto last = static_cast<std::uint64_t>(kMaxEpisodes - *episodes);
  if (*first > last) return fail(Errc::usage, text(msg::record_bad_first, last, *first));
  const Result<std::uint64_t> seed = parse_whole("--seed", options.seed);
  if (!seed) return fail(seed.error());
  const Result<int> processes = parse_count("--processes", options.processes, 1024);
  if (!processes) return fail(processes.error());
  constexpr int kMax = std::numeric_limits<int>::max();  // check() knows what is possible
  const Result<int> size = parse_count("--size", options.size, kMax, 0);
  if (!size) return fail(size.error());
  const Result<int> fps = parse_count("--fps", options.fps, kMax, 0);
  if (!fps) return fail(fps.error());
  episode::DatasetOptions out{.episode = {.task = options.task,
                                          .robot = options.robot,
                                          .seed = *seed,
                                          .size = *size,
                                          .fps = *fps},
                              .first = *first,
                              .episodes = static_cast<std::uint64_t>(*episodes),
                              .processes = *processes};
  if (auto fits = episode::check(out.episode); !fits) {
    return fail(Errc::usage, fits.error().what);
  }
  return out;
}

/// What was done, for people; how fast where anything was.
std::string summary(const std::string& folder, const episode::DatasetOutcome& done,
                    double seconds) {
  std::string out =
      text(msg::record_done, folder, done.succeeded, done.failed, done.made, done.found) + '\n';
  const episode::EpisodeTimes& times = done.times;
  const double all = times.planning + times.physics + times.rendering + times.compression;
  if (done.made == 0 || !(all > 0)) return out;
  const auto share = [all](double part) { return 100 * part / all; };
  return out +
         text(msg::record_rate, 3600 * static_cast<double>(done.made) / seconds,
              share(times.planning), share(times.physics), share(times.rendering),
              share(times.compression)) +
         '\n';
}

std::string json_of(const std::string& folder, const episode::DatasetOutcome& done) {
  return JsonDoc{{"folder", folder},
                 {"succeeded", static_cast<std::size_t>(done.succeeded)},
                 {"failed", static_cast<std::size_t>(done.failed)},
                 {"made", static_cast<std::size_t>(done.made)},
                 {"found", static_cast<std::size_t>(done.found)}}
      .document();
}

Result<int> run(const Options& options) {
  catch_interrupts();
  Result<episode::DatasetOptions> dataset = parsed(options);
  if (!dataset) return fail(std::move(dataset.error()));
  const std::string folder = options.out.empty()
                                 ? (fs::path("mjarm-out") / "record" / options.task).string()
                                 : options.out;
  Result<std::unique_ptr<Ranks>> ranks = join_processes();
  if (!ranks) return fail(std::move(ranks.error()));
  dataset->ranks = ranks->get();
  const std::uint64_t share = dataset->ranks == nullptr ? 1 : dataset->ranks->size();
  Progress progress(text(msg::record_progress), (dataset->episodes + share - 1) / share);
  dataset->stop = interrupted;
  dataset->after_episode = [&](const episode::Episode& one) {
    progress.advance();
    if (!one.verdict.success()) {
      log_warning(text(msg::record_failed_one, one.number, one.verdict.reason));
    }
  };
  const Stopwatch watch;
  const Result<episode::DatasetOutcome> done = episode::record_dataset(folder, *dataset);
  if (!done) return fail(done.error());
  if (done->stopped) {
    return fail(Errc::impossible,
                text(msg::record_stopped, folder, done->made + done->found, dataset->episodes));
  }
  if (dataset->ranks != nullptr && dataset->ranks->rank() != 0) return 0;
  print_lines(options.json ? json_of(folder, *done) : summary(folder, *done, 1e-6 * watch.us()));
  return 0;
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_option(app, "task", options->task, msg::record_option_task, "TASK");
  add_option(app, "--out", options->out, msg::record_option_out, "DIR");
  add_option(app, "--episodes", options->episodes, msg::record_option_episodes, "N");
  add_option(app, "--first", options->first, msg::record_option_first, "N");
  add_option(app, "--seed", options->seed, msg::record_option_seed, "S");
  add_option(app, "--processes", options->processes, msg::record_option_processes, "P");
  add_option(app, "--robot", options->robot, msg::record_option_robot, "ROBOT");
  add_option(app, "--size", options->size, msg::record_option_size, "PIXELS");
  add_option(app, "--fps", options->fps, msg::record_option_fps, "F");
  add_flag(app, "--json", options->json, msg::app_option_json);
  return [options] { return run(*options); };
}

}  // namespace

Command record_command() { return {"record", msg::record_summary, msg::record_examples, setup}; }

}  // namespace mjarm::app
