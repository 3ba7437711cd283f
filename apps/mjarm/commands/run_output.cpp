#include "apps/mjarm/commands/run_output.hpp"

#include <cstdio>
#include <numbers>

#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/core/log.hpp"

namespace mjarm::app {

int conclude(const Report& report, const std::filesystem::path& out) {
  if (!report.ok) {
    log_error(text(msg::demo_not_ok, report.name, report.reason, report.detail));
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
