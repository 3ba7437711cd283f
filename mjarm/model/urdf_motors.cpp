#include "mjarm/model/load_internal.hpp"

namespace mjarm {

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

}  // namespace mjarm
