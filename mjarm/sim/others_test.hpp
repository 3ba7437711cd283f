#pragma once

#include <string>

namespace mjarm::testing {

/// A robot on a free base, which is 4 mm deep in a block under one side of it, with more than its
/// arm, and a scene round it. The arm is `shoulder`, `elbow`; its gripper `grip`, `grip_too`.
/// Beside it the base carries a mast with a servo, a wheel with a velocity drive, a tray that
/// nothing drives, a second arm with a motor, and two flaps that are coupled; a chain hangs on the
/// tool. In the scene: a crane with a motor of its own, a door without one, a cup that falls.
inline std::string robot_with_others() {
  return R"(<mujoco model="others">
  <compiler angle="radian" autolimits="true"/>
  <option integrator="implicitfast"/>
  <default><geom contype="0" conaffinity="0" density="500"/></default>
  <worldbody>
    <geom name="block" type="box" size="0.1 0.1 0.1" pos="0.28 0 0.804" contype="1" conaffinity="1"/>
    <body name="cup" pos="2 0 1"><freejoint name="cup_free"/><geom size="0.05"/></body>
    <body name="cabinet" pos="0 2 0">
      <body name="door"><joint name="door" axis="1 0 0"/><geom size="0.02 0.3" pos="0 0 0.3" type="capsule"/></body>
    </body>
    <body name="crane" pos="0 -2 1">
      <joint name="crane" axis="0 1 0"/><geom type="capsule" size="0.03" fromto="0 0 0 0.5 0 0"/>
    </body>
    <body name="base" pos="0 0 1">
      <freejoint name="base_free"/>
      <geom type="box" size="0.2 0.2 0.1" contype="1" conaffinity="1"/>
      <body name="wheel" pos="0 0.3 0">
        <joint name="wheel" axis="0 1 0"/><geom size="0.05" pos="0.02 0 0"/>
      </body>
      <body name="tray" pos="-0.3 0 0">
        <joint name="tray" axis="0 1 0"/><geom type="box" size="0.1 0.1 0.01" pos="-0.1 0 0"/>
      </body>
      <body name="flap" pos="0 0 -0.2">
        <joint name="flap" axis="0 1 0" damping="0.1"/><geom size="0.02" pos="0.1 0 0"/>
      </body>
      <body name="flap_too" pos="0 0.1 -0.2">
        <joint name="flap_too" axis="0 1 0" damping="0.1"/><geom size="0.02" pos="0.1 0 0"/>
      </body>
      <body name="mast" pos="0 0 0.1">
        <joint name="mast" axis="0 1 0" damping="0.5" armature="0.1"/>
        <geom type="capsule" size="0.04" fromto="0 0 0 0 0 0.4"/>
        <body name="second" pos="0 -0.2 0.4">
          <joint name="second" axis="0 1 0"/><geom type="capsule" size="0.03" fromto="0 0 0 0.4 0 0"/>
        </body>
        <body name="upper" pos="0 0.2 0.4">
          <joint name="shoulder" axis="0 1 0" damping="1" armature="0.01" range="-3 3"/>
          <geom type="capsule" size="0.03" fromto="0 0 0 0.4 0 0"/>
          <body name="lower" pos="0.4 0 0">
            <joint name="elbow" axis="0 1 0" damping="1" armature="0.01" range="-3 3"/>
            <geom type="capsule" size="0.03" fromto="0 0 0 0.3 0 0"/>
            <site name="tool" pos="0.35 0 0"/>
            <body name="chain" pos="0.35 0 0">
              <joint name="chain" axis="0 1 0" damping="0.01"/><geom size="0.01" pos="0 0 -0.1"/>
            </body>
            <body name="grip" pos="0.3 0.02 0">
              <joint name="grip" type="slide" axis="0 1 0" range="0 0.04"/><geom size="0.01"/>
            </body>
            <body name="grip_too" pos="0.3 -0.02 0">
              <joint name="grip_too" type="slide" axis="0 -1 0" range="0 0.04"/><geom size="0.01"/>
            </body>
          </body>
        </body>
      </body>
    </body>
  </worldbody>
  <equality>
    <joint joint1="flap" joint2="flap_too"/>
    <joint joint1="grip" joint2="grip_too"/>
  </equality>
  <actuator>
    <position name="shoulder" joint="shoulder" kp="400" kv="30"/>
    <position name="elbow" joint="elbow" kp="400" kv="15"/>
    <position name="grip" joint="grip" kp="100" kv="5" ctrlrange="0 0.04"/>
    <position name="mast" joint="mast" kp="2000" kv="200"/>
    <velocity name="wheel" joint="wheel" kv="2"/>
    <motor name="second" joint="second"/>
    <motor name="crane" joint="crane"/>
  </actuator>
</mujoco>)";
}

}  // namespace mjarm::testing
