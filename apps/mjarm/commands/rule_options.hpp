#pragma once

#include <span>

#include "apps/mjarm/cli/options.hpp"
#include "mjarm/collision/contact_rules.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/planning/plan_file.hpp"

namespace mjarm::app {

/// Adds `--hold BODY` and `--allow A,B`.
void add_rule_options(CLI::App& app, RuleWords& words);

/// The rules, where bodies are attached as they stand while the arm is at `q`, shape (dof,).
[[nodiscard]] Result<ContactRules> rules_of(const RuleWords& words, const Robot& robot,
                                            std::span<const double> q);

}  // namespace mjarm::app
