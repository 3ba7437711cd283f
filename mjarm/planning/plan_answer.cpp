#include "mjarm/planning/plan_answer.hpp"

#include <cassert>
#include <cmath>
#include <utility>

#include "mjarm/core/number.hpp"
#include "mjarm/core/stopwatch.hpp"

namespace mjarm {
namespace {

// Members of a JSON object, each with the comma before it.
void append_key(std::string& out, const char* key) { out += std::string(",\"") + key + "\":"; }

void append_value(std::string& out, const char* key, double value) {
  append_key(out, key);
  append_number(out, value);
}

void append_axis(std::string& out, const char* key, const Eigen::Vector3d& axis) {
  append_key(out, key);
  append_numbers(out, {axis.data(), 3});
}

void append_rows(std::string& out, const char* key, std::span<const JointVec> rows) {
  append_key(out, key);
  out += '[';
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i > 0) out += ',';
    append_numbers(out, as_span(rows[i]));
  }
  out += ']';
}

/// To a tenth of a microsecond.
void append_us(std::string& out, const char* key, double us) {
  append_value(out, key, std::round(us * 10) / 10);
}

std::string other_of(const SphereClearance& nearest, const FastRobot& robot,
                     const Obstacles& obstacles) {
  if (nearest.obstacle >= 0) {
    return obstacle_name(obstacles, nearest.obstacle);
  }
  return robot.spheres().links[static_cast<std::size_t>(nearest.other_link)].name;
}

void append_proof(std::string& out, const EdgeCertificate& proof, const FastRobot& robot,
                  const Obstacles& obstacles) {
  out += "{\"step\":" + number(proof.step);
  append_value(out, "clearance", proof.nearest.distance);
  append_value(out, "t", proof.nearest_t);
  if (proof.nearest.link >= 0) {
    append_key(out, "pair");
    out += '[';
    append_json_string(out,
                       robot.spheres().links[static_cast<std::size_t>(proof.nearest.link)].name);
    out += ',';
    append_json_string(out, other_of(proof.nearest, robot, obstacles));
    out += ']';
  }
  out += '}';
}

void append_tilt(std::string& out, const TiltLimit& limit, double largest) {
  append_key(out, "tilt");
  out += "{\"limit\":" + number(limit.max);
  append_value(out, "largest", largest);
  append_axis(out, "tool", limit.axis_T);
  append_axis(out, "world", limit.axis_W);
  out += '}';
}

/// A list of strings; nothing for an empty one.
void append_words(std::string& out, const char* key, const std::vector<std::string>& words) {
  if (words.empty()) return;
  append_key(out, key);
  for (std::size_t i = 0; i < words.size(); ++i) {
    out += i == 0 ? '[' : ',';
    append_json_string(out, words[i]);
  }
  out += ']';
}

}  // namespace

PlanAnswer answer_problem(const FastRobot& robot, const PlanProblem& problem,
                          const PlanOptions& options) {
  PlanAnswer out{.path = {}, .tilt = options.tilt};
  const Stopwatch watch;
  const Result<FastChecker> checker = FastChecker::make(robot, problem.obstacles);
  assert(checker);  // the obstacles were checked when they were read
  PlanTimes times;
  out.path = plan_path(*checker, problem.start, problem.goals, options, &times);
  out.us = watch.us();
  if (options.time_budget > 0) return out;
  out.simplify_us = times.finish_us;
  out.us -= times.finish_us;
  return out;
}

void append_answer(std::string& out, const PlanAnswer& answer, const FastRobot& robot,
                   const Obstacles& obstacles, bool timing) {
  if (answer.path) {
    out += "{\"ok\":true";
    append_rows(out, "path", answer.path->q);
    append_value(out, "cost", answer.path->cost);
    append_key(out, "certificate");
    out += '[';
    for (std::size_t i = 0; i < answer.path->proof.size(); ++i) {
      if (i > 0) out += ',';
      append_proof(out, answer.path->proof[i], robot, obstacles);
    }
    out += ']';
    if (answer.tilt) append_tilt(out, *answer.tilt, answer.path->tilt);
    append_words(out, "hold", answer.rules.hold);
    append_words(out, "allow", answer.rules.allow);
    if (answer.spheres) append_value(out, "spheres", *answer.spheres);
  } else {
    out += "{\"ok\":false";
    append_key(out, "reason");
    append_json_string(out, describe(answer.path.error(), robot, obstacles));
  }
  if (timing) {
    append_us(out, "us", answer.us);
    append_us(out, "simplify_us", answer.simplify_us);
  }
  out += '}';
}

}  // namespace mjarm
