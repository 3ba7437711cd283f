#include <cstdio>
#include <memory>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/commands/page_options.hpp"
#include "apps/mjarm/commands/policy_run.hpp"
#include "apps/mjarm/commands/run_output.hpp"
#include "apps/mjarm/commands/train_outcome.hpp"
#include "apps/mjarm/commands/train_task.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "apps/mjarm/messages/train.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/units.hpp"

namespace mjarm::app {
namespace {

struct Options {
  std::string file, out, episodes = "200", least_success = "0.9";
  TaskArguments task{.task = "reach"};
  bool view = false, video = false, no_timing = false;
  RunPageArguments pages;
  Replace replace;
};

Result<rl::TrainedPolicy> load(const Options& options) {
  Result<rl::TrainedPolicy> loaded = rl::load_policy(options.file);
  if (!loaded) return loaded;
  rl::TrainingOptions base;
  base.task = loaded->task;
  const Result<rl::TrainingOptions> chosen = with_task(options.task, std::move(base));
  if (!chosen) return fail(chosen.error());
  loaded->task = chosen->task;
  return loaded;
}

Result<int> run(const Options& options) {
  constexpr std::uint64_t kMaxEpisodes = 100000;
  if (options.file.empty()) return fail(Errc::usage, text(msg::train_which_policy));
  const Result<std::uint64_t> episodes = parse_whole("--episodes", options.episodes);
  if (!episodes) return fail(episodes.error());
  if (*episodes == 0 || *episodes > kMaxEpisodes) {
    return fail(Errc::usage, text(msg::train_bad_episodes, kMaxEpisodes));
  }
  const Result<double> least = parse_quantity(options.least_success, Quantity::number);
  if (!least || !(*least >= 0 && *least <= 1)) {
    return fail(Errc::usage, text(msg::train_bad_least, options.least_success));
  }
  const Result<rl::TrainedPolicy> loaded = load(options);
  if (!loaded) return fail(loaded.error());
  PolicyTrial trial{.name = std::filesystem::path(options.file).stem().string(),
                    .episodes = static_cast<int>(*episodes),
                    .least_success = *least};
  if (!options.task.seed.empty()) {
    const Result<std::uint64_t> seed = parse_whole("--seed", options.task.seed);
    if (!seed) return fail(seed.error());
    trial.seed = *seed;
  }
  session::StageOptions chosen;
  chosen.out = options.out.empty() ? std::filesystem::path("mjarm-out") / "eval"
                                   : std::filesystem::path(options.out);
  const Result<RunPages> pages = read_run_pages(options.pages, false);
  if (!pages) return fail(pages.error());
  chosen.headless = !options.view && !pages->page;
  chosen.record = pages->record;
  chosen.video = options.video;
  chosen.timing = !options.no_timing;
  chosen.replace = options.replace;
  catch_interrupts();
  const Result<PolicyOutcome> outcome = beside_what_shows(
      *pages, chosen.headless, [&] { return run_policy(*loaded, trial, chosen); });
  if (!outcome) return fail(outcome.error());
  std::printf("%s", evaluation_table(outcome->evaluation).c_str());
  return conclude(outcome->report, chosen.out);
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_option(app, "policy", options->file, msg::train_option_policy, "POLICY");
  add_option(app, "--task", options->task.task, msg::train_option_task, "reach");
  add_task_options(app, options->task);
  add_option(app, "--episodes", options->episodes, msg::train_option_episodes, "N");
  add_option(app, "--least-success", options->least_success, msg::train_option_least, "SHARE");
  add_flag(app, "--view", options->view, msg::train_option_view);
  add_flag(app, "--video", options->video, msg::demo_option_video);
  add_run_page_options(app, options->pages);
  add_option(app, "--out", options->out, msg::demo_option_out, "DIR");
  add_overwrite_option(app, options->replace);
  add_flag(app, "--no-timing", options->no_timing, msg::demo_option_no_timing);
  return [options] { return run(*options); };
}

}  // namespace

Command eval_command() {
  return {"eval", msg::train_eval_summary, msg::train_eval_examples, setup};
}

}  // namespace mjarm::app
