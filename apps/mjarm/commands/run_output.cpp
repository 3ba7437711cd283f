#include "apps/mjarm/commands/run_output.hpp"

#include <algorithm>
#include <cstdio>
#include <map>
#include <numbers>
#include <string>
#include <string_view>
#include <variant>

#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/core/log.hpp"

namespace mjarm::app {

namespace {

/// A figure, or figures, that not every run has; null where this one has not.
template <class Value>
const Value* fact_of(const Report& report, std::string_view name) {
  const auto fact = std::ranges::find(report.facts, name, &Fact::name);
  return fact == report.facts.end() ? nullptr : std::get_if<Value>(&fact->value);
}

}  // namespace

int conclude(const Report& report, const std::filesystem::path& out) {
  if (!report.ok) {
    log_error(text(msg::demo_not_ok, report.name, report.reason, report.detail));
  } else if (const auto* success = fact_of<double>(report, "success");
             success && report.static_error) {
    // A policy meets many goals; its report's static error is that of the worst of them.
    log_info(
        text(msg::demo_ok_goals, report.name, 100 * *success, 1e3 * report.static_error->position));
  } else if (const auto* ink = fact_of<std::map<std::string, double>>(report, "ink")) {
    log_info(text(msg::demo_ok_ink, report.name, 1e3 * ink->at("max"), ink->at("force_min"),
                  ink->at("force_max")));
  } else if (report.path_error) {
    log_info(text(msg::demo_ok_path, report.name, 1e3 * report.path_error->max,
                  1e3 * report.path_error->rms, 100 * report.done));
  } else if (report.static_error) {
    log_info(text(msg::demo_ok_static, report.name, 1e3 * report.static_error->position,
                  report.static_error->rotation * 180 / std::numbers::pi));
  } else {
    log_info(text(msg::demo_ok, report.name));
  }
  if (report.torque_use > 1) log_warning(text(msg::demo_torque, report.torque_use));
  if (report.saturated_steps > 0) {
    log_warning(text(msg::demo_saturated, report.saturated_steps, report.steps));
  }
  if (report.rtf) log_info(text(msg::demo_rtf, report.duration, *report.rtf));
  std::printf("%s\n", text(msg::demo_folder, out.string()).c_str());
  return report.ok ? 0 : 1;
}

}  // namespace mjarm::app
