#include <algorithm>
#include <string>

#include "mjarm/model/grip_trial_internal.hpp"
#include "mjarm/model/spec_origin_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kLargestCube = 0.06;  // [m]

/// A name that nothing of this kind has.
std::string free_name(const mjSpec* spec, mjtObj type, std::string name) {
  while (mjs_findElement(spec, type, name.c_str()) != nullptr) name += '_';
  return name;
}

void add_cube(mjSpec* spec, double edge) {
  mjsBody* const body = mjs_addBody(mjs_findBody(spec, "world"), nullptr);
  mjs_setName(body->element, free_name(spec, mjOBJ_BODY, "trial_cube").c_str());
  mjs_addFreeJoint(body);
  mjsGeom* const geom = mjs_addGeom(body, nullptr);
  geom->type = mjGEOM_BOX;
  std::fill_n(geom->size, 3, edge / 2);
  geom->mass = kTrialMass;
  geom->contype = geom->conaffinity = 1;  // not a look, which may be left out
}

}  // namespace

double trial_edge(const Jaws& jaws) { return std::min(jaws.opening / 2, kLargestCube); }

Result<MjModelPtr> with_trial_cube(const Model& model, double edge, const LoadOptions& options) {
  const SpecOrigin origin(model, options.allow_outside);
  Result<LoadedModel> loaded = origin.compile([edge](mjSpec* spec) { add_cube(spec, edge); });
  if (!loaded) return fail(std::move(loaded.error()));
  return std::move(loaded->model);
}

}  // namespace mjarm::detail
