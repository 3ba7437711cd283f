#include "apps/mjarm/messages/verify.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/cli/table.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/commands/rule_options.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/core/threads.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/core/user_cache.hpp"
#include "mjarm/core/utf8.hpp"
#include "mjarm/planning/verify_path.hpp"

namespace mjarm::app {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Options {
  RobotChoice robot{.looks = false};
  RuleWords rules;
  std::string paths, in, step = "0.005", tol = "0", cylinders = "replaced", threads = "1";
  bool json = false;
};

/// A problem and the path that is given for it.
struct Job {
  std::string id{}, scene{};
  std::shared_ptr<const ProblemFile> file{};  ///< null: the way of a robot
  const PlanProblem* problem = nullptr;
  GivenPath given{};
  ContactRules contact = {};  ///< of a robot
  Result<PathVerdict> verdict = PathVerdict{};

  [[nodiscard]] bool is_given() const { return !given.rows.empty(); }
  [[nodiscard]] bool is_valid() const { return is_given() && verdict && verdict->faults.empty(); }
};

/// What is counted of a scene.
struct SceneRow {
  std::string name;
  std::size_t problems = 0, given = 0, valid = 0;
  double clearance = kInfinite;  // [m] the least of all paths

  void add(const Job& job) {
    ++problems;
    given += job.is_given();
    valid += job.is_valid();
    if (job.is_given()) clearance = std::min(clearance, job.verdict->clearance);
  }
};

Result<VerifyRules> read_rules(const Options& options) {
  const Result<double> step = parse_quantity(options.step, Quantity::angle);
  if (!step) return fail(in_option("--step", step.error()));
  if (!(*step >= kLeastVerifyStep)) {
    return fail(Errc::usage, text(msg::verify_bad_step, options.step, kLeastVerifyStep));
  }
  const Result<double> tol = parse_quantity(options.tol, Quantity::length);
  if (!tol) return fail(in_option("--tol", tol.error()));
  if (!(*tol >= 0)) return fail(Errc::usage, text(msg::verify_bad_tol, options.tol));
  return VerifyRules{*step, *tol, interrupted};
}

Result<Cylinders> read_cylinders(const Options& options) {
  static const std::vector<std::string> kWords{"replaced", "as-given"};
  const Result<std::size_t> word = parse_choice("--cylinders", options.cylinders, kWords);
  if (!word) return fail(word.error());
  return *word == 0 ? Cylinders::replaced : Cylinders::exact;
}

/// The problems that count, in the order of their file: those that the file calls valid, and any
/// other for which there is a path.
Result<std::vector<Job>> match(const std::shared_ptr<const ProblemFile>& file,
                               std::vector<GivenPath> paths, const Options& options) {
  std::map<std::string, GivenPath*> by_id;
  for (GivenPath& path : paths) by_id[path.id] = &path;
  std::vector<Job> jobs;
  std::vector<std::string> ids;
  for (const PlanProblem& problem : file->problems) {
    ids.push_back(problem.id);
    Job job{.id = problem.id, .scene = problem.scene, .file = file, .problem = &problem};
    const auto found = by_id.find(problem.id);
    if (found != by_id.end()) {
      job.given = std::move(*found->second);
      by_id.erase(found);
    }
    if (problem.valid || job.is_given()) jobs.push_back(std::move(job));
  }
  if (by_id.empty()) return jobs;
  const std::string& id = by_id.begin()->first;
  return fail(Errc::bad_input,
              text(msg::verify_unknown_id, options.paths, id, options.in, did_you_mean(id, ids)));
}

Result<std::vector<Job>> file_jobs(const Options& options, Cylinders cylinders) {
  Result<ProblemFile> file = read_problem_file(options.in, cylinders);
  if (!file) return fail(std::move(file.error()));
  Result<std::vector<GivenPath>> paths =
      read_plan_file(options.paths, static_cast<std::size_t>(file->arm.dof()));
  if (!paths) return fail(std::move(paths.error()));
  return match(std::make_shared<const ProblemFile>(std::move(*file)), std::move(*paths), options);
}

/// The way of a robot from the first to the last row of a path.
Result<Job> robot_job(const Options& options, const Robot& robot, GivenPath path) {
  const std::vector<double> none(robot.arm.home.begin(), robot.arm.home.end());
  const std::vector<double>& start = path.rows.empty() ? none : path.rows.front();
  RuleWords words = options.rules;
  words.hold.insert(words.hold.end(), path.rules.hold.begin(), path.rules.hold.end());
  words.allow.insert(words.allow.end(), path.rules.allow.begin(), path.rules.allow.end());
  Result<ContactRules> rules = rules_of(words, robot, start);
  if (!rules) return fail(std::move(rules.error()));
  return Job{.id = path.id, .given = std::move(path), .contact = std::move(*rules)};
}

Result<std::vector<Job>> robot_jobs(const Options& options, const Robot& robot) {
  Result<std::vector<GivenPath>> paths =
      read_plan_file(options.paths, static_cast<std::size_t>(robot.arm.dof()));
  if (!paths) return fail(std::move(paths.error()));
  std::vector<Job> jobs;
  for (GivenPath& path : *paths) {
    if (interrupted()) return fail(Errc::system, text(msg::app_interrupted));
    Result<Job> job = robot_job(options, robot, std::move(path));
    if (!job) return fail(std::move(job.error()));
    jobs.push_back(std::move(*job));
  }
  return jobs;
}

/// @param robot  null: the jobs are of problems.
Result<void> judge_all(std::vector<Job>& jobs, const Robot* robot, const VerifyRules& rules,
                       int threads) {
  Progress progress(text(msg::verify_progress), jobs.size());
  std::atomic<std::size_t> next = 0;
  run_in_threads(threads, [&](int) {
    for (std::size_t i = next++; i < jobs.size() && !interrupted(); i = next++) {
      Job& job = jobs[i];
      if (job.is_given()) {
        job.verdict = robot != nullptr ? verify_path(*robot, job.contact, job.given, rules)
                                       : verify_path(*job.file, *job.problem, job.given, rules);
      }
      progress.advance();
    }
  });
  if (interrupted()) return fail(Errc::system, text(msg::app_interrupted));
  for (Job& job : jobs) {
    if (job.verdict) continue;
    // What cannot even be looked at is a fault of this path; the others are judged all the same.
    PathVerdict absurd;
    absurd.faults.push_back({"absurd", -1, job.verdict.error().what});
    job.verdict = std::move(absurd);
  }
  return {};
}

/// A row a scene, and one for all.
std::vector<SceneRow> count_scenes(const std::vector<Job>& jobs) {
  std::vector<SceneRow> rows;
  SceneRow all{text(msg::verify_all)};
  for (const Job& job : jobs) {
    const std::string& scene = job.scene;
    auto row = std::find_if(rows.begin(), rows.end(),
                            [&](const SceneRow& known) { return known.name == scene; });
    if (row == rows.end()) row = rows.insert(rows.end(), SceneRow{scene});
    row->add(job);
    all.add(job);
  }
  rows.push_back(all);
  return rows;
}

std::string report_text(const std::vector<Job>& jobs) {
  std::string out;
  for (const Job& job : jobs) {
    for (const PathFault& fault : job.verdict->faults) {
      out += printable(text(msg::core_at_place, job.id, fault.what)) + '\n';
    }
  }
  std::vector<std::vector<std::string>> table{
      {text(msg::verify_head_scene), text(msg::verify_head_problems), text(msg::verify_head_given),
       text(msg::verify_head_valid), text(msg::verify_head_clearance)}};
  for (const SceneRow& row : count_scenes(jobs)) {
    const bool is_known = std::isfinite(row.clearance);
    table.push_back({row.name.empty() ? "-" : row.name, std::to_string(row.problems),
                     std::to_string(row.given), std::to_string(row.valid),
                     is_known ? text(msg::verify_millimetres, 1e3 * row.clearance) : "-"});
  }
  return out + markdown_table(table);
}

std::string report_json(const std::vector<Job>& jobs) {
  JsonDoc paths = JsonDoc(std::initializer_list<JsonDoc::Member>{});
  for (const Job& job : jobs) {
    if (!job.is_given()) continue;
    std::vector<JsonDoc> faults;
    for (const PathFault& fault : job.verdict->faults) {
      JsonDoc entry{{"kind", fault.kind}, {"what", fault.what}};
      if (fault.edge >= 0) entry.set("edge", fault.edge);
      faults.push_back(std::move(entry));
    }
    paths.set(job.id.c_str(), JsonDoc{{"ok", job.is_valid()},
                                      {"cost", job.verdict->cost},
                                      {"clearance", job.verdict->clearance},
                                      {"faults", std::move(faults)}});
  }
  std::vector<JsonDoc> scenes;
  std::vector<SceneRow> rows = count_scenes(jobs);
  const SceneRow all = rows.back();
  rows.pop_back();
  for (const SceneRow& row : rows) {
    scenes.push_back(JsonDoc{{"scene", row.name},
                             {"problems", row.problems},
                             {"given", row.given},
                             {"valid", row.valid},
                             {"clearance", row.clearance}});
  }
  return JsonDoc{{"ok", all.given > 0 && all.valid == all.given},
                 {"problems", all.problems},
                 {"given", all.given},
                 {"valid", all.valid},
                 {"clearance", all.clearance},
                 {"scenes", std::move(scenes)},
                 {"paths", std::move(paths)}}
      .document();
}

/// One line on standard error where something is not valid.
int exit_code_of(const std::vector<Job>& jobs, const Options& options) {
  std::size_t given = 0, faulty = 0;
  const Job* first = nullptr;
  for (const Job& job : jobs) {
    given += job.is_given();
    if (!job.is_given() || job.is_valid()) continue;
    if (faulty++ == 0) first = &job;
  }
  if (given == 0) {
    const std::string& whose = options.in.empty() ? options.robot.robot : options.in;
    log_error(text(msg::verify_none, options.paths, whose));
  }
  if (first != nullptr) {
    log_error(text(msg::verify_some_faulty, options.paths, faulty, given, first->id,
                   first->verdict->faults.front().what));
  }
  return given > 0 && faulty == 0 ? 0 : 1;
}

Result<int> run(const Options& options) {
  UserCache::leave_alone();  // nothing is believed that was made before
  if (options.paths.empty()) return fail(Errc::usage, text(msg::verify_need_paths));
  if (options.in.empty() == options.robot.robot.empty()) {
    return fail(Errc::usage, text(msg::app_need_one_of, "--in", "--robot"));
  }
  if (!options.in.empty() && options.rules.any()) {
    const char* const rule = options.rules.hold.empty() ? "--allow" : "--hold";
    return fail(Errc::usage, text(msg::app_exclusive_options, "--in", rule));
  }
  const Result<VerifyRules> rules = read_rules(options);
  if (!rules) return fail(rules.error());
  const Result<Cylinders> cylinders = read_cylinders(options);
  if (!cylinders) return fail(cylinders.error());
  const Result<int> threads = parse_threads(options.threads);
  if (!threads) return fail(threads.error());
  catch_interrupts();
  std::optional<Robot> robot;
  if (options.in.empty()) {
    Result<Robot> loaded = load_robot(options.robot);
    if (!loaded) return fail(std::move(loaded.error()));
    robot = std::move(*loaded);
  }
  Result<std::vector<Job>> jobs =
      robot ? robot_jobs(options, *robot) : file_jobs(options, *cylinders);
  if (!jobs) return fail(jobs.error());
  const Result<void> done = judge_all(*jobs, robot ? &*robot : nullptr, *rules, *threads);
  if (!done) {
    return fail(done.error());
  }
  const std::string out = options.json ? report_json(*jobs) : report_text(*jobs);
  std::fputs(out.c_str(), stdout);
  return exit_code_of(*jobs, options);
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_option(app, "paths", options->paths, msg::verify_option_paths, "PATHS.json");
  add_robot_options(app, options->robot);
  add_rule_options(app, options->rules);
  add_option(app, "--in", options->in, msg::verify_option_in, "PROBLEMS.json");
  add_option(app, "--step", options->step, msg::verify_option_step, "RAD");
  add_option(app, "--tol", options->tol, msg::verify_option_tol, "M");
  add_option(app, "--cylinders", options->cylinders, msg::verify_option_cylinders, "HOW");
  add_option(app, "--threads", options->threads, msg::verify_option_threads, "N");
  add_flag(app, "--json", options->json, msg::app_option_json);
  return [options] { return run(*options); };
}

}  // namespace

Command verify_command() { return {"verify", msg::verify_summary, msg::verify_examples, setup}; }

}  // namespace mjarm::app
