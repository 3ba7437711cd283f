#include "mjarm/planning/plan_answer.hpp"

#include <cassert>
#include <utility>

#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/planning/clear_path_internal.hpp"
#include "mjarm/planning/region_json_internal.hpp"

namespace mjarm {
namespace {

std::string other_of(const SphereClearance& nearest, const FastRobot& robot,
                     const Obstacles& obstacles) {
  if (nearest.obstacle >= 0) {
    return obstacle_name(obstacles, nearest.obstacle);
  }
  return robot.spheres().links[static_cast<std::size_t>(nearest.other_link)].name;
}

/// @param kept  [m] proved all along the edge, where a clearance was asked.
void append_proof(JsonWriter& json, const EdgeCertificate& proof, std::optional<double> kept,
                  const FastRobot& robot, const Obstacles& obstacles) {
  json.object()
      .member("step", proof.step)
      .member("clearance", proof.nearest.distance)
      .member("t", proof.nearest_t);
  if (kept) json.member("kept", *kept);
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

void append_pocket(JsonWriter& json, const Pocket& pocket, const FastRobot& robot) {
  json.key("enclosed")
      .object()
      .member("link", robot.spheres().links[static_cast<std::size_t>(pocket.link)].name)
      .member("radius", pocket.radius)
      .member("at", pocket.at_goal ? "goal" : "start")
      .member("volume", pocket.volume)
      .member("cell", pocket.cell)
      .end_object();
}

/// A list of strings; nothing for an empty one.
void append_words(JsonWriter& json, const char* key, const std::vector<std::string>& words) {
  if (!words.empty()) json.member(key, words);
}

/// With the clearance that is asked; where that fails, what is possible.
Result<PlannedPath, PlanFailure> plan_clear(const FastChecker& checker, const PlanProblem& problem,
                                            const PlanOptions& options, PlanTimes& times) {
  const detail::ClearScene scene{checker, problem.obstacles};
  const auto plan = [&](const PlanOptions& how, PlanTimes* taken) {
    return detail::plan_clear(scene, problem.start, problem.goals, how, detail::ClearEnds::own,
                              taken);
  };
  Result<PlannedPath, PlanFailure> path = plan(options, &times);
  if (path || !detail::is_for_clearance(path.error())) return path;
  const auto any = plan_path(checker, problem.start, problem.goals, options);
  if (!any) return any;
  const double possible = detail::largest_clearance(
      options, [&](const PlanOptions& less) { return plan(less, nullptr).has_value(); });
  if (is_stopped(options.stop)) return path;
  return tl::unexpected(detail::too_near(*options.clearance, possible));
}

}  // namespace

PlanAnswer answer_problem(const FastRobot& robot, const PlanProblem& problem,
                          const PlanOptions& options) {
  PlanAnswer out{.path = {}, .tilt = options.tilt, .within = options.within};
  const Stopwatch watch;
  const Result<FastChecker> checker = FastChecker::create(robot, problem.obstacles);
  assert(checker);  // the obstacles were checked when they were read
  PlanTimes times;
  EnclosureTest enclosure(*checker, problem.obstacles, problem.start, problem.goals);
  PlanOptions how = options;
  how.enclosure = &enclosure;
  if (!detail::is_sound_clearance(options.clearance)) {
    out.path =
        tl::unexpected(PlanFailure{.code = PlanErrc::bad_clearance, .limit = *options.clearance});
  } else if (options.clearance.value_or(0) > 0) {
    out.path = plan_clear(*checker, problem, how, times);
  } else {
    out.path = plan_path(*checker, problem.start, problem.goals, how, &times);
  }
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
    const std::vector<double>& kept = answer.path->kept;
    for (std::size_t i = 0; i < answer.path->proof.size(); ++i) {
      append_proof(json, answer.path->proof[i],
                   kept.empty() ? std::nullopt : std::optional<double>(kept[i]), robot, obstacles);
    }
    json.end_list();
    if (!kept.empty()) json.member("clearance", answer.path->clearance);
    if (answer.tilt) append_tilt(json, *answer.tilt, answer.path->tilt);
    if (answer.within) {
      detail::append_kept_region(json.key("within"), *answer.within, answer.path->room);
    }
    if (answer.path->start_region >= 0) json.member("start_region", answer.path->start_region);
    if (answer.path->goal_region >= 0) json.member("goal_region", answer.path->goal_region);
    append_words(json, "hold", answer.rules.hold);
    append_words(json, "allow", answer.rules.allow);
  } else {
    json.member("reason", answer.reason.empty() ? describe(answer.path.error(), robot, obstacles)
                                                : answer.reason);
    if (answer.same_posture.size() > 0) json.member("same_posture", answer.same_posture);
    if (answer.path.error().code == PlanErrc::enclosed) {
      append_pocket(json, answer.path.error().pocket, robot);
    }
    if (answer.path.error().code == PlanErrc::too_near) {
      json.member("possible_clearance", answer.path.error().possible);
    }
  }
  if (timing) json.member_us("us", answer.us).member_us("simplify_us", answer.simplify_us);
  json.end_object();
}

}  // namespace mjarm
