#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "apps/mjarm/cli/batch.hpp"
#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/model/arm_dynamics.hpp"
#include "mjarm/trajectory/time_cases.hpp"

namespace mjarm::app {
namespace {

constexpr double kMaxNumbers = 2e7;        // in the samples of one motion, about 20 bytes each
constexpr double kRounding = 1e-6;         // a limit may be passed by this share of it
constexpr double kTorqueRounding = 1e-3;   // the same for torques
constexpr std::size_t kLargest = 1 << 28;  // [bytes] of a file

struct Options {
  RobotChoice robot{.robot = "ur5e", .looks = false};
  BatchOptions batch;
  std::string problem, points, dt, torque;
  bool check = false, no_timing = false;
};

/// What stays the same for all cases.
struct Job {
  TimeProblem problem;
  JointLimits limits;
  double dt = 0;  ///< [s] between samples; 0 = none
  bool check, timing;
  PathTimingOptions torque = {};
};

void append_sample(JsonWriter& json, const Trajectory& motion, double t) {
  const JointState x = motion.at(t);
  json.list().value(t).value(x.q).value(x.v).value(x.a).end_list();
}

/// Why the samples of a motion are not written; nothing where they are.
std::optional<std::string> too_many_samples(const Trajectory& motion, double dt) {
  const double most = std::floor(kMaxNumbers / (1 + 3 * motion.dof())), t = motion.duration();
  if (t / dt <= most) return std::nullopt;
  return text(msg::app_time_too_many, t, dt, most, t / most);
}

/// Appends samples every `dt` and at the end.
void append_samples(std::string& out, const Trajectory& motion, double dt) {
  const double duration = motion.duration();
  JsonWriter json(out);
  json.key("samples").list();
  for (long i = 0; static_cast<double>(i) * dt < duration; ++i) {
    append_sample(json, motion, static_cast<double>(i) * dt);
  }
  append_sample(json, motion, duration);
  json.end_list();
}

/// Appends the worst use of each limit; returns what is beyond one.
std::optional<std::string> append_check(std::string& out, const Trajectory& motion,
                                        const Job& job) {
  constexpr int kSamples = 20'000;
  const double dt = std::max(motion.duration() / kSamples, 1e-12);
  const LimitUse use = check_limits(motion, job.limits, dt);
  std::optional<std::string> broken;
  JsonWriter json(out);
  json.key("use").object();
  const auto add = [&](const char* name, const JointVec& shares, double slack = kRounding) {
    const double worst = shares.maxCoeff();
    json.member(name, worst);
    if (worst > 1 + slack && !broken) broken = text(msg::app_time_limit_broken, name, worst);
  };
  add("velocity", use.velocity);
  add("acceleration", use.acceleration);
  if (job.problem != TimeProblem::path_va) add("jerk", use.jerk);
  if (job.torque.dynamics) {
    const JointVec torque = job.torque.torque_share * job.limits.torque;
    add("torque", check_torque(motion, job.torque.dynamics, torque, dt), kTorqueRounding);
  }
  json.end_object();
  return broken;
}

/// Appends the answer to one case; returns why there is none, or what is wrong with it.
std::optional<std::string> answer(const Job& job, const TimeCase& entry, std::string& out) {
  const Stopwatch watch;
  const Result<Trajectory> motion = time_case(entry, job.limits, job.problem, job.torque);
  const double us = watch.us();
  std::optional<std::string> why;
  std::string body;
  bool sampled = false;
  if (motion) {
    JsonWriter(body).member("duration", motion->duration());
    if (job.check) why = append_check(body, *motion, job);
    if (job.dt > 0) {
      if (auto many = too_many_samples(*motion, job.dt)) {
        why = std::move(many);
      } else {
        sampled = true;
      }
    }
  } else {
    why = motion.error().what;
  }
  JsonWriter json(out);
  json.object().member("ok", !why);
  if (why) json.member("reason", *why);
  if (motion) out += ',' + body;
  if (sampled) append_samples(out, *motion, job.dt);  // they may be long: not copied
  if (job.timing) json.member_us("us", us);
  json.end_object();
  return why;
}

Result<int> answer_one(const Job& job, const TimeCase& entry, const BatchOptions& batch) {
  std::string line;
  const std::optional<std::string> why = answer(job, entry, line);
  return finish_one(batch, line, why, msg::app_time_no_answer);
}

Result<int> answer_all(Job job, const Options& options) {
  const Result<std::string> content = read_file(options.batch.in, kLargest);
  if (!content) return fail(content.error());
  Result<TimeCases> cases = read_time_cases(*content, job.problem);
  if (!cases)
    return fail(cases.error().code, text(msg::core_at_place, options.batch.in, cases.error().what));
  if (job.torque.dynamics && job.limits.torque.size() != cases->limits.velocity.size()) {
    return fail(Errc::usage, text(msg::app_time_torque_joints, job.limits.torque.size(),
                                  options.batch.in, cases->limits.velocity.size()));
  }
  cases->limits.torque = job.limits.torque;
  job.limits = std::move(cases->limits);
  Progress progress(text(msg::app_time_progress), cases->cases.size());
  Result<AnswerOutput> output = AnswerOutput::open(options.batch.out, options.batch.replace);
  if (!output) return fail(std::move(output.error()));
  std::string out = "{";
  BatchResult result;
  for (const TimeCase& entry : cases->cases) {
    if (interrupted()) return fail(Errc::system, text(msg::app_interrupted));
    JsonWriter(out).line_break().key(entry.id);
    const std::optional<std::string> why = answer(job, entry, out);
    ++result.requests;
    if (why && result.failed++ == 0) {
      result.first_failure = options.batch.in;
      result.first_why = text(msg::app_time_case_failed, entry.id, *why);
    }
    // The last character stays: by it the next entry knows what it follows.
    const std::string_view piece(out.data(), out.size() - 1);
    if (Result<void> written = output->write(piece, false); !written) {
      return fail(std::move(written.error()));
    }
    out.erase(0, piece.size());
    progress.advance();
  }
  const Result<void> written =
      output->write(out + "}\n", true).and_then([&] { return output->finish(); });
  if (!written) return fail(written.error());
  return finish_all(result, msg::app_time_some_failed);
}

/// Makes torques matter where `--torque` is given: those of the robot, as they come from its model.
Result<void> set_torque(const Options& options, const Robot& robot, Job& job) {
  if (job.problem != TimeProblem::path_va && job.problem != TimeProblem::path_vaj) {
    return fail(Errc::usage, text(msg::app_time_torque_paths, options.problem));
  }
  const Result<double> share = parse_quantity(options.torque, Quantity::number);
  if (!share) return fail(in_option("--torque", share.error()));
  if (!(*share > 0 && *share <= 1)) {
    return fail(Errc::usage, text(msg::app_time_bad_torque, options.torque));
  }
  const auto arm = std::make_shared<ArmDynamics>(robot.model, robot.arm);
  job.torque.torque_share = *share;
  job.torque.dynamics = [arm](const JointVec& q, const JointVec& v, const JointVec& a) {
    return arm->inverse(q, v, a);
  };
  return {};
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
  entry.start = JointState::at_rest(entry.waypoints[0]);
  entry.end = JointState::at_rest(entry.waypoints[1]);
  return entry;
}

Result<TimeProblem> read_problem(const std::string& word) {
  std::vector<std::string> names;
  for (const TimeProblem problem : kTimeProblems) {
    if (word == name(problem)) return problem;
    names.emplace_back(name(problem));
  }
  const std::optional<std::string> near = nearest_word(word, names);
  const std::string hint = near ? text(msg::app_time_did_you_mean, *near) : std::string();
  return fail(Errc::usage, text(msg::app_time_unknown_problem, word, listed(names)) + hint);
}

Result<int> run(const Options& options) {
  if (Result<void> fine = one_source(options.batch.in, options.points, "--points"); !fine) {
    return fail(std::move(fine.error()));
  }
  const Result<TimeProblem> problem = read_problem(options.problem);
  if (!problem) return fail(problem.error());
  Job job{*problem, {}, 0, options.check, !options.no_timing};
  if (!options.dt.empty()) {
    const Result<double> dt = parse_quantity(options.dt, Quantity::time);
    if (!dt) return fail(in_option("--dt", dt.error()));
    if (!(*dt > 0)) return fail(Errc::usage, text(msg::app_time_bad_dt, options.dt));
    job.dt = *dt;
  }
  const bool with_file = !options.batch.in.empty(), with_torque = !options.torque.empty();
  if (with_file && !with_torque) return answer_all(std::move(job), options);
  const Result<Robot> robot = load_robot(options.robot);
  if (!robot) return fail(robot.error());
  job.limits = robot->arm.limits;
  if (with_torque) {
    if (Result<void> set = set_torque(options, *robot, job); !set) return fail(set.error());
  }
  if (with_file) return answer_all(std::move(job), options);
  const Result<TimeCase> entry = read_points(options, *problem, robot->arm);
  if (!entry) return fail(entry.error());
  return answer_one(job, *entry, options.batch);
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_option(app, "--problem", options->problem, msg::app_time_option_problem, "NAME");
  add_option(app, "--in", options->batch.in, msg::app_time_option_in, "FILE");
  add_option(app, "--out", options->batch.out, msg::app_option_out, "FILE");
  add_overwrite_option(app, options->batch.replace);
  add_option(app, "--points", options->points, msg::app_time_option_points, "Q1,Q2,...;...");
  add_robot_options(app, options->robot);
  add_option(app, "--torque", options->torque, msg::app_time_option_torque, "SHARE", "1");
  add_option(app, "--dt", options->dt, msg::app_time_option_dt, "S");
  add_flag(app, "--check", options->check, msg::app_time_option_check);
  add_flag(app, "--no-timing", options->no_timing, msg::app_option_no_timing);
  return [options] { return run(*options); };
}

}  // namespace

Command time_command() { return {"time", msg::app_time_summary, msg::app_time_examples, setup}; }

}  // namespace mjarm::app
