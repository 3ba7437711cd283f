#include <algorithm>
#include <cmath>
#include <optional>

#include "mjarm/core/messages/model.hpp"
#include "mjarm/model/complaint_internal.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/mujoco_guard.hpp"

namespace mjarm {
namespace fs = std::filesystem;
namespace {

/// Most scratch memory that a file may ask for by `<size memory>` [bytes].
constexpr mjtSize kMostMemory = mjtSize{1} << 36;

/// Numbers without which nothing can be computed, by the kind of object they belong to.
struct Numbers {
  mjtObj type;
  const char* field;
  const mjtNum* values;
  mjtSize objects;
  int each;
};

/// The first number in `model` that is NaN or infinite, told as `OBJECT "NAME": FIELD`; empty where
/// all is well. MuJoCo only warns of NaN.
std::string first_bad_number(const mjModel* m) {
  const Numbers all[] = {
      {mjOBJ_BODY, "pos", m->body_pos, m->nbody, 3},
      {mjOBJ_BODY, "quat", m->body_quat, m->nbody, 4},
      {mjOBJ_BODY, "mass", m->body_mass, m->nbody, 1},
      {mjOBJ_BODY, "inertia", m->body_inertia, m->nbody, 3},
      {mjOBJ_BODY, "inertial pos", m->body_ipos, m->nbody, 3},
      {mjOBJ_JOINT, "pos", m->jnt_pos, m->njnt, 3},
      {mjOBJ_JOINT, "axis", m->jnt_axis, m->njnt, 3},
      {mjOBJ_JOINT, "range", m->jnt_range, m->njnt, 2},
      {mjOBJ_SITE, "pos", m->site_pos, m->nsite, 3},
      {mjOBJ_SITE, "quat", m->site_quat, m->nsite, 4},
      {mjOBJ_GEOM, "pos", m->geom_pos, m->ngeom, 3},
      {mjOBJ_GEOM, "quat", m->geom_quat, m->ngeom, 4},
      {mjOBJ_GEOM, "size", m->geom_size, m->ngeom, 3},
      {mjOBJ_ACTUATOR, "gainprm", m->actuator_gainprm, m->nactuator, mjNGAIN},
      {mjOBJ_ACTUATOR, "biasprm", m->actuator_biasprm, m->nactuator, mjNBIAS},
  };
  for (const Numbers& numbers : all) {
    for (mjtSize i = 0; i < numbers.objects * numbers.each; ++i) {
      if (std::isfinite(numbers.values[i])) continue;
      const char* name = mj_id2name(m, numbers.type, static_cast<int>(i / numbers.each));
      return std::string(mju_type2Str(numbers.type)) + " \"" + (name != nullptr ? name : "") +
             "\": " + numbers.field;
    }
  }
  return "";
}

/// What MuJoCo lets pass, but no one can compute with.
Result<void> check_numbers(const fs::path& file, const mjModel* m) {
  if (const std::string bad = first_bad_number(m); !bad.empty()) {
    if (std::optional<Error> nan = nan_error(file)) return fail(std::move(*nan));
    return fail(Errc::bad_input, text(msg::model_not_finite, file.string(), bad));
  }
  if (!(m->opt.timestep > 0) || !std::isfinite(m->opt.timestep)) {
    return fail(Errc::bad_input, text(msg::model_bad_timestep, file.string(), m->opt.timestep));
  }
  return {};
}

/// Makes and drops the scratch memory of `model`, to find out here whether it can be had.
std::optional<std::string> memory_fault(const mjModel* model) {
  const MujocoOutcome outcome = call_mujoco([&] { mj_deleteData(mj_makeData(model)); });
  if (!outcome.failed) return std::nullopt;
  return outcome.error;
}

}  // namespace

Result<LoadedModel> compile_spec(const SpecSource& source,
                                 const std::function<void(mjSpec*)>& prepare) {
  constexpr int kErrorSize = 2048;
  char error[kErrorSize] = "";
  mjSpec* parsed = nullptr;
  const std::string file = source.file.string();
  const auto refusal = [&](std::string_view words) {
    return complaint_error(source.file, words, source.text == nullptr);
  };
  MujocoOutcome outcome = call_mujoco([&] {
    parsed = source.text != nullptr
                 ? mj_parseXMLString(source.text->c_str(), nullptr, error, kErrorSize)
                 : mj_parseXML(file.c_str(), nullptr, error, kErrorSize);
  });
  const MjSpecPtr spec(parsed);
  if (outcome.failed) return fail(refusal(outcome.error));
  if (spec == nullptr) return fail(refusal(error));
  LoadedModel loaded;
  loaded.warnings = std::move(outcome.warnings);
  // More memory than any machine has is a slip of the pen; asking for it could end the process.
  if (spec->memory > kMostMemory) return fail(refusal("Could not allocate memory"));
  if (prepare) prepare(spec.get());

  mjModel* compiled = nullptr;
  outcome = call_mujoco([&] { compiled = mj_compile(spec.get(), nullptr); });
  loaded.model.reset(compiled);
  if (outcome.failed || compiled == nullptr) {
    // MuJoCo only warns of NaN while it reads; what it says later about its effects helps nobody.
    const auto has_nan = [](const std::string& warning) {
      return warning.find("NaN") != std::string::npos;
    };
    if (std::any_of(loaded.warnings.begin(), loaded.warnings.end(), has_nan)) {
      if (std::optional<Error> nan = nan_error(source.file)) return fail(std::move(*nan));
    }
    return fail(refusal(outcome.failed ? outcome.error : mjs_getError(spec.get())));
  }
  for (std::string& warning : outcome.warnings) loaded.warnings.push_back(std::move(warning));
  for (int i = 0; i < mjs_numWarnings(spec.get()); ++i) {
    loaded.warnings.emplace_back(mjs_getWarning(spec.get(), i));
  }
  if (auto done = check_numbers(source.file, compiled); !done) return fail(done.error());
  if (const std::optional<std::string> fault = memory_fault(compiled)) {
    return fail(refusal(*fault));
  }
  return loaded;
}

}  // namespace mjarm
