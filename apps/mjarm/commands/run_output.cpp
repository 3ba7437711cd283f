#include "apps/mjarm/commands/run_output.hpp"

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <variant>

#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/core/log.hpp"

namespace mjarm::app {

namespace {

/// Share of the goals met, of a run that has goals.
const double* success_of(const Report& report) {
  const auto fact = std::ranges::find(report.facts, "success", &Fact::name);
  return fact == report.facts.end() ? nullptr : std::get_if<double>(&fact->value);
}

}  // namespace

int conclude(const Report& report, const std::filesystem::path& out) {
  if (!report.ok) {
    log_error(text(msg::demo_not_ok, report.name, report.reason, report.detail));
  } else if (const double* success = success_of(report); success && report.static_error) {
    // A policy meets many goals; its report's static error is that of the worst of them.
    log_info(
        text(msg::demo_ok_goals, report.name, 100 * *success, 1e3 * report.static_error->position));
  } else if (report.path_error) {
    log_info(text(msg::demo_ok_path, report.name, 1e3 * report.path_error->max,
                  1e3 * report.path_error->rms, 100 * report.done));
  } else if (report.static_error) {
    log_info(text(msg::demo_ok_static, report.name, 1e3 * report.static_error->position,
                  report.static_error->rotation * 180 / std::numbers::pi));
  } else {
    log_info(text(msg::demo_ok, report.name));
  }
  if (report.rtf) log_info(text(msg::demo_rtf, report.duration, *report.rtf));
  std::printf("%s\n", text(msg::demo_folder, out.string()).c_str());
  return report.ok ? 0 : 1;
}

}  // namespace mjarm::app
