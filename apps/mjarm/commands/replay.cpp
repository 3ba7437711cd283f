#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/print.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/record.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/messages/episode.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/core/threads.hpp"
#include "mjarm/episode/episode_file.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string path, episodes = "1", processes = "1";
  bool all = false, json = false;
};

constexpr int kMostEpisodes = 1'000'000;
constexpr int kMostProcesses = 1024;

/// What is looked at, and of how many.
struct Chosen {
  std::vector<fs::path> files;
  std::size_t of = 1;
};

Result<Chosen> files_of(const Options& options) {
  std::error_code unknown;
  if (!fs::is_directory(options.path, unknown)) return Chosen{.files = {options.path}};
  Chosen out{.files = episode::episode_files(options.path)};
  if (out.files.empty()) return fail(Errc::bad_input, text(msg::episode_none, options.path));
  out.of = out.files.size();
  const Result<int> episodes = parse_count("--episodes", options.episodes, kMostEpisodes);
  if (!episodes) return fail(episodes.error());
  const auto wanted = static_cast<std::size_t>(*episodes);
  if (!options.all && out.files.size() > wanted) out.files.resize(wanted);
  return out;
}

/// Makes episodes again, with the studio of the one before where it serves.
class Replayer {
 public:
  /// @return where it differs; empty where it does not.
  Result<std::string> replay(const fs::path& file) {
    const Result<episode::EpisodeFile> kept = episode::read_episode(file);
    if (!kept) return fail(kept.error());
    if (!studio_ || options_ != kept->head.options) {
      Result<episode::Studio> opened = episode::Studio::open(kept->head.options);
      if (!opened) return fail(std::move(opened.error()));
      studio_ = std::move(*opened);
      options_ = kept->head.options;
    }
    return episode::replay(*studio_, *kept, file.string(), interrupted);
  }

 private:
  std::optional<episode::Studio> studio_;
  episode::EpisodeOptions options_;
};

/// Where each file differs, several of them at the same time.
Result<std::vector<std::string>> replay_all(const std::vector<fs::path>& files, int processes) {
  Progress progress(text(msg::replay_progress), files.size());
  std::vector<std::string> out(files.size());
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;  // of what follows
  std::optional<Error> error;
  run_in_threads(processes, [&](int) {
    Replayer replayer;
    for (std::size_t i = next++; i < files.size(); i = next++) {
      Result<std::string> where = replayer.replay(files[i]);
      const std::scoped_lock lock(mutex);
      if (!where && !error) error = std::move(where.error());
      if (error) return;
      out[i] = std::move(*where);
      progress.advance();
    }
  });
  if (error) return fail(std::move(*error));
  return out;
}

Result<int> run(const Options& options) {
  if (options.path.empty()) return fail(Errc::usage, text(msg::replay_which));
  const Result<int> processes = parse_count("--processes", options.processes, kMostProcesses);
  if (!processes) return fail(processes.error());
  catch_interrupts();
  const Result<Chosen> chosen = files_of(options);
  if (!chosen) return fail(chosen.error());
  const std::vector<fs::path>& files = chosen->files;
  const Result<std::vector<std::string>> differs = replay_all(files, *processes);
  if (!differs) return fail(differs.error());
  std::vector<JsonDoc> docs;
  std::string first, lines;
  std::size_t different = 0;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string& where = (*differs)[i];
    docs.push_back({{"file", files[i].string()}, {"same", where.empty()}, {"differs", where}});
    if (where.empty()) continue;
    if (first.empty()) first = files[i].filename().string() + ", " + where;
    lines += text(msg::replay_differs, files[i].string(), where) + '\n';
    ++different;
  }
  lines += text(msg::replay_same, files.size() - different, files.size()) + '\n';
  if (files.size() < chosen->of) {
    lines += text(msg::replay_some, files.size(), chosen->of, options.path) + '\n';
  }
  const JsonDoc doc{{"episodes", std::move(docs)}, {"of", chosen->of}};
  print_lines(options.json ? doc.document() : lines);
  if (different == 0) return 0;
  return fail(Errc::impossible,
              text(msg::replay_not_all, options.path, different, files.size(), first));
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_option(app, "path", options->path, msg::replay_option_path, "DIR|FILE");
  add_option(app, "--episodes", options->episodes, msg::replay_option_episodes, "N");
  add_option(app, "--processes", options->processes, msg::replay_option_processes, "P");
  add_flag(app, "--all", options->all, msg::replay_option_all);
  add_flag(app, "--json", options->json, msg::app_option_json);
  return [options] { return run(*options); };
}

}  // namespace

Command replay_command() { return {"replay", msg::replay_summary, msg::replay_examples, setup}; }

}  // namespace mjarm::app
