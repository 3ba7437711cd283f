#include "mjarm/model/scene_bodies.hpp"

#include <algorithm>

#include "mjarm/model/arm_parts_internal.hpp"

namespace mjarm {

SceneBodies scene_bodies(const Model& model, const Arm& arm) {
  const mjModel& m = *model.raw();
  const auto count = static_cast<std::size_t>(m.nbody);
  SceneBodies out{.name = std::vector<std::string>(count),
                  .role = std::vector<BodyRole>(count, BodyRole::scene),
                  .object_of = std::vector<int>(count, -1),
                  .moved_by = std::vector<int>(count, 0),
                  .objects = {}};
  const int last = m.dof_bodyid[arm.joints.back().dof];
  for (const ArmJoint& joint : arm.joints) {
    const auto body = static_cast<std::size_t>(m.dof_bodyid[joint.dof]);
    out.role[body] = BodyRole::link;
    ++out.moved_by[body];
  }
  const int root = m.body_rootid[last];
  for (int b = 0; b < static_cast<int>(m.nbody); ++b) {
    out.name[static_cast<std::size_t>(b)] = object_name(&m, mjOBJ_BODY, b);
  }
  for (int b = 1; b < static_cast<int>(m.nbody); ++b) {  // parents come before their children
    const auto i = static_cast<std::size_t>(b);
    const auto parent = static_cast<std::size_t>(m.body_parentid[b]);
    const int joint = m.body_jntadr[b];
    out.moved_by[i] += out.moved_by[parent];
    if (joint >= 0 && m.jnt_type[joint] == mjJNT_FREE && b != root) {
      out.object_of[i] = static_cast<int>(out.objects.size());
      out.objects.push_back({object_name(&m, mjOBJ_BODY, b), b, m.jnt_qposadr[joint]});
    } else {
      out.object_of[i] = out.object_of[parent];
    }
    if (out.object_of[i] >= 0) {
      out.role[i] = BodyRole::object;
    } else if (out.role[i] == BodyRole::scene) {
      const bool beyond = m.body_parentid[b] == last || out.role[parent] == BodyRole::hand;
      if (beyond) {
        out.role[i] = BodyRole::hand;
      } else if (out.role[parent] == BodyRole::link) {
        out.role[i] = BodyRole::link;
      }
    }
  }
  return out;
}

}  // namespace mjarm
