#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/print.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/cloning.hpp"
#include "mjarm/clone/cloned_policy.hpp"
#include "mjarm/clone/demonstrated.hpp"
#include "mjarm/clone/learn.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/output_folder.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/core/units.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string data, policy, out, episodes = "0", epochs, scenes = "100", seed = "1", threads,
                                 least = "0";
  Replace replace;
  bool json = false;
};

struct Wanted {
  rl::CloningOptions cloning;
  std::size_t episodes = 0;
  int scenes = 0;
  double least = 0;
};

constexpr int kMost = 1'000'000;

Result<Wanted> parsed(const Options& options) {
  if (options.data.empty() && options.policy.empty()) {
    return fail(Errc::usage, text(msg::cloning_which));
  }
  if (!options.data.empty() && !options.policy.empty()) {
    return fail(Errc::usage, text(msg::cloning_both));
  }
  Wanted out;
  const Result<std::uint64_t> episodes = parse_whole("--episodes", options.episodes);
  if (!episodes) return fail(episodes.error());
  out.episodes = *episodes;
  if (!options.epochs.empty()) {
    const Result<int> epochs = parse_count("--epochs", options.epochs, kMost);
    if (!epochs) return fail(epochs.error());
    out.cloning.epochs = *epochs;
  }
  const Result<std::uint64_t> scenes = parse_whole("--scenes", options.scenes);
  if (!scenes) return fail(scenes.error());
  out.scenes = static_cast<int>(std::min<std::uint64_t>(*scenes, kMost));
  const Result<std::uint64_t> seed = parse_whole("--seed", options.seed);
  if (!seed) return fail(seed.error());
  out.cloning.seed = *seed;
  out.cloning.threads = core_count();
  if (!options.threads.empty()) {
    const Result<int> threads = parse_threads(options.threads);
    if (!threads) return fail(threads.error());
    out.cloning.threads = *threads;
  }
  const Result<double> least = parse_quantity(options.least, Quantity::number);
  if (!least || !(*least >= 0 && *least <= 1)) {
    return fail(Errc::usage, text(msg::cloning_bad_least, options.least));
  }
  out.least = *least;
  return out;
}

/// How the trials went, for people.
std::string summary(const std::vector<episode::Verdict>& trials) {
  if (trials.empty()) return {};
  std::vector<double> distances;
  std::map<std::string, int> reasons;
  int succeeded = 0;
  for (const episode::Verdict& one : trials) {
    distances.push_back(1e3 * one.position);
    if (one.success()) {
      ++succeeded;
    } else {
      ++reasons[one.reason];
    }
  }
  std::ranges::sort(distances);
  const auto within = [&](double mm) {
    return std::ranges::upper_bound(distances, mm) - distances.begin();
  };
  const std::size_t n = distances.size();
  std::string out =
      text(msg::cloning_result, succeeded, n, 1e3 * episode::kAtGoal,
           180 / std::numbers::pi * episode::kTurnedAtGoal, 1e3 * episode::kOthersMoved) +
      '\n' +
      text(msg::cloning_distances, distances[n / 2], distances[n * 9 / 10], distances.back(),
           within(10), n, within(20)) +
      '\n';
  for (const auto& [reason, count] : reasons) {
    out += text(msg::cloning_reason, count, reason) + '\n';
  }
  return out;
}

JsonDoc report(const std::vector<episode::Verdict>& trials) {
  std::vector<JsonDoc> docs;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    docs.push_back({{"scene", static_cast<std::size_t>(clone::kFirstTrial + i)},
                    {"success", trials[i].success()},
                    {"reason", trials[i].reason},
                    {"position", trials[i].position},
                    {"rotation", trials[i].rotation},
                    {"others", trials[i].others}});
  }
  return {{"schema", "mjarm.clone/1"}, {"trials", std::move(docs)}};
}

/// Learns, and writes policy and progress.
Result<clone::ClonedPolicy> learned(const Options& options, const Wanted& wanted,
                                    const fs::path& folder) {
  const Result<clone::Demonstrated> data =
      clone::read_demonstrated(options.data, wanted.episodes, interrupted);
  if (!data) return fail(data.error());
  print_lines(text(msg::cloning_data, data->numbers.size(), data->options.task, data->options.robot,
                   data->rows.size()) +
              '\n');
  Progress progress(text(msg::cloning_learning), static_cast<std::size_t>(wanted.cloning.epochs));
  const Stopwatch watch;
  std::string losses = "epoch,loss\n";
  Result<clone::ClonedPolicy> policy =
      clone::learn(*data, wanted.cloning, interrupted, [&](int epoch, double loss) {
        losses += std::to_string(epoch) + ',' + number(loss) + '\n';
        progress.advance();
      });
  if (!policy) return policy;
  const fs::path file = folder / "policy.safetensors";
  if (auto saved = clone::save_cloned(file, *policy); !saved) return fail(saved.error());
  if (auto written = write_file(folder / "progress.csv", losses); !written) {
    return fail(written.error());
  }
  print_lines(text(msg::cloning_learned, file.string(), wanted.cloning.epochs, 1e-6 * watch.us()) +
              '\n');
  return policy;
}

Result<int> run(const Options& options) {
  const Result<Wanted> wanted = parsed(options);
  if (!wanted) return fail(wanted.error());
  catch_interrupts();
  const fs::path folder =
      options.out.empty() ? fs::path("mjarm-out") / "clone" : fs::path(options.out);
  const Result<OutputFolder> held = OutputFolder::open(folder, options.replace);
  if (!held) return fail(held.error());
  const Result<clone::ClonedPolicy> cloned = options.policy.empty()
                                                 ? learned(options, *wanted, folder)
                                                 : clone::load_cloned(options.policy);
  if (!cloned) return fail(cloned.error());
  Progress progress(text(msg::cloning_trying), static_cast<std::size_t>(wanted->scenes));
  const auto trials = clone::try_often(*cloned, wanted->scenes, wanted->cloning.threads,
                                       interrupted, [&] { progress.advance(); });
  if (!trials) return fail(trials.error());
  const std::string json = report(*trials).document();
  if (auto written = write_file(folder / "report.json", json); !written) {
    return fail(written.error());
  }
  held->made();
  print_lines(options.json ? json : summary(*trials));
  const auto succeeded = std::ranges::count_if(*trials, &episode::Verdict::success);
  if (static_cast<double>(succeeded) < wanted->least * wanted->scenes) {
    return fail(Errc::impossible,
                text(msg::cloning_too_few, succeeded, wanted->scenes, 100 * wanted->least));
  }
  return 0;
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_option(app, "data", options->data, msg::cloning_option_data, "DIR");
  add_option(app, "--policy", options->policy, msg::cloning_option_policy, "FILE");
  add_option(app, "--out", options->out, msg::cloning_option_out, "DIR");
  add_overwrite_option(app, options->replace);
  add_option(app, "--episodes", options->episodes, msg::cloning_option_episodes, "N");
  add_option(app, "--epochs", options->epochs, msg::cloning_option_epochs, "N");
  add_option(app, "--scenes", options->scenes, msg::cloning_option_scenes, "N");
  add_option(app, "--seed", options->seed, msg::cloning_option_seed, "S");
  add_option(app, "--threads", options->threads, msg::cloning_option_threads, "T");
  add_option(app, "--least-success", options->least, msg::cloning_option_least, "SHARE");
  add_flag(app, "--json", options->json, msg::app_option_json);
  return [options] { return run(*options); };
}

}  // namespace

Command clone_command() { return {"clone", msg::cloning_summary, msg::cloning_examples, setup}; }

}  // namespace mjarm::app
