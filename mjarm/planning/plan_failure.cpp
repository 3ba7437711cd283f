#include <algorithm>

#include "mjarm/core/messages/planning.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/planning/ompl_planners.hpp"
#include "mjarm/planning/plan_path.hpp"

namespace mjarm {
namespace {

std::string link_name(const FastRobot& robot, int link) {
  if (link < 0) return "?";
  return robot.spheres().links[static_cast<std::size_t>(link)].name;
}

std::string obstacle_text(const Obstacles& obstacles, int obstacle) {
  const std::string& name = obstacle_name(obstacles, obstacle);
  if (name.empty()) return text(msg::planning_obstacle_number, obstacle);
  return text(msg::planning_obstacle, name);
}

std::string other_name(const SphereClearance& pair, const FastRobot& robot,
                       const Obstacles& obstacles) {
  if (pair.obstacle >= 0) return obstacle_text(obstacles, pair.obstacle);
  return text(msg::planning_link, link_name(robot, pair.other_link));
}

std::string outside(const Msg& message, const PlanFailure& failure, const Arm& arm) {
  const auto joint = static_cast<std::size_t>(failure.joint);
  return text(message, arm.joints[joint].name, failure.value, arm.limits.lower[failure.joint],
              arm.limits.upper[failure.joint]);
}

std::string overlap(const Msg& message, const SphereClearance& pair, const FastRobot& robot,
                    const Obstacles& obstacles) {
  return text(message, text(msg::planning_link, link_name(robot, pair.link)),
              other_name(pair, robot, obstacles), -1e3 * pair.distance);
}

std::string off_region(const Msg& message, const RegionRoom& room) {
  return text(message, 1e3 * std::max(0.0, -room.place), std::max(0.0, -room.turn));
}

/// What blocks the start; where that could be carried away, what to do about it.
std::string start_hit(const SphereClearance& pair, const FastRobot& robot,
                      const Obstacles& obstacles) {
  const std::string what = overlap(msg::planning_start_hit, pair, robot, obstacles);
  const auto solid = static_cast<std::size_t>(pair.obstacle);
  if (pair.obstacle < 0 || solid >= obstacles.solids.size()) return what;
  const std::string& body = obstacles.solids[solid].movable;
  if (body.empty()) return what;
  return text(msg::planning_start_movable, what, body, link_name(robot, pair.link));
}

std::string enclosed(const Pocket& pocket, const FastRobot& robot) {
  const Msg& how = pocket.at_goal ? msg::planning_enclosed_goal : msg::planning_enclosed_start;
  return text(pocket.goals > 1 ? msg::planning_enclosed_goals : msg::planning_enclosed,
              pocket.goals,
              text(how, 1e3 * pocket.radius, link_name(robot, pocket.link), 1e3 * pocket.volume),
              1e3 * pocket.cell);
}

std::string barred(const JointBarrier& barrier, const FastRobot& robot,
                   const Obstacles& obstacles) {
  return text(msg::planning_barred,
              robot.arm().joints[static_cast<std::size_t>(barrier.joint)].name, barrier.at,
              link_name(robot, barrier.link), obstacle_text(obstacles, barrier.obstacle));
}

}  // namespace

std::string describe(const PlanFailure& failure, const FastRobot& robot,
                     const Obstacles& obstacles) {
  switch (failure.code) {
    case PlanErrc::bad_input:
      break;
    case PlanErrc::base_hit:
      return text(msg::planning_base_hit, link_name(robot, failure.pair.link),
                  obstacle_text(obstacles, failure.pair.obstacle));
    case PlanErrc::start_outside:
      return outside(msg::planning_start_outside, failure, robot.arm());
    case PlanErrc::goals_outside:
      return outside(msg::planning_goals_outside, failure, robot.arm());
    case PlanErrc::start_hit:
      return start_hit(failure.pair, robot, obstacles);
    case PlanErrc::goals_hit:
      return overlap(msg::planning_goals_hit, failure.pair, robot, obstacles);
    case PlanErrc::bad_tilt:
      return text(msg::planning_bad_tilt, kLeastTilt);
    case PlanErrc::start_tilted:
      return text(msg::planning_start_tilted, failure.value, failure.limit);
    case PlanErrc::goals_tilted:
      return text(msg::planning_goals_tilted, failure.value, failure.limit);
    case PlanErrc::bad_region:
      return text(msg::planning_bad_region, 1e3 * kLeastPlaceRange, kLeastTurnRange);
    case PlanErrc::start_off:
      return off_region(msg::planning_start_off, failure.room);
    case PlanErrc::goals_off:
      return off_region(msg::planning_goals_off, failure.room);
    case PlanErrc::enclosed:
      return enclosed(failure.pocket, robot);
    case PlanErrc::barred:
      return barred(failure.barrier, robot, obstacles);
    case PlanErrc::budget_spent:
      return text(msg::planning_budget, failure.samples, failure.nearest);
    case PlanErrc::out_of_time:
      return text(msg::planning_out_of_time, failure.limit, failure.samples, failure.nearest);
    case PlanErrc::stopped:
      return stopped().what;
    case PlanErrc::bad_clearance:
      return text(msg::planning_bad_clearance, failure.limit, kMaxClearanceAsked);
    case PlanErrc::too_near:
      return text(failure.possible > 0 ? msg::planning_less_clearance : msg::planning_no_clearance,
                  1e3 * failure.limit, 1e3 * failure.possible);
    case PlanErrc::unproved:
      return text(msg::planning_unproved);
    case PlanErrc::not_available:
      if (ompl_version().empty()) return text(msg::planning_no_ompl);
      return text(msg::planning_unknown_ompl, listed(ompl_planner_names()));
    case PlanErrc::tilt_with_ompl:
      return text(msg::planning_tilt_with_ompl);
    case PlanErrc::back_end:
      return text(msg::planning_ompl_failed);
  }
  return text(msg::planning_bad_input, robot.dof());
}

}  // namespace mjarm
