#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "apps/mjarm/batch.hpp"
#include "apps/mjarm/command.hpp"
#include "apps/mjarm/robot.hpp"
#include "apps/mjarm/time_cases.hpp"
#include "apps/mjarm/usage.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/app.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/core/units.hpp"

namespace mjarm::app {
namespace {

constexpr double kMostSamples = 1e7;       // of one motion
constexpr double kRounding = 1e-6;         // a limit may be passed by this share of it
constexpr std::size_t kLargest = 1 << 28;  // [bytes] of a file

struct Options {
  RobotOptions robot{.robot = "ur5e", .tip = {}};
  BatchOptions batch;
  std::string problem, points, dt;
  bool check = false, no_timing = false;
};

/// What stays the same for all cases.
struct Job {
  TimeProblem problem;
  JointLimits limits;
  double dt = 0;  ///< [s] between samples; 0 = none
  bool check, timing;
};

void append_sample(std::string& out, const Trajectory& motion, double t) {
  const JointState x = motion.at(t);
  out += '[';
  append_number(out, t);
  for (const JointVec* values : {&x.q, &x.v, &x.a}) {
    out += ',';
    append_numbers(out, view(*values));
  }
  out += ']';
}

/// Appends samples every `dt` and at the end.
Result<void> append_samples(std::string& out, const Trajectory& motion, double dt) {
  const double duration = motion.duration();
  if (duration / dt > kMostSamples) {
    return fail(Errc::impossible, text(msg::app_time_too_many, duration, dt));
  }
  out += ",\"samples\":[";
  for (long i = 0; static_cast<double>(i) * dt < duration; ++i) {
    append_sample(out, motion, static_cast<double>(i) * dt);
    out += ',';
  }
  append_sample(out, motion, duration);
  out += ']';
  return {};
}

/// Appends the worst use of each limit; returns what is beyond one.
std::optional<std::string> append_check(std::string& out, const Trajectory& motion,
                                        const Job& job) {
  constexpr int kSamples = 20'000;
  const double dt = std::max(motion.duration() / kSamples, 1e-12);
  const LimitUse use = check_limits(motion, job.limits, dt);
  std::optional<std::string> broken;
  out += ",\"use\":{";
  const auto add = [&](const char* name, const JointVec& shares) {
    const double worst = shares.maxCoeff();
    if (out.back() != '{') out += ',';
    out += '"' + std::string(name) + "\":" + number(worst);
    if (worst > 1 + kRounding && !broken) broken = text(msg::app_time_limit_broken, name, worst);
  };
  add("velocity", use.velocity);
  add("acceleration", use.acceleration);
  if (job.problem != TimeProblem::path_va) add("jerk", use.jerk);
  out += '}';
  return broken;
}

/// Appends the answer to one case; returns why there is none, or what is wrong with it.
std::optional<std::string> answer(const Job& job, const TimeCase& entry, std::string& out) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const Result<Trajectory> motion = time_case(entry, job.limits, job.problem);
  const double us = std::chrono::duration<double, std::micro>(Clock::now() - start).count();
  std::optional<std::string> why;
  std::string body;
  if (motion) {
    body = ",\"duration\":" + number(motion->duration());
    if (job.check) why = append_check(body, *motion, job);
    if (job.dt > 0) {
      if (Result<void> done = append_samples(body, *motion, job.dt); !done) {
        why = done.error().what;
      }
    }
  } else {
    why = motion.error().what;
  }
  out += why ? "{\"ok\":false,\"reason\":" : "{\"ok\":true";
  if (why) append_json_string(out, *why);
  out += body;
  if (job.timing) out += ",\"us\":" + number(std::round(us * 10) / 10);
  out += '}';
  return why;
}

Result<int> answer_one(const Job& job, const TimeCase& entry, const std::string& out) {
  std::string line;
  const std::optional<std::string> why = answer(job, entry, line);
  if (Result<void> written = write_answer(out, line); !written) {
    return fail(std::move(written.error()));
  }
  if (!why) return 0;
  log_error(text(msg::app_time_no_answer, *why));
  return 1;
}

Result<int> answer_all(Job job, const Options& options) {
  const Result<std::string> content = read_file(options.batch.in, kLargest);
  if (!content) return fail(content.error());
  Result<TimeCases> cases = read_time_cases(*content, job.problem);
  if (!cases) return fail(cases.error().code, options.batch.in + ": " + cases.error().what);
  job.limits = std::move(cases->limits);
  Progress progress(text(msg::app_time_progress), cases->cases.size());
  std::string out = "{", first;
  std::size_t failed = 0;
  for (const TimeCase& entry : cases->cases) {
    if (interrupted()) return fail(Errc::system, text(msg::app_interrupted));
    if (out.size() > 1) out += ",\n ";
    append_json_string(out, entry.id);
    out += ':';
    const std::optional<std::string> why = answer(job, entry, out);
    if (why && failed++ == 0) first = text(msg::app_time_case_failed, entry.id, *why);
    progress.advance();
  }
  out += '}';
  if (Result<void> written = write_answer(options.batch.out, out); !written) {
    return fail(std::move(written.error()));
  }
  if (failed == 0) return 0;
  log_error(text(msg::app_time_some_failed, options.batch.in, first, failed, cases->cases.size()));
  return 1;
}

/// Waypoints of the command line: `q1,q2,...;q1,q2,...`.
Result<TimeCase> read_points(const Options& options, TimeProblem problem, const Arm& arm) {
  TimeCase entry;
  for (std::size_t from = 0; from <= options.points.size();) {
    const std::size_t to = std::min(options.points.find(';', from), options.points.size());
    const auto q = parse_joints("--points", options.points.substr(from, to - from), arm);
    if (!q) return fail(q.error());
    entry.waypoints.push_back(joint_vec(*q));
    from = to + 1;
  }
  if (problem != TimeProblem::p2p) return entry;
  if (entry.waypoints.size() != 2) {
    return fail(Errc::usage, text(msg::app_time_two_points, entry.waypoints.size()));
  }
  const JointVec zero = JointVec::Zero(arm.dof());
  entry.start = {entry.waypoints[0], zero, zero};
  entry.end = {entry.waypoints[1], zero, zero};
  return entry;
}

Result<int> run(const Options& options) {
  if (Result<void> fine = one_source(options.batch.in, options.points, "--points"); !fine) {
    return fail(std::move(fine.error()));
  }
  const Result<TimeProblem> problem = parse_time_problem(options.problem);
  if (!problem) return fail(problem.error());
  Job job{*problem, {}, 0, options.check, !options.no_timing};
  if (!options.dt.empty()) {
    const Result<double> dt = parse_quantity(options.dt, Quantity::time);
    if (!dt) return fail(in_option("--dt", dt.error()));
    if (!(*dt > 0)) return fail(Errc::usage, text(msg::app_time_bad_dt, options.dt));
    job.dt = *dt;
  }
  if (!options.batch.in.empty()) return answer_all(std::move(job), options);
  const Result<Robot> robot = load_robot(options.robot);
  if (!robot) return fail(robot.error());
  job.limits = robot->arm.limits;
  const Result<TimeCase> entry = read_points(options, *problem, robot->arm);
  if (!entry) return fail(entry.error());
  return answer_one(job, *entry, options.batch.out);
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("--problem", options->problem, text(msg::app_time_option_problem))
      ->type_name("NAME");
  app.add_option("--in", options->batch.in, text(msg::app_time_option_in))->type_name("FILE");
  app.add_option("--out", options->batch.out, text(msg::app_option_out))->type_name("FILE");
  app.add_option("--points", options->points, text(msg::app_time_option_points))
      ->type_name("Q1,Q2,...;...");
  add_robot_options(app, options->robot);
  app.add_option("--dt", options->dt, text(msg::app_time_option_dt))->type_name("S");
  app.add_flag("--check", options->check, text(msg::app_time_option_check));
  app.add_flag("--no-timing", options->no_timing, text(msg::app_option_no_timing));
  return [options] { return run(*options); };
}

}  // namespace

Command time_command() { return {"time", msg::app_time_summary, msg::app_time_examples, setup}; }

}  // namespace mjarm::app
