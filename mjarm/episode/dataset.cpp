#include "mjarm/episode/dataset.hpp"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <mutex>
#include <optional>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include "mjarm/core/file.hpp"
#include "mjarm/core/json.hpp"
#include "mjarm/core/messages/episode.hpp"
#include "mjarm/core/messages/rl.hpp"
#include "mjarm/core/output_folder.hpp"
#include "mjarm/core/threads.hpp"
#include "mjarm/episode/draw_scene.hpp"
#include "mjarm/episode/episode_file.hpp"
#include "mjarm/episode/options_json_internal.hpp"

namespace mjarm::episode {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxHead = std::size_t{1} << 26;  // [bytes] of dataset.json
constexpr const char* kDatasetSchema = "mjarm.dataset/1";

Result<void> is_same(const std::string& file, const char* option, const std::string& before,
                     const std::string& now) {
  if (before == now) return {};
  return fail(Errc::usage, text(msg::episode_other_option, file, option, before, now));
}

/// Whether dataset.json, where there is one, was made with the same options.
Result<void> fits(const fs::path& file, const EpisodeOptions& now, const std::string& model_hash) {
  std::error_code unknown;
  if (!fs::exists(file, unknown)) return {};
  const Result<std::string> content = read_file(file, kMaxHead);
  if (!content) return fail(content.error());
  const std::string source = file.string();
  const auto parsed = JsonObject::parse(*content);
  if (!parsed) {
    return fail(Errc::bad_input, text(msg::episode_json, source, file.filename().string(),
                                      describe(parsed.error())));
  }
  FieldReader fields(**parsed, source);
  const EpisodeOptions before = fields.options();
  const std::string hash = fields.string("model_hash");
  if (!fields.fault().empty()) return fail(Errc::bad_input, fields.fault());
  const std::pair<const char*, std::pair<std::string, std::string>> pairs[] = {
      {"task", {before.task, now.task}},
      {"--robot", {before.robot, now.robot}},
      {"--seed", {std::to_string(before.seed), std::to_string(now.seed)}},
      {"--size", {std::to_string(before.size), std::to_string(now.size)}},
      {"--fps", {std::to_string(before.fps), std::to_string(now.fps)}}};
  for (const auto& [option, values] : pairs) {
    if (auto same = is_same(source, option, values.first, values.second); !same) return same;
  }
  if (hash == model_hash) return {};
  return fail(Errc::usage, text(msg::episode_other_model, source, hash, model_hash));
}

class DatasetWriter {
 public:
  DatasetWriter(fs::path folder, const DatasetOptions& options)
      : folder_(std::move(folder)), options_(options) {}

  Result<DatasetOutcome> run() {
    Result<Studio> studio = Studio::open(options_.episode);
    if (studio) model_hash_ = studio->model_hash();
    std::optional<OpenFolders> held;
    Result<void> done = studio ? begin(held) : fail(studio.error());
    if (auto together = with_all(std::move(done)); !together) return fail(together.error());
    find_missing();
    make_all(std::move(*studio));
    done = error_ ? fail(std::move(*error_)) : Result<void>();
    if (auto together = with_all(std::move(done)); !together) return fail(together.error());
    add_up();
    done = leads() ? write_head() : Result<void>();
    if (auto together = with_all(std::move(done)); !together) return fail(together.error());
    if (held) held->folder.made();
    if (held) held->failed.made();
    return out_;
  }

 private:
  struct OpenFolders {
    OutputFolder folder, failed;
  };

  [[nodiscard]] bool leads() const {
    return options_.ranks == nullptr || options_.ranks->rank() == 0;
  }

  /// What came of it here, or that another process failed.
  Result<void> with_all(Result<void> here) const {
    if (on_any_rank(options_.ranks, !here) && here) {
      return fail(Errc::impossible, text(msg::rl_failed_rank));
    }
    return here;
  }

  /// The first of all processes holds the folder for them.
  Result<void> begin(std::optional<OpenFolders>& held) {
    if (!leads()) return {};
    Result<OutputFolder> folder = OutputFolder::open(folder_, {.overwrite = true});
    if (!folder) return fail(std::move(folder.error()));
    Result<OutputFolder> failed = OutputFolder::open(failed_folder(), {.overwrite = true});
    if (!failed) return fail(std::move(failed.error()));
    held = OpenFolders{std::move(*folder), std::move(*failed)};
    if (auto same = fits(head_file(), options_.episode, model_hash_); !same) return same;
    return write_head();
  }

  /// What all processes did.
  void add_up() {
    if (options_.ranks == nullptr) return;
    EpisodeTimes& times = out_.times;
    double sums[] = {double(out_.made), double(out_.found), out_.stopped ? 1.0 : 0.0,
                     times.planning,    times.physics,      times.rendering,
                     times.compression};
    options_.ranks->sum(std::span<double>(sums));
    out_.made = static_cast<std::uint64_t>(sums[0]);
    out_.found = static_cast<std::uint64_t>(sums[1]);
    out_.stopped = sums[2] > 0;
    times = {sums[3], sums[4], sums[5], sums[6]};
  }

  [[nodiscard]] fs::path failed_folder() const { return folder_ / "failed"; }
  [[nodiscard]] fs::path head_file() const { return folder_ / "dataset.json"; }

  void find_missing() {
    std::error_code unknown;
    const Ranks* ranks = options_.ranks;
    const auto size = static_cast<std::uint64_t>(ranks == nullptr ? 1 : ranks->size());
    const auto rank = static_cast<std::uint64_t>(ranks == nullptr ? 0 : ranks->rank());
    for (std::uint64_t i = rank; i < options_.episodes; i += size) {
      const std::uint64_t number = options_.first + i;
      const std::string name = episode_name(number);
      if (fs::exists(folder_ / name, unknown) || fs::exists(failed_folder() / name, unknown)) {
        ++out_.found;
      } else {
        missing_.push_back(number);
      }
    }
  }

  void make_all(Studio first) {
    run_in_threads(options_.processes, [&](int thread) {
      std::optional<Studio> studio;
      if (thread == 0) studio = std::move(first);
      while (!is_over()) {
        const std::size_t next = next_++;
        if (next >= missing_.size()) return;
        if (!studio) {
          Result<Studio> opened = Studio::open(options_.episode);
          if (!opened) return keep(std::move(opened.error()));
          studio = std::move(*opened);
        }
        make_one(*studio, missing_[next]);
      }
    });
    out_.stopped = out_.made < missing_.size();
  }

  [[nodiscard]] bool is_over() {
    const std::scoped_lock lock(mutex_);
    return error_ || is_stopped(options_.stop);
  }

  void make_one(Studio& studio, std::uint64_t number) {
    const Result<Episode> episode = studio.make(number, options_.stop);
    if (!episode) {
      if (!is_stopped(options_.stop)) keep(episode.error());
      return;
    }
    const fs::path& folder = episode->verdict.success() ? folder_ : failed_folder();
    auto written = write_file(folder / episode_name(number), episode->bytes);
    if (!written) return keep(std::move(written.error()));
    const std::scoped_lock lock(mutex_);
    ++out_.made;
    out_.times.add(episode->times);
    if (options_.after_episode) options_.after_episode(*episode);
  }

  void keep(Error error) {
    const std::scoped_lock lock(mutex_);
    if (!error_) error_ = std::move(error);
  }

  /// What the folder holds now, and how it was drawn.
  Result<void> write_head() {
    const EpisodeOptions& of = options_.episode;
    std::vector<JsonDoc> failures, ranges;
    out_.succeeded = succeeded_files(folder_).size();
    for (const fs::path& file : failed_files(folder_)) {
      const Result<EpisodeFile> episode = read_episode(file);
      if (!episode) return fail(episode.error());
      failures.push_back({{"number", static_cast<std::size_t>(episode->head.number)},
                          {"reason", episode->head.reason}});
    }
    out_.failed = failures.size();
    for (const DrawRange& range : draw_ranges(of.task)) {
      ranges.push_back({{"name", range.name},
                        {"unit", range.unit},
                        {"lower", range.lower},
                        {"upper", range.upper}});
    }
    JsonDoc doc{{"schema", kDatasetSchema},
                {"task", of.task},
                {"robot", of.robot},
                {"seed", static_cast<std::size_t>(of.seed)},
                {"size", of.size},
                {"fps", of.fps},
                {"model_hash", model_hash_},
                {"succeeded", static_cast<std::size_t>(out_.succeeded)},
                {"failed", static_cast<std::size_t>(out_.failed)},
                {"failures", std::move(failures)},
                {"ranges", std::move(ranges)}};
    return write_file(head_file(), doc.document());
  }

  fs::path folder_;
  const DatasetOptions& options_;
  std::string model_hash_;
  std::vector<std::uint64_t> missing_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;  ///< of what follows
  DatasetOutcome out_;
  std::optional<Error> error_;
};

}  // namespace

Result<DatasetOutcome> record_dataset(const fs::path& folder, const DatasetOptions& options) {
  return DatasetWriter(folder, options).run();
}

}  // namespace mjarm::episode
