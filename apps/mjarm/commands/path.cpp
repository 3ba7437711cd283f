#include "mjarm/core/messages/path.hpp"

#include <cmath>
#include <memory>
#include <optional>

#include "apps/mjarm/cli/batch.hpp"
#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/orientation.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/commands/path_answer.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/path_command.hpp"
#include "mjarm/collision/exact.hpp"
#include "mjarm/core/json.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/path/path_fix.hpp"
#include "mjarm/path/path_measures.hpp"
#include "mjarm/path/path_request.hpp"
#include "mjarm/path/solve_curve.hpp"

namespace mjarm::app {
namespace {

struct Options {
  RobotChoice robot{.looks = false};
  BatchOptions batch;
  std::string from, via, to, euler, quat, request, start, max_step, tilt;
  bool keep_start = false, collisions = false, partial = false, no_timing = false;
};

/// What stays the same for all requests.
struct Job {
  IkSolver ik;
  PathOptions path;
  bool partial, timing;
};

using Solved = Result<JointPath, PathFailure>;

/// A path, or why it stops and what mends it.
struct Answer {
  Solved path;
  std::vector<PathFix> fixes;
};

Answer solve(const Job& job, const PathRequest& request) {
  CurveOptions options;
  options.path = job.path;
  options.path.max_step = request.max_step.value_or(job.path.max_step);
  options.path.orientation_tol = request.tilt.value_or(job.path.orientation_tol);
  options.path.tool_speed = request.speed.value_or(0);
  // Without a start any will do: of the tracks with room enough that with the best postures.
  options.path.best_posture = !request.q;
  const std::span<const double> q_start = request.q ? *request.q : as_span(job.ik.arm().home);
  const auto fixes = [&](const auto& path, const auto& how, const PathFailure& failure) {
    return find_fixes(job.ik, path, q_start, how, failure);
  };
  if (request.curve) {
    Answer out{solve_curve(job.ik, *request.curve, q_start, options), {}};
    if (!out.path) out.fixes = fixes(*request.curve, options, out.path.error());
    return out;
  }
  const std::span<const Pose> poses = request.poses;
  Answer out{solve_path(job.ik, poses, q_start, options.path), {}};
  if (!out.path) out.fixes = fixes(poses, options.path, out.path.error());
  return out;
}

/// Solves one request and appends the answer. Where there is none, returns why.
std::optional<std::string> answer(const Job& job, const PathRequest& request, std::string& out) {
  const Stopwatch watch;
  const Arm& arm = job.ik.arm();
  const Answer solved = solve(job, request);
  const double us = watch.us();
  const JointPath& had = solved.path ? *solved.path : solved.path.error().partial;
  std::optional<PathMeasures> measures;
  if (!had.q.empty()) measures = measure_path(arm, had.q, job.path.clearance, job.path.stop);
  std::optional<std::string> why;
  if (solved.path) {
    append_path(out, *solved.path, *measures);
  } else {
    why = describe(solved.path.error(), arm);
    append_path_failure(out, solved.path.error(), solved.fixes, arm, measures, job.partial);
    if (!request.curve) {
      append_unreachable(
          out, unreachable_ranges(job.ik, request.poses, as_span(arm.home), job.path.stop));
    }
    if (!solved.fixes.empty()) {
      why = text(msg::path_command_mended, *why, describe(solved.fixes.front()));
    }
  }
  JsonWriter json(out);
  if (job.timing) json.member_us("us", us);
  json.end_object();
  return why;
}

Result<PathRequest> read_request(std::string_view line, const Arm& arm) {
  const Result<JsonObject> object = parse_json_object(line);
  if (!object) return fail(object.error());
  return path_request_of(**object, arm);
}

Result<Pose> read_pose(const std::string& option, const std::string& value,
                       const Eigen::Matrix3d& R) {
  const auto p = parse_list(option, value, Quantity::length, 3);
  if (!p) return fail(p.error());
  return Pose{{(*p)[0], (*p)[1], (*p)[2]}, R};
}

/// `--from` and `--to`, maybe `--via`: a line or an arc with one orientation.
Result<Curve> read_curve(const Options& options) {
  const Result<Eigen::Matrix3d> R = parse_rotation(options.euler, options.quat);
  if (!R) return fail(R.error());
  const Result<Pose> from = read_pose("--from", options.from, *R);
  if (!from) return fail(from.error());
  const Result<Pose> to = read_pose("--to", options.to, *R);
  if (!to) return fail(to.error());
  if (options.via.empty()) return Curve::line(*from, *to);
  const Result<Pose> via = read_pose("--via", options.via, *R);
  if (!via) return fail(via.error());
  return Curve::arc(*from, *via, *to);
}

Result<PathRequest> read_request(const Options& options, const Arm& arm) {
  PathRequest request;
  if (!options.request.empty()) {
    Result<PathRequest> read = read_request(options.request, arm);
    if (!read) return fail(in_option("--request", read.error()));
    request = std::move(*read);
  } else {
    Result<Curve> curve = read_curve(options);
    if (!curve) return fail(std::move(curve.error()));
    request.curve = std::move(*curve);
  }
  if (options.start.empty()) return request;
  auto q = parse_joints("--start", options.start, arm);
  if (!q) return fail(std::move(q.error()));
  request.q = std::move(*q);
  return request;
}

Result<int> answer_one(const Job& job, const Options& options) {
  const Result<PathRequest> request = read_request(options, job.ik.arm());
  if (!request) return fail(request.error());
  std::string line;
  const std::optional<std::string> why = answer(job, *request, line);
  if (interrupted()) return fail(stopped());
  return finish_one(options.batch, line, why, msg::path_command_impossible);
}

Result<int> answer_all(const Job& job, const Options& options) {
  const auto answer_line = [&](std::string_view line,
                               std::string& out) -> Result<std::optional<std::string>> {
    const Result<PathRequest> request = read_request(line, job.ik.arm());
    if (!request) return fail(request.error());
    std::optional<std::string> why = answer(job, *request, out);
    if (interrupted()) return fail(stopped());
    return why;
  };
  const auto done = run_batch(options.batch, text(msg::path_command_progress), answer_line);
  if (!done) return fail(done.error());
  return finish_all(*done, msg::path_command_some_failed);
}

Result<PathOptions> path_options(const Options& options, const Robot& robot) {
  PathOptions path;
  path.keep_start = options.keep_start;
  path.stop = interrupted;
  if (options.collisions) path.clearance = clearance_check({robot.model, robot.arm});
  if (!options.tilt.empty()) {
    const Result<double> tilt = parse_quantity(options.tilt, Quantity::angle);
    if (!tilt) return fail(in_option("--orientation-tol", tilt.error()));
    if (!check_tilt(*tilt)) return fail(Errc::bad_input, text(msg::path_command_bad_tilt));
    path.orientation_tol = *tilt;
  }
  if (options.max_step.empty()) return path;
  const Result<double> step = parse_quantity(options.max_step, Quantity::angle);
  if (!step) return fail(in_option("--max-step", step.error()));
  if (!is_sound_step(*step)) return fail(Errc::bad_input, text(msg::path_command_bad_step));
  path.max_step = *step;
  return path;
}

Result<int> run(Options options) {
  const std::string& one = options.request.empty() ? options.from : options.request;
  const std::string word = options.request.empty() ? "--from" : "--request";
  if (Result<void> fine = one_source(options.batch.in, one, word); !fine) {
    return fail(std::move(fine.error()));
  }
  options.batch.longest_line = std::size_t{1} << 26;  // some 300,000 poses
  Result<Robot> robot = load_robot(options.robot);
  if (!robot) return fail(std::move(robot.error()));
  Result<PathOptions> path = path_options(options, *robot);
  if (!path) return fail(std::move(path.error()));
  const Job job{IkSolver(robot->arm), std::move(*path), options.partial, !options.no_timing};
  return options.batch.in.empty() ? answer_one(job, options) : answer_all(job, options);
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_robot_options(app, options->robot);
  const auto add = [&app](const char* name, std::string& value, Msg help, const char* type) {
    add_option(app, name, value, help, type);
  };
  add("--from", options->from, msg::path_command_from, "X,Y,Z");
  add("--via", options->via, msg::path_command_via, "X,Y,Z");
  add("--to", options->to, msg::path_command_to, "X,Y,Z");
  add("--euler", options->euler, msg::app_option_euler, "A,B,C");
  add("--quat", options->quat, msg::app_option_quat, "W,X,Y,Z");
  add("--request", options->request, msg::path_command_request, "JSON");
  add_batch_options(app, options->batch);
  add("--start", options->start, msg::path_command_start, "Q1,Q2,...");
  add("--max-step", options->max_step, msg::path_command_step, "STEP");
  add("--orientation-tol", options->tilt, msg::path_command_tilt, "ANGLE");
  add_flag(app, "--keep-start", options->keep_start, msg::path_command_keep_start);
  add_flag(app, "--collisions", options->collisions, msg::path_command_collisions);
  add_flag(app, "--partial", options->partial, msg::path_command_partial);
  add_flag(app, "--no-timing", options->no_timing, msg::app_option_no_timing);
  return [options] { return run(*options); };
}

}  // namespace

Command path_command() {
  return {"path", msg::path_command_summary, msg::path_command_examples, setup};
}

}  // namespace mjarm::app
