#include "mjarm/core/messages/model.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/mujoco_guard.hpp"

namespace mjarm {

Result<LoadedModel> compile_text(const std::string& mjcf) {
  constexpr int kErrorSize = 2048;
  char error[kErrorSize] = "";
  mjSpec* parsed = nullptr;
  mjModel* compiled = nullptr;
  MujocoOutcome outcome = call_mujoco([&] {
    parsed = mj_parseXMLString(mjcf.c_str(), nullptr, error, kErrorSize);
    if (parsed != nullptr) compiled = mj_compile(parsed, nullptr);
  });
  const MjSpecPtr spec(parsed);
  LoadedModel loaded;
  loaded.model.reset(compiled);
  if (loaded.model) {
    loaded.warnings = std::move(outcome.warnings);
    return loaded;
  }
  if (!outcome.failed) outcome.error = parsed != nullptr ? mjs_getError(parsed) : error;
  return fail(Errc::bad_input, text(msg::model_refused, text(msg::model_in_memory), outcome.error));
}

}  // namespace mjarm
