#pragma once

#include <string>

#include "mjarm/control/robots_test.hpp"

namespace mjarm::testing {

/// Two links above a floor with a box lying on it; `more` goes into the worldbody.
/// @param option  attributes of <option>.
/// @param kp      [N m/rad] of both servos.
inline std::string small_world(const std::string& option = "integrator=\"implicitfast\"",
                               const std::string& kp = "400", const std::string& more = "") {
  return R"(<mujoco model="small">
  <compiler angle="radian" autolimits="true"/>
  <option )" +
         option + R"(/>
  <worldbody>
    <geom name="floor" type="plane" size="2 2 0.1"/>
    <body name="box" pos="0 1 0.0999">
      <freejoint name="box_free"/>
      <geom name="box" type="box" size="0.1 0.1 0.1" mass="1"/>
    </body>
    <body name="upper" pos="0 0 0.6">
      <joint name="shoulder" axis="0 1 0" range="-3 3" damping="0.5" armature="0.01"/>
      <geom name="upper" type="capsule" fromto="0.05 0 0 0.3 0 0" size="0.03" mass="2"/>
      <body name="lower" pos="0.4 0 0">
        <joint name="elbow" axis="0 1 0" range="-3 3" damping="0.2" armature="0.01"/>
        <geom type="capsule" fromto="0.05 0 0 0.3 0 0" size="0.03" mass="1"/>
        <site name="tool" pos="0.35 0 0"/>
      </body>
    </body>
    )" + more +
         R"(
  </worldbody>
  <actuator>
    <position name="shoulder" joint="shoulder" kp=")" +
         kp + R"(" kv="30" forcerange="-60 60"/>
    <position name="elbow" joint="elbow" kp=")" +
         kp + R"(" kv="15" forcerange="-60 60"/>
  </actuator>
  <sensor><framepos name="tool" objtype="site" objname="tool"/></sensor>
  <keyframe><key name="home" qpos="0 1 0.0999 1 0 0 0 -0.5 1" ctrl="-0.5 1"/></keyframe>
</mujoco>)";
}

}  // namespace mjarm::testing
