#include "apps/mjarm/commands/robot_world.hpp"

#include <utility>

#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/messages/plan.hpp"

namespace mjarm::app {

void add_rule_options(CLI::App& app, RuleWords& words) {
  add_option(app, "--hold", words.hold, msg::plan_option_hold, "BODY");
  add_option(app, "--allow", words.allow, msg::plan_option_allow, "A,B");
}

Result<ContactRules> rules_of(const RuleWords& words, const Robot& robot,
                              std::span<const double> q) {
  ContactRules out;
  for (const std::string& body : words.hold) {
    Result<HeldBody> held = hold_where_it_is(robot.model, robot.arm, body, q);
    if (!held) return fail(in_option("--hold", held.error()));
    out.held.push_back(std::move(*held));
  }
  if (Result<void> fine = check_contact_rules(robot.model, robot.arm, out); !fine) {
    return fail(in_option("--hold", fine.error()));
  }
  for (const std::string& pair : words.allow) {
    const std::size_t comma = pair.find(',');
    if (comma == std::string::npos) return fail(Errc::usage, text(msg::plan_bad_allow, pair));
    out.allowed.push_back({pair.substr(0, comma), pair.substr(comma + 1)});
  }
  if (Result<void> fine = check_contact_rules(robot.model, robot.arm, out); !fine) {
    return fail(in_option("--allow", fine.error()));
  }
  return out;
}

Result<RobotWorld> cover_robot(const Robot& robot, double bound, const ContactRules& rules) {
  const CoverOptions options{
      .bound = bound, .whole_stroke = robot.arm.gripper.has_value(), .rules = rules};
  Result<ModelCover> cover = cover_model(robot.model, robot.arm, options);
  if (!cover) return fail(std::move(cover.error()));
  const Result<FastRobot> fast = FastRobot::make(robot.arm, cover->spheres);
  if (!fast) return fail(fast.error());
  Result<FastChecker> checker = FastChecker::make(*fast, cover->scene);
  if (!checker) return fail(std::move(checker.error()));
  return RobotWorld{std::move(*cover), std::move(*checker)};
}

ProblemFile as_problem(const Robot& robot, RobotWorld world, const GivenPath& path) {
  PlanProblem problem;
  problem.id = path.id;
  problem.obstacles = std::move(world.cover.scene);
  if (!path.rows.empty()) {
    problem.start = path.rows.front();
    problem.goals = path.rows.back();
  }
  return {robot.arm, std::move(world.cover.spheres), {std::move(problem)}};
}

}  // namespace mjarm::app
