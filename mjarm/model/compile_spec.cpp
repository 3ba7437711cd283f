#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "mjarm/core/messages/guard.hpp"
#include "mjarm/core/messages/model.hpp"
#include "mjarm/model/complaint_internal.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/mujoco_guard.hpp"
#include "mjarm/model/stand_ins_internal.hpp"

namespace mjarm {
namespace {

/// Most scratch memory that a file may ask for by `<size memory>` [bytes].
constexpr mjtSize kMaxMemory = mjtSize{1} << 30;

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
Result<void> check_numbers(const std::string& file, const mjModel* m) {
  if (const std::string bad = first_bad_number(m); !bad.empty()) {
    return fail(Errc::bad_input, text(msg::model_not_finite, file, bad));
  }
  if (!(m->opt.timestep > 0) || !std::isfinite(m->opt.timestep)) {
    return fail(Errc::bad_input, text(msg::model_bad_timestep, file, m->opt.timestep));
  }
  return {};
}

/// How many values the keyframes of a description give, before MuJoCo fills up what is missing.
struct KeySizes {
  const char* name;
  std::array<int, 3> sizes;  ///< of qpos, qvel, ctrl
};

std::vector<KeySizes> key_sizes(mjSpec* spec) {
  std::vector<KeySizes> keys;
  for (mjsElement* e = mjs_firstElement(spec, mjOBJ_KEY); e; e = mjs_nextElement(spec, e)) {
    const mjsKey* key = mjs_asKey(e);
    KeySizes sizes{mjs_getString(mjs_getName(e)), {}};
    mjs_getDouble(key->qpos, &sizes.sizes[0]);
    mjs_getDouble(key->qvel, &sizes.sizes[1]);
    mjs_getDouble(key->ctrl, &sizes.sizes[2]);
    keys.push_back(sizes);
  }
  return keys;
}

std::string file_name(const char* path) { return std::filesystem::path(path).filename().string(); }

/// Files of the meshes that decide about masses or contacts. Of geoms that are only looked at
/// MuJoCo reads none, where looks are left out and their body has a mass of its own.
std::vector<std::string> mesh_files(mjSpec* spec) {
  std::vector<std::string> files;
  for (mjsElement* b = mjs_firstElement(spec, mjOBJ_BODY); b; b = mjs_nextElement(spec, b)) {
    const mjsBody* const body = mjs_asBody(b);
    const bool has_mass =
        body->explicitinertial != 0 && spec->compiler.inertiafromgeom != mjINERTIAFROMGEOM_TRUE;
    for (mjsElement* g = mjs_firstChild(body, mjOBJ_GEOM, 0); g; g = mjs_nextChild(body, g, 0)) {
      const mjsGeom* const geom = mjs_asGeom(g);
      const bool is_looks = geom->contype == 0 && geom->conaffinity == 0;
      if (has_mass && is_looks && spec->compiler.discardvisual != 0) continue;
      mjsElement* const mesh = mjs_findElement(spec, mjOBJ_MESH, mjs_getString(geom->meshname));
      if (mesh != nullptr) files.push_back(file_name(mjs_getString(mjs_asMesh(mesh)->file)));
    }
  }
  return files;
}

/// Files of what a compiled model still has.
void add_kept_files(const mjModel* m, std::vector<std::string>& files) {
  const auto add = [&](const int* paths, mjtSize count) {
    for (mjtSize i = 0; i < count; ++i) {
      if (paths[i] >= 0) files.push_back(file_name(m->paths + paths[i]));
    }
  };
  add(m->mesh_pathadr, m->nmesh);
  add(m->tex_pathadr, m->ntex);
}

/// Too many values are an error. Too few are what a scene has that adds bodies to a robot with
/// keyframes: MuJoCo takes the others from the initial state, and a line in `warnings` says so.
Result<void> check_keys(const std::string& file, const std::vector<KeySizes>& keys,
                        const mjModel* m, std::vector<std::string>& warnings) {
  constexpr std::array<const char*, 3> kFields = {"qpos", "qvel", "ctrl"};
  const std::array<mjtSize, 3> needed = {m->nq, m->nv, m->nu};
  for (const KeySizes& key : keys) {
    for (std::size_t i = 0; i < kFields.size(); ++i) {
      if (key.sizes[i] == 0 || key.sizes[i] == needed[i]) continue;
      std::string line =
          text(msg::guard_keyframe, file, key.name, kFields[i], key.sizes[i], needed[i]);
      if (key.sizes[i] > needed[i]) return fail(Errc::bad_input, std::move(line));
      warnings.push_back(std::move(line));
    }
  }
  return {};
}

/// Simulates one step and drops it, to find out here whether there is memory for it, and whether
/// MuJoCo can compute with the model at all.
Result<void> check_step(const std::string& file, const mjModel* model, std::string& fault) {
  mjData* data = nullptr;
  MujocoOutcome outcome = call_mujoco([&] { data = mj_makeData(model); });
  if (outcome.failed || data == nullptr) {
    fault = outcome.failed ? outcome.error : "Could not allocate memory";
    return {};
  }
  outcome = call_mujoco([&] { mj_step(model, data); });
  // After an error inside a step, scratch memory may be in any state; it is given up, not freed.
  if (!outcome.failed) outcome = call_mujoco([&] { mj_deleteData(data); });
  if (!outcome.failed) return {};
  return fail(Errc::bad_input,
              text(msg::model_refused, file, text(msg::guard_first_step, outcome.error)));
}

/// One description on its way to a model.
class Compiler {
 public:
  Compiler(const SpecSource& source, const std::function<void(Stage)>& enter)
      : source_(source), enter_(enter) {}

  Result<LoadedModel> run() {
    if (auto done = parse(); !done) return fail(done.error());
    // More memory than any machine has is a slip of the pen; asking for it could end the process.
    if (spec_->memory > kMaxMemory) return fail(refusal("Could not allocate memory"));
    if (source_.prepare) source_.prepare(spec_.get());
    if (!source_.looks) spec_->compiler.discardvisual = 1;
    const std::vector<KeySizes> keys = key_sizes(spec_.get());
    loaded_.read_files = mesh_files(spec_.get());
    if (auto done = compile(); !done) return fail(done.error());
    const mjModel* model = loaded_.model.get();
    add_kept_files(model, loaded_.read_files);
    if (auto done = check_numbers(source_.name(), model); !done) return fail(done.error());
    if (auto done = check_keys(source_.name(), keys, model, loaded_.warnings); !done) {
      return fail(done.error());
    }
    enter(Stage::stepping);
    std::string fault;
    if (auto done = check_step(source_.name(), model, fault); !done) return fail(done.error());
    if (!fault.empty()) return fail(refusal(fault));
    return std::move(loaded_);
  }

 private:
  void enter(Stage stage) const {
    if (enter_) enter_(stage);
  }

  [[nodiscard]] Error refusal(std::string_view words) const {
    return complaint_error(source_.files, words, source_.text == nullptr);
  }

  Result<void> parse() {
    enter(Stage::reading);
    constexpr int kErrorSize = 2048;
    char error[kErrorSize] = "";
    mjSpec* parsed = nullptr;
    StandIns stand_ins;
    MujocoOutcome outcome = call_mujoco([&] {
      stand_ins.add(source_.files);
      parsed = source_.text != nullptr
                   ? mj_parseXMLString(source_.text->c_str(), nullptr, error, kErrorSize)
                   : mj_parseXML(source_.name().c_str(), stand_ins.get(), error, kErrorSize);
    });
    spec_.reset(parsed);
    if (outcome.failed) return fail(refusal(outcome.error));
    if (spec_ == nullptr) return fail(refusal(error));
    loaded_.warnings = std::move(outcome.warnings);
    return {};
  }

  Result<void> compile() {
    enter(Stage::compiling);
#if defined(__SANITIZE_THREAD__)
    spec_->compiler.usethread = 0;  // this sanitizer knows no threads in a copy of a process
#endif
    mjModel* compiled = nullptr;
    MujocoOutcome outcome = call_mujoco([&] { compiled = mj_compile(spec_.get(), nullptr); });
    loaded_.model.reset(compiled);
    if (outcome.failed || compiled == nullptr) {
      return fail(refusal(outcome.failed ? outcome.error : mjs_getError(spec_.get())));
    }
    for (std::string& warning : outcome.warnings) loaded_.warnings.push_back(std::move(warning));
    for (int i = 0; i < mjs_numWarnings(spec_.get()); ++i) {
      loaded_.warnings.emplace_back(mjs_getWarning(spec_.get(), i));
    }
    return {};
  }

  const SpecSource& source_;
  const std::function<void(Stage)>& enter_;
  MjSpecPtr spec_;
  LoadedModel loaded_;
};

}  // namespace

Result<LoadedModel> compile_here(const SpecSource& source,
                                 const std::function<void(Stage)>& enter) {
  return Compiler(source, enter).run();
}

}  // namespace mjarm
