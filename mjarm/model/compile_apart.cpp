#include "mjarm/core/messages/guard.hpp"
#include "mjarm/model/compile_apart_internal.hpp"

namespace mjarm {
namespace {

std::string name_of(Stage stage) {
  switch (stage) {
    case Stage::reading:
      return text(msg::guard_reading);
    case Stage::compiling:
      return text(msg::guard_compiling);
    case Stage::stepping:
      return text(msg::guard_stepping);
  }
  return "";
}

}  // namespace

Stage take_stages(std::string_view& said) {
  Stage last = Stage::reading;
  while (!said.empty() && said.front() != kTrialError && said.front() != kTrialModel) {
    last = static_cast<Stage>(said.front());
    said.remove_prefix(1);
  }
  return last;
}

Error bad_end(const SpecSource& source, const ChildResult& result, Stage stage) {
  switch (result.end) {
    case ChildEnd::out_of_time:
      return {Errc::bad_input, text(msg::guard_out_of_time, source.name(), name_of(stage),
                                    kTrialLimits.cpu_seconds)};
    case ChildEnd::stuck:
      return {Errc::bad_input,
              text(msg::guard_stuck, source.name(), name_of(stage), kTrialLimits.idle_seconds)};
    case ChildEnd::too_long:
      return {Errc::bad_input, text(msg::guard_too_large, source.name(), kTrialLimits.answer / 2)};
    default:
      return {Errc::bad_input,
              text(msg::guard_crashed, source.name(), name_of(stage), result.signal)};
  }
}

}  // namespace mjarm
