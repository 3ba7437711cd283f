#include <cmath>
#include <filesystem>

#include "apps/mjarm/demos/program_demo.hpp"
#include "apps/mjarm/learn/exercise.hpp"
#include "apps/mjarm/learn/json_file.hpp"
#include "apps/mjarm/messages/learn.hpp"

namespace mjarm::app {
namespace {

bool has_number(const JsonValue& object, std::string_view key) {
  const JsonValue* const value = object.find(key);
  return value != nullptr && value->is_number();
}

/// Whether it took as long as the ellipse that comes with the demo takes.
Result<bool> is_shipped_ellipse(const JsonValue& report) {
  Result<program::Program> shipped = demo_program("ellipse");
  if (!shipped) return fail(shipped.error());
  DemoOptions options;
  options.robot.robot = "ur5e";
  const Result<program::LoadedProgram> loaded = plan_demo(std::move(*shipped), options);
  if (!loaded) return fail(loaded.error());
  const double duration = loaded->plan.duration();
  return std::abs(number_in(report, "cycle_time") - duration) < 1e-6 * duration;
}

void tell_dips(const JsonValue& report, LearnReport& out) {
  const JsonValue* const dips = report.find("speed_dips");
  if (dips == nullptr || !dips->is_list()) return;
  const JsonValue* slowest = nullptr;
  for (const JsonValue& dip : *dips) {
    if (slowest == nullptr || number_in(dip, "least") < number_in(*slowest, "least")) {
      slowest = &dip;
    }
  }
  if (slowest == nullptr) return;
  out.note(text(msg::learn_ellipse_slow, number_in(*slowest, "least"), word_in(*slowest, "joint"),
                word_in(*slowest, "limit")));
}

}  // namespace

Result<LearnReport> check_ellipse(const Exercise& exercise) {
  const std::string file = (std::filesystem::path(exercise.file) / "report.json").string();
  std::error_code unknown;
  if (!std::filesystem::exists(file, unknown)) {
    return fail(Errc::bad_input, text(msg::learn_ellipse_no_report, exercise.file));
  }
  const Result<JsonObject> read = read_json_file(file);
  if (!read) return fail(read.error());
  const JsonValue& report = **read;
  const std::string name = word_in(report, "name");
  const JsonValue* const ok = report.find("ok");
  if (name.empty() || ok == nullptr || !ok->is_boolean()) {
    return fail(Errc::bad_input, text(msg::learn_no_demo_report, file));
  }
  LearnReport out;
  if (name != "ellipse") {
    out.wrong(text(msg::learn_ellipse_other, name));
    return out;
  }
  if (!ok->boolean()) {
    out.wrong(text(msg::learn_ellipse_not_drawn, 100 * number_in(report, "coverage"),
                   word_in(report, "detail")));
    out.note(text(msg::learn_ellipse_smaller));
    return out;
  }
  if (!has_number(report, "cycle_time") || !has_number(report, "path_error_max")) {
    return fail(Errc::bad_input, text(msg::learn_no_demo_report, file));
  }
  const Result<bool> shipped = is_shipped_ellipse(report);
  if (!shipped) return fail(shipped.error());
  if (*shipped) {
    out.wrong(text(msg::learn_ellipse_shipped));
    return out;
  }
  out.right(text(msg::learn_ellipse_right, 1e6 * number_in(report, "path_error_max"),
                 100 * number_in(report, "coverage")));
  tell_dips(report, out);
  return out;
}

}  // namespace mjarm::app
