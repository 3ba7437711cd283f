#include "apps/mjarm/commands/plan_answer.hpp"

#include <cassert>
#include <utility>

#include "apps/mjarm/cli/answer_json.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/core/stopwatch.hpp"

namespace mjarm::app {
namespace {

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
  append_value(out, "tool", JointVec(limit.axis_T));
  append_value(out, "world", JointVec(limit.axis_W));
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
  if (options.time_budget > 0) {
    out.path = plan_path(*checker, problem.start, problem.goals, options);
    out.us = watch.us();
    return out;
  }
  Result<RawPath, PlanFailure> raw = find_path(*checker, problem.start, problem.goals, options);
  out.us = watch.us();
  if (!raw) {
    out.path = tl::unexpected(raw.error());
    return out;
  }
  out.path = finish_path(*checker, std::move(*raw), options);
  out.simplify_us = watch.us() - out.us;
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
    append_us(out, answer.us);
    append_us(out, answer.simplify_us, "simplify_us");
  }
  out += '}';
}

}  // namespace mjarm::app
