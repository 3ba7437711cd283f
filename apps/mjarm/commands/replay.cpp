#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/print.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/record.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/messages/episode.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/episode/episode_file.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string path;
  bool all = false, json = false;
};

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
  if (!options.all) out.files.resize(1);
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

Result<int> run(const Options& options) {
  if (options.path.empty()) return fail(Errc::usage, text(msg::replay_which));
  catch_interrupts();
  const Result<Chosen> chosen = files_of(options);
  if (!chosen) return fail(chosen.error());
  const std::vector<fs::path>& files = chosen->files;
  Progress progress(text(msg::replay_progress), files.size());
  Replayer replayer;
  std::vector<JsonDoc> docs;
  std::string first, lines;
  std::size_t different = 0;
  for (const fs::path& file : files) {
    const Result<std::string> where = replayer.replay(file);
    if (!where) return fail(where.error());
    progress.advance();
    docs.push_back({{"file", file.string()}, {"same", where->empty()}, {"differs", *where}});
    if (where->empty()) continue;
    if (first.empty()) first = file.filename().string() + ", " + *where;
    lines += text(msg::replay_differs, file.string(), *where) + '\n';
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
  add_flag(app, "--all", options->all, msg::replay_option_all);
  add_flag(app, "--json", options->json, msg::app_option_json);
  return [options] { return run(*options); };
}

}  // namespace

Command replay_command() { return {"replay", msg::replay_summary, msg::replay_examples, setup}; }

}  // namespace mjarm::app
