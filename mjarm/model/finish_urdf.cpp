#include <set>

#include "mjarm/model/load_internal.hpp"

namespace mjarm {
namespace {

/// Sorts geoms into the groups of MuJoCo's viewers: what is seen into 2 (shown), what touches into
/// 3 (hidden), or 2 where a link has no other look.
void sort_groups(mjSpec* spec) {
  std::set<const mjsBody*> has_look;
  for (int pass = 0; pass < 2; ++pass) {
    for (mjsElement* e = mjs_firstElement(spec, mjOBJ_GEOM); e; e = mjs_nextElement(spec, e)) {
      mjsGeom* geom = mjs_asGeom(e);
      const bool look = geom->contype == 0 && geom->conaffinity == 0;
      const mjsBody* body = mjs_getParent(e);
      if (pass == 0 && look) has_look.insert(body);
      if (pass == 1) geom->group = look || has_look.count(body) == 0 ? 2 : 3;
    }
  }
}

/// A URDF has no lights and no sky: without them a picture of it is black.
void add_light(mjSpec* spec) {
  for (float& part : spec->visual.headlight.ambient) part = 0.35F;
  for (float& part : spec->visual.headlight.diffuse) part = 0.55F;
  mjsTexture* sky = mjs_addTexture(spec, nullptr);
  mjs_setName(sky->element, "sky");
  sky->type = mjTEXTURE_SKYBOX;
  sky->builtin = mjBUILTIN_GRADIENT;
  for (int i = 0; i < 3; ++i) {
    sky->rgb1[i] = 0.95;
    sky->rgb2[i] = 0.65;
  }
  sky->width = 64;
  sky->height = 64;
}

void add_motors(mjSpec* spec) {
  for (mjsElement* e = mjs_firstElement(spec, mjOBJ_JOINT); e; e = mjs_nextElement(spec, e)) {
    const mjsJoint* joint = mjs_asJoint(e);
    if (joint->type != mjJNT_HINGE && joint->type != mjJNT_SLIDE) continue;
    const char* name = mjs_getString(mjs_getName(e));
    mjsActuator* motor = mjs_addActuator(spec, nullptr);
    mjs_setName(motor->element, name);
    mjs_setToMotor(motor);
    motor->trntype = mjTRN_JOINT;
    mjs_setString(motor->target, name);
  }
}

}  // namespace

void finish_urdf(mjSpec* spec, const BodyPairs& apart) {
  sort_groups(spec);
  add_light(spec);
  add_motors(spec);
  for (const auto& [first, second] : apart) {
    mjsExclude* exclude = mjs_addExclude(spec);
    mjs_setString(exclude->bodyname1, first.c_str());
    mjs_setString(exclude->bodyname2, second.c_str());
  }
}

}  // namespace mjarm
