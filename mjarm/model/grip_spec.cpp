#include <algorithm>
#include <string>
#include <vector>

#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/grip_mend_internal.hpp"

namespace mjarm::detail {
namespace {

/// Bodies, geoms and joints of a description in the order in which MuJoCo numbers them.
class SpecNumbers {
 public:
  explicit SpecNumbers(const mjSpec& spec) { walk(mjs_findBody(&spec, "world")); }

  [[nodiscard]] bool fits(const mjModel& m) const {
    const auto same = [&](const std::vector<mjsElement*>& elements, mjtObj type, mjtSize count) {
      if (elements.size() != static_cast<std::size_t>(count)) return false;
      for (int i = 0; i < static_cast<int>(count); ++i) {
        const std::string name = mjs_getString(mjs_getName(elements[static_cast<std::size_t>(i)]));
        const char* const known = mj_id2name(&m, type, i);
        if (name != (known != nullptr ? known : "")) return false;
      }
      return true;
    };
    return same(bodies_, mjOBJ_BODY, m.nbody) && same(geoms_, mjOBJ_GEOM, m.ngeom) &&
           same(joints_, mjOBJ_JOINT, m.njnt);
  }
  [[nodiscard]] mjsGeom* geom(int id) const {
    return mjs_asGeom(geoms_[static_cast<std::size_t>(id)]);
  }
  [[nodiscard]] mjsJoint* joint(int id) const {
    return mjs_asJoint(joints_[static_cast<std::size_t>(id)]);
  }
  [[nodiscard]] std::string body_name(int id) const {
    return mjs_getString(mjs_getName(bodies_[static_cast<std::size_t>(id)]));
  }

 private:
  void walk(mjsBody* body) {
    bodies_.push_back(body->element);
    add(body, mjOBJ_GEOM, geoms_);
    add(body, mjOBJ_JOINT, joints_);
    std::vector<mjsElement*> children;
    add(body, mjOBJ_BODY, children);
    for (mjsElement* child : children) walk(mjs_asBody(child));
  }
  static void add(const mjsBody* body, mjtObj type, std::vector<mjsElement*>& out) {
    for (mjsElement* e = mjs_firstChild(body, type, 0); e; e = mjs_nextChild(body, e, 0)) {
      out.push_back(e);
    }
  }

  std::vector<mjsElement*> bodies_, geoms_, joints_;
};

}  // namespace

bool apply(const GripMend& mend, const mjModel& m, mjSpec& spec) {
  const SpecNumbers numbers(spec);
  if (!numbers.fits(m)) return false;
  if (mend.elliptic) spec.option.cone = mjCONE_ELLIPTIC;
  if (mend.impratio) spec.option.impratio = kMendedImpratio;
  for (const int g : mend.pads) {
    mjsGeom& geom = *numbers.geom(g);
    mend_pad(mend, {geom.condim, geom.priority, geom.friction, geom.solref, geom.solimp});
  }
  for (const auto& [joint, value] : mend.armature) numbers.joint(joint)->armature = value;
  for (const auto& [joint, value] : mend.damping) numbers.joint(joint)->damping[0] = value;
  for (const auto& [one, other] : mend.exclude) {
    mjsExclude* const exclude = mjs_addExclude(&spec);
    mjs_setString(exclude->bodyname1, numbers.body_name(one).c_str());
    mjs_setString(exclude->bodyname2, numbers.body_name(other).c_str());
  }
  return true;
}

}  // namespace mjarm::detail
