#pragma once

#include <string>

#include "tests/support/temp_folder.hpp"

namespace mjarm::app {

/// An arm that mjarm does not ship: two hinges and a slide that hangs down, tool `tip`.
inline constexpr const char* kCrane = R"(<mujoco model="crane">
  <compiler angle="radian"/>
  <option timestep="0.002"/>
  <worldbody>
    <geom name="floor" type="plane" size="2 2 0.1"/>
    <body name="post" pos="0 0 0.4">
      <joint name="turn" axis="0 0 1" range="-2.5 2.5" damping="1"/>
      <geom name="post" type="capsule" fromto="0 0 0 0.3 0 0" size="0.03" mass="2"/>
      <body name="boom" pos="0.3 0 0">
        <joint name="fold" axis="0 0 1" range="-2.2 2.2" damping="1"/>
        <geom name="boom" type="capsule" fromto="0.06 0 0 0.25 0 0" size="0.025" mass="1"/>
        <body name="lift" pos="0.25 0 0">
          <joint name="lift" type="slide" axis="0 0 1" range="-0.2 0.15" damping="1"/>
          <geom name="lift" type="capsule" fromto="0 0 0.05 0 0 -0.1" size="0.02" mass="0.5"/>
          <site name="tip" pos="0 0 -0.12"/>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator>
    <position name="turn" joint="turn" kp="400" forcerange="-80 80" ctrlrange="-2.5 2.5"/>
    <position name="fold" joint="fold" kp="400" forcerange="-80 80" ctrlrange="-2.2 2.2"/>
    <position name="lift" joint="lift" kp="2000" forcerange="-100 100" ctrlrange="-0.2 0.15"/>
  </actuator>
  <keyframe><key name="home" qpos="0.4 0.8 0" ctrl="0.4 0.8 0"/></keyframe>
</mujoco>
)";

/// Writes the crane where a user in China may have it: a folder with a blank and Chinese names.
inline std::string write_crane(const support::TempFolder& folder) {
  return folder.write("我的 模型/起重机.xml", kCrane).string();
}

}  // namespace mjarm::app
