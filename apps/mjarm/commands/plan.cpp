#include "apps/mjarm/messages/plan.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/mjarm/cli/batch.hpp"
#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/commands/plan_progress.hpp"
#include "apps/mjarm/commands/plan_robot.hpp"
#include "apps/mjarm/commands/plan_show.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/plan_show.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/planning.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/core/threads.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/planning/ompl_planners.hpp"
#include "mjarm/planning/plan_answer.hpp"

namespace mjarm::app {
namespace {

constexpr int kMaxSamples = 10'000'000;
constexpr double kMaxSeconds = 3600;

struct Options {
  BatchOptions batch;
  std::string planner = "rrtc", seed = "1", threads, samples, budget, limit, problem, clearance;
  RobotRequest request;
  bool no_timing = false;
  PlanShowArguments show;
};

/// `rrtc`, `rrtstar`, `ompl` or `ompl:NAME`.
Result<void> choose_planner(const std::string& word, PlanOptions& out) {
  static const std::vector<Planner> kKinds{Planner::rrt_connect, Planner::rrt_star, Planner::ompl};
  std::vector<std::string> words{"rrtc", "rrtstar", "ompl"};
  for (const std::string& name : ompl_planner_names()) words.push_back("ompl:" + name);
  const Result<std::size_t> chosen = parse_choice("--planner", word, words);
  if (!chosen) return fail(chosen.error());
  out.planner = kKinds[std::min(*chosen, kKinds.size() - 1)];
  if (*chosen >= kKinds.size()) out.ompl_planner = ompl_planner_names()[*chosen - kKinds.size()];
  if (out.planner == Planner::ompl && ompl_version().empty()) {
    return fail(Errc::not_available, text(msg::planning_no_ompl));
  }
  return {};
}

Result<PlanOptions> read_options(const Options& options) {
  PlanOptions out;
  if (Result<void> chosen = choose_planner(options.planner, out); !chosen) {
    return fail(std::move(chosen.error()));
  }
  const Result<std::uint64_t> seed = parse_whole("--seed", options.seed);
  if (!seed) return fail(seed.error());
  out.seed = *seed;
  if (!options.samples.empty()) {
    const Result<int> samples = parse_count("--samples", options.samples, kMaxSamples);
    if (!samples) return fail(samples.error());
    out.samples = *samples;
  }
  if (!options.budget.empty()) {
    const Result<double> budget = parse_quantity(options.budget, Quantity::time);
    if (!budget) return fail(in_option("--time-budget", budget.error()));
    if (!(*budget > 0 && *budget <= kMaxSeconds)) {
      return fail(Errc::usage, text(msg::plan_bad_budget, options.budget));
    }
    out.time_budget = *budget;
  }
  if (!options.limit.empty()) {
    const Result<double> limit = parse_quantity(options.limit, Quantity::time);
    if (!limit) return fail(in_option("--time-limit", limit.error()));
    if (!(*limit >= 0 && *limit <= kMaxSeconds)) {
      return fail(Errc::usage, text(msg::plan_bad_limit, options.limit, kMaxSeconds));
    }
    out.time_limit = *limit;
  }
  if (!options.clearance.empty()) {
    const Result<double> clearance = parse_quantity(options.clearance, Quantity::length);
    if (!clearance) return fail(in_option("--clearance", clearance.error()));
    if (!(*clearance >= 0 && *clearance <= kMaxClearanceAsked)) {
      return fail(Errc::usage,
                  text(msg::plan_bad_clearance, options.clearance, kMaxClearanceAsked));
    }
    out.clearance = *clearance;
  }
  return out;
}

/// Leaves only the problem that was asked for.
Result<void> select(const Options& options, ProblemFile& file) {
  if (options.problem.empty()) return {};
  std::vector<std::string> ids;
  for (PlanProblem& problem : file.problems) {
    if (problem.id == options.problem) {
      PlanProblem only = std::move(problem);
      file.problems.clear();
      file.problems.push_back(std::move(only));
      return {};
    }
    ids.push_back(problem.id);
  }
  return fail(Errc::bad_input, text(msg::plan_unknown_problem, options.batch.in, options.problem,
                                    did_you_mean(options.problem, ids)));
}

/// @param show  how the only problem is shown, after its answer is written.
Result<int> answer_all(const ProblemFile& file, const FastRobot& robot, const PlanOptions& plan,
                       int threads, const Options& options, AnswerOutput& output,
                       const std::optional<session::PlanShow>& show) {
  const std::size_t count = file.problems.size();
  std::vector<PlanAnswer> answers(count);
  PlanOptions told = plan;
  std::optional<PlanProgress> search;
  if (count == 1) search.emplace(told);
  Progress progress(text(msg::plan_progress), count);
  std::atomic<std::size_t> next = 0;
  run_in_threads(std::min(threads, static_cast<int>(std::max<std::size_t>(count, 1))), [&](int) {
    for (std::size_t i = next++; i < count && !interrupted(); i = next++) {
      answers[i] = answer_problem(robot, file.problems[i], told);
      progress.advance();
    }
  });
  search.reset();
  if (interrupted()) return fail(Errc::system, text(msg::app_interrupted));
  std::string out = "{";
  std::size_t failed = 0;
  std::string first_id, first_why;
  for (std::size_t i = 0; i < count; ++i) {
    JsonWriter(out).line_break().key(file.problems[i].id);
    append_answer(out, answers[i], robot, file.problems[i].obstacles, !options.no_timing);
    if (!answers[i].path && failed++ == 0) {
      first_id = file.problems[i].id;
      first_why = describe(answers[i].path.error(), robot, file.problems[i].obstacles);
    }
  }
  out += '}';
  if (Result<void> written = write_answer(output, out); !written) {
    return fail(std::move(written.error()));
  }
  if (failed == 0 && show) {
    const auto shown =
        session::show_plan_of_spheres(*show, robot, file.problems[0], *answers[0].path);
    if (!shown) return fail(shown.error());
  }
  if (failed == 0) return 0;
  log_error(text(msg::plan_some_failed, options.batch.in, first_id, first_why, failed, count));
  return 1;
}

Result<int> run(const Options& options) {
  if (options.batch.in.empty() != is_given(options.request)) {
    return fail(Errc::usage, text(msg::app_need_one_of, "--in", "--robot"));
  }
  Result<PlanOptions> plan = read_options(options);
  if (!plan) return fail(plan.error());
  const Result<std::optional<session::PlanShow>> show = read_plan_show(options.show);
  if (!show) return fail(show.error());
  // Where its answer cannot go is said before a search of minutes.
  Result<AnswerOutput> output = AnswerOutput::open(options.batch.out, options.batch.replace);
  if (!output) return fail(std::move(output.error()));
  plan->keep_trees = show->has_value();
  plan->stop = interrupted;
  if (is_given(options.request)) {
    for (const auto& [name, value] :
         {std::pair{"--problem", &options.problem}, {"--threads", &options.threads}}) {
      if (value->empty()) continue;
      return fail(Errc::usage, text(msg::app_exclusive_options, "--robot", name));
    }
    return plan_for_robot(options.request, *plan, *show, *output, !options.no_timing);
  }
  const Result<int> threads = parse_threads(options.threads.empty() ? "1" : options.threads);
  if (!threads) return fail(threads.error());
  Result<ProblemFile> file = read_problem_file(options.batch.in);
  if (!file) return fail(std::move(file.error()));
  if (Result<void> found = select(options, *file); !found) return fail(std::move(found.error()));
  if (*show && file->problems.size() != 1) {
    const std::string first = file->problems.empty() ? "" : file->problems.front().id;
    return fail(Errc::usage,
                text(msg::plan_show_one, options.batch.in, file->problems.size(), first));
  }
  const Result<FastRobot> robot = FastRobot::create(file->arm, file->spheres);
  if (!robot)
    return fail(robot.error().code, text(msg::core_at_place, options.batch.in, robot.error().what));
  return answer_all(*file, *robot, *plan, *threads, options, *output, *show);
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_option(app, "--in", options->batch.in, msg::plan_option_in, "FILE");
  add_option(app, "--out", options->batch.out, msg::app_option_out, "FILE");
  add_overwrite_option(app, options->batch.replace);
  add_robot_request(app, options->request);
  add_option(app, "--problem", options->problem, msg::plan_option_problem, "ID");
  add_option(app, "--clearance", options->clearance, msg::plan_option_clearance, "M");
  add_option(app, "--planner", options->planner, msg::plan_option_planner, "NAME");
  add_option(app, "--time-budget", options->budget, msg::plan_option_budget, "S");
  add_option(app, "--time-limit", options->limit, msg::plan_option_limit, "S");
  add_option(app, "--samples", options->samples, msg::plan_option_samples, "N");
  add_option(app, "--seed", options->seed, msg::plan_option_seed, "N");
  add_option(app, "--threads", options->threads, msg::plan_option_threads, "N");
  add_flag(app, "--no-timing", options->no_timing, msg::app_option_no_timing);
  add_plan_show_options(app, options->show);
  return [options] { return run(*options); };
}

}  // namespace

Command plan_command() { return {"plan", msg::plan_summary, msg::plan_examples, setup}; }

}  // namespace mjarm::app
