#include <mujoco/mujoco.h>

#include <utility>

#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/mujoco_guard.hpp"
#include "mjarm/model/spec_origin_internal.hpp"
#include "mjarm/model/stand_ins_internal.hpp"

namespace mjarm {
namespace {

constexpr int kSpecErrorSize = 1024;

}  // namespace

SpecOrigin::SpecOrigin(const Model& model, bool allow_outside)
    : model_(model), files_(model.file(), allow_outside || is_shipped(model.file())) {}

void SpecOrigin::finish(mjSpec* spec) const {
  if (model_.urdf_text().empty()) return;
  BodyPairs apart;
  const mjModel* m = model_.raw();
  for (int e = 0; e < m->nexclude; ++e) {  // ids of both bodies in one number
    const int pair = m->exclude_signature[e];
    apart.emplace_back(object_name(m, mjOBJ_BODY, pair >> 16),
                       object_name(m, mjOBJ_BODY, pair & 0xffff));
  }
  finish_urdf(spec, apart);
}

MjSpecPtr SpecOrigin::parse(std::string& error) const {
  char words[kSpecErrorSize] = "";
  mjSpec* parsed = nullptr;
  const std::string& urdf = model_.urdf_text();
  StandIns stand_ins;
  const MujocoOutcome outcome = call_mujoco([&] {
    stand_ins.add(files_);
    parsed = urdf.empty() ? mj_parseXML(model_.file().string().c_str(), stand_ins.get(), words,
                                        kSpecErrorSize)
                          : mj_parseXMLString(urdf.c_str(), nullptr, words, kSpecErrorSize);
  });
  MjSpecPtr spec(parsed);
  if (outcome.failed || spec == nullptr) {
    error = outcome.failed ? outcome.error : words;
    return nullptr;
  }
  finish(spec.get());
  return spec;
}

Result<LoadedModel> SpecOrigin::compile(const std::function<void(mjSpec*)>& prepare) const {
  if (files_.documents().empty()) return fail(*files_.fault());
  const std::string& urdf = model_.urdf_text();
  const auto both = [&](mjSpec* spec) {
    finish(spec);
    prepare(spec);
  };
  return compile_spec({.files = files_,
                       .text = urdf.empty() ? nullptr : &urdf,
                       .trusted = is_shipped(model_.file()),
                       .prepare = both,
                       .looks = true});
}

}  // namespace mjarm
