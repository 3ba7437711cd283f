#include "apps/mjarm/commands/rule_options.hpp"

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
    Result<AttachedBody> attached = attach_in_place(robot.model, robot.arm, body, q);
    if (!attached) return fail(in_option("--hold", attached.error()));
    out.attached.push_back(std::move(*attached));
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

}  // namespace mjarm::app
