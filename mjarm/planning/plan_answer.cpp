#include "mjarm/planning/plan_answer.hpp"

#include <cassert>
#include <utility>

#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/stopwatch.hpp"

namespace mjarm {
namespace {

std::string other_of(const SphereClearance& nearest, const FastRobot& robot,
                     const Obstacles& obstacles) {
  if (nearest.obstacle >= 0) {
    return obstacle_name(obstacles, nearest.obstacle);
  }
  return robot.spheres().links[static_cast<std::size_t>(nearest.other_link)].name;
}

void append_proof(JsonWriter& json, const EdgeCertificate& proof, const FastRobot& robot,
                  const Obstacles& obstacles) {
  json.object()
      .member("step", proof.step)
      .member("clearance", proof.nearest.distance)
      .member("t", proof.nearest_t);
  if (proof.nearest.link >= 0) {
    json.key("pair")
        .list()
        .value(robot.spheres().links[static_cast<std::size_t>(proof.nearest.link)].name)
        .value(other_of(proof.nearest, robot, obstacles))
        .end_list();
  }
  json.end_object();
}

void append_tilt(JsonWriter& json, const TiltLimit& limit, double largest) {
  json.key("tilt")
      .object()
      .member("limit", limit.max)
      .member("largest", largest)
      .member("tool", limit.axis_T)
      .member("world", limit.axis_W)
      .end_object();
}

/// A list of strings; nothing for an empty one.
void append_words(JsonWriter& json, const char* key, const std::vector<std::string>& words) {
  if (!words.empty()) json.member(key, words);
}

}  // namespace

PlanAnswer answer_problem(const FastRobot& robot, const PlanProblem& problem,
                          const PlanOptions& options) {
  PlanAnswer out{.path = {}, .tilt = options.tilt};
  const Stopwatch watch;
  const Result<FastChecker> checker = FastChecker::create(robot, problem.obstacles);
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
  JsonWriter json(out);
  json.object().member("ok", answer.path.has_value());
  if (answer.path) {
    json.member("path", answer.path->q).member("cost", answer.path->cost).key("certificate").list();
    for (const EdgeCertificate& proof : answer.path->proof) {
      append_proof(json, proof, robot, obstacles);
    }
    json.end_list();
    if (answer.tilt) append_tilt(json, *answer.tilt, answer.path->tilt);
    append_words(json, "hold", answer.rules.hold);
    append_words(json, "allow", answer.rules.allow);
    if (answer.spheres) json.member("spheres", *answer.spheres);
  } else {
    json.member("reason", describe(answer.path.error(), robot, obstacles));
  }
  if (timing) json.member_us("us", answer.us).member_us("simplify_us", answer.simplify_us);
  json.end_object();
}

}  // namespace mjarm
