#include "apps/mjarm/messages/train.hpp"

#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <system_error>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/commands/page_options.hpp"
#include "apps/mjarm/commands/policy_run.hpp"
#include "apps/mjarm/commands/processes.hpp"
#include "apps/mjarm/commands/run_output.hpp"
#include "apps/mjarm/commands/train_curve.hpp"
#include "apps/mjarm/commands/train_outcome.hpp"
#include "apps/mjarm/commands/train_page.hpp"
#include "apps/mjarm/commands/train_task.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/rl.hpp"
#include "mjarm/core/messages/serve.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/output_folder.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/rl/reach_env.hpp"
#include "mjarm/rl/training.hpp"
#include "mjarm/rl/training_config.hpp"

namespace mjarm::app {
namespace {

struct Options {
  TaskArguments task;
  std::string config, resume, out, steps, seeds = "1";
  Replace replace;
  bool print_config = false, no_timing = false, video = false, serve = false;
  std::string port;
};

void add_fact(JsonDoc& doc, const Fact& fact) {
  if (const auto* number = std::get_if<double>(&fact.value)) {
    doc.set(fact.name.c_str(), *number);
  } else if (const auto* word = std::get_if<std::string>(&fact.value)) {
    doc.set(fact.name.c_str(), *word);
  } else {
    JsonDoc group;
    for (const auto& [name, value] : std::get<2>(fact.value)) group.set(name.c_str(), value);
    doc.set(fact.name.c_str(), std::move(group));
  }
}

void tell(const rl::TrainingStep& step, double seconds) {
  if (!step.evaluation) return;
  log_info(text(msg::train_evaluated, step.iteration.steps, seconds, in_words(*step.evaluation)));
}

/// At its first step, or where the checkpoint left off; `folder` is made.
Result<rl::Training> begin(const Model& model, const rl::TrainingOptions& options,
                           const std::filesystem::path& folder,
                           const std::filesystem::path& checkpoint, Ranks* ranks) {
  Result<rl::Training> training = rl::Training::create(model, options, folder, ranks);
  if (!training || checkpoint.empty()) return training;
  if (auto resumed = training->resume(checkpoint); !resumed) return fail(resumed.error());
  log_info(text(msg::train_resumed, training->trainer().steps()));
  return training;
}

Result<TrainedSeed> train(const Model& model, const rl::TrainingOptions& options,
                          const std::filesystem::path& folder,
                          const std::filesystem::path& checkpoint, Ranks* ranks) {
  Result<rl::Training> training = begin(model, options, folder, checkpoint, ranks);
  const bool begun = training.has_value();
  if (on_any_rank(ranks, !begun) && begun) return fail(Errc::impossible, text(msg::rl_failed_rank));
  if (!begun) return fail(std::move(training.error()));
  TrainedSeed trained{options};
  Progress progress(text(msg::train_progress), static_cast<std::uint64_t>(options.ppo.total_steps));
  progress.advance(static_cast<std::uint64_t>(training->trainer().steps()));
  while (!training->done() && !(trained.interrupted = on_any_rank(ranks, interrupted()))) {
    const std::int64_t before = training->trainer().steps();
    const Result<rl::TrainingStep> step = training->advance();
    if (!step) return fail(step.error());
    trained.advanced = true;
    trained.seconds += 1e-6 * (step->iteration.collect_us + step->iteration.update_us);
    progress.advance(static_cast<std::uint64_t>(step->iteration.steps - before));
    tell(*step, trained.seconds);
  }
  trained.steps = training->trainer().steps();
  trained.best = training->best_evaluation();
  return trained;
}

Result<void> write_report(const std::filesystem::path& folder, const TrainedSeed& trained,
                          bool timing) {
  JsonDoc doc{{"name", "train reach"},
              {"ok", rl::is_good_enough(trained.options, trained.best) && !trained.interrupted},
              {"steps", static_cast<double>(trained.steps)},
              {"seed", static_cast<double>(trained.options.ppo.seed)}};
  if (trained.best) {
    for (const Fact& fact : facts_of(*trained.best)) add_fact(doc, fact);
  }
  if (timing) doc.set("us", 1e6 * trained.seconds);
  return write_file(folder / "report.json", doc.document()).and_then([&] {
    // One that was over when it was resumed has made no progress to be drawn.
    return trained.advanced ? draw_curve(folder) : Result<void>();
  });
}

/// Shows what was learned, as `mjarm eval --video` does.
Result<void> film_best(const std::filesystem::path& folder, bool timing) {
  const Result<rl::TrainedPolicy> best = rl::load_policy(folder / rl::Training::kBest);
  if (!best) return fail(best.error());
  session::StageOptions options;
  options.out = folder / "result";
  options.headless = options.video = true;
  options.timing = timing;
  options.replace.overwrite = true;  // as the training itself
  const Result<PolicyOutcome> outcome = run_policy(*best, {.name = "reach"}, options);
  if (!outcome) return fail(outcome.error());
  return {};
}

/// Where all files go: what goes on stays where it is, unless told otherwise.
std::filesystem::path folder_of(const Options& options) {
  if (!options.out.empty()) return options.out;
  if (options.resume.empty()) return std::filesystem::path("mjarm-out") / "train-reach";
  const std::filesystem::path folder = std::filesystem::path(options.resume).parent_path();
  return folder.empty() ? "." : folder;
}

std::filesystem::path folder_of(const Options& options, std::uint64_t seeds, std::uint64_t seed) {
  const std::filesystem::path out = folder_of(options);
  return seeds > 1 ? out / ("seed-" + std::to_string(seed)) : out;
}

/// Whether what lies in the folder is to be replaced: as it is asked for, or as it goes on there.
Replace replacing(const Options& options, const std::filesystem::path& folder) {
  std::error_code code;
  const std::filesystem::path from = std::filesystem::path(options.resume).parent_path();
  const bool goes_on = !options.resume.empty() &&
                       std::filesystem::equivalent(from.empty() ? "." : from, folder, code);
  return {.overwrite = options.replace.overwrite || goes_on};
}

/// What a training learned is not replaced unless that is asked for.
Result<void> check_overwriting(const Options& options, const std::filesystem::path& folder) {
  std::error_code code;
  if (replacing(options, folder).overwrite) return {};
  for (const char* const name : {rl::Training::kBest, rl::Training::kLast}) {
    if (!std::filesystem::exists(folder / name, code)) continue;
    return fail(Errc::usage, text(msg::train_would_overwrite, (folder / name).string(),
                                  (folder / rl::Training::kLast).string()));
  }
  return {};
}

Result<int> train_seeds(const Options& options, const Model& model,
                        const rl::TrainingOptions& wanted, std::uint64_t seeds) {
  Result<std::unique_ptr<Ranks>> ranks = join_processes();
  if (!ranks) return fail(std::move(ranks.error()));
  const bool first = *ranks == nullptr || (*ranks)->rank() == 0;
  std::vector<TrainedSeed> runs;
  std::unique_ptr<TrainPage> page;
  if (first && options.serve) {
    Result<std::unique_ptr<TrainPage>> opened = TrainPage::open(model, wanted.task);
    if (!opened) return fail(std::move(opened.error()));
    page = std::move(*opened);
  }
  for (std::uint64_t i = 0; first && i < seeds; ++i) {
    const auto folder = folder_of(options, seeds, wanted.ppo.seed + i);
    if (auto fine = check_overwriting(options, folder); !fine) return fail(std::move(fine.error()));
  }
  for (std::uint64_t i = 0; i < seeds && (runs.empty() || !runs.back().interrupted); ++i) {
    rl::TrainingOptions chosen = wanted;
    chosen.ppo.seed += i;
    const std::filesystem::path folder = folder_of(options, seeds, chosen.ppo.seed);
    std::optional<Result<OutputFolder>> held;  // by the first of several processes, for all
    if (first) held = OutputFolder::open(folder, replacing(options, folder));
    if (held && !*held) return fail(std::move(held->error()));
    if (page) page->follow(folder);
    Result<TrainedSeed> trained = train(model, chosen, folder, options.resume, ranks->get());
    if (!trained) return fail(std::move(trained.error()));
    if (first) {
      if (auto written = write_report(folder, *trained, !options.no_timing); !written) {
        return fail(std::move(written.error()));
      }
      if (options.video && trained->best && !trained->interrupted) {
        if (auto filmed = film_best(folder, !options.no_timing); !filmed) {
          return fail(std::move(filmed.error()));
        }
      }
    }
    if (held) (*held)->made();
    runs.push_back(std::move(*trained));
  }
  if (!first) return 0;
  std::printf("%s%s\n", seeds_table(runs).c_str(),
              text(msg::train_folder, folder_of(options).string()).c_str());
  if (runs.back().interrupted)
    return fail(Errc::impossible,
                text(msg::train_interrupted, (folder_of(options) / rl::Training::kLast).string()));
  for (const TrainedSeed& run : runs) {
    if (!rl::is_good_enough(run.options, run.best)) {
      return fail(Errc::impossible, text(msg::train_not_reached, 100 * run.options.stop_share,
                                         1e3 * run.options.stop_within, run.steps));
    }
  }
  return 0;
}

/// From the defaults, a file or a checkpoint, and then the options of the command line.
Result<rl::TrainingOptions> wanted(const Options& options) {
  // A word that is no region is told of by with_task().
  Result<rl::TrainingOptions> base =
      rl::reach_training(rl::reach_region(options.task.region).value_or(rl::ReachRegion::tutorial));
  if (!options.config.empty() && !options.resume.empty()) {
    return fail(Errc::usage, text(msg::train_config_and_resume));
  }
  if (!options.config.empty()) base = rl::load_config(options.config);
  if (!options.resume.empty()) base = rl::config_of_checkpoint(options.resume);
  if (!base) return base;
  Result<rl::TrainingOptions> chosen = with_task(options.task, std::move(*base));
  if (!chosen || options.steps.empty()) return chosen;
  const Result<std::uint64_t> steps = parse_whole("--steps", options.steps);
  if (!steps) return fail(steps.error());
  chosen->ppo.total_steps = static_cast<std::int64_t>(*steps);
  return chosen;
}

Result<int> run(const Options& options) {
  const Result<rl::TrainingOptions> chosen = wanted(options);
  if (!chosen) return fail(chosen.error());
  if (options.print_config) {
    std::printf("%s", rl::config_text(*chosen).c_str());
    return 0;
  }
  const Result<std::uint64_t> seeds = parse_whole("--seeds", options.seeds);
  if (!seeds) return fail(seeds.error());
  if (*seeds == 0 || (*seeds > 1 && !options.resume.empty())) {
    return fail(Errc::usage, text(msg::train_bad_seeds));
  }
  const Result<Model> model = rl::reach_model(chosen->task);
  if (!model) return fail(model.error());
  const Result<RunPages> pages =
      read_run_pages({.serve = options.serve, .port = options.port, .html = {}}, false, false);
  if (!pages) return fail(pages.error());
  catch_interrupts();
  return beside_what_shows(*pages, true,
                           [&] { return train_seeds(options, *model, *chosen, *seeds); });
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_task_argument(app, options->task);
  add_task_options(app, options->task);
  add_option(app, "--config", options->config, msg::train_option_config, "FILE");
  add_option(app, "--resume", options->resume, msg::train_option_resume, "CHECKPOINT");
  add_option(app, "--out", options->out, msg::train_option_out, "DIR");
  add_option(app, "--steps", options->steps, msg::train_option_steps, "N");
  add_option(app, "--seeds", options->seeds, msg::train_option_seeds, "N");
  add_flag(app, "--overwrite", options->replace.overwrite, msg::train_option_overwrite);
  add_flag(app, "--video", options->video, msg::train_option_video);
  add_flag(app, "--serve", options->serve, msg::train_option_serve);
  add_option(app, "--port", options->port, msg::serve_option_port, "PORT");
  add_flag(app, "--print-config", options->print_config, msg::train_option_print_config);
  add_flag(app, "--no-timing", options->no_timing, msg::train_option_no_timing);
  return [options] { return run(*options); };
}

}  // namespace

Command train_command() { return {"train", msg::train_summary, msg::train_examples, setup}; }

}  // namespace mjarm::app
