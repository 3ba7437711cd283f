#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "mjarm/control/controller.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/model.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::testing {

/// A model with its arm; fails the test where either cannot be had.
struct Loaded {
  Model model;
  Arm arm;
};

inline Loaded load_file(const std::filesystem::path& file, const std::string& tip = {}) {
  auto model = Model::load(file);
  if (!model) throw std::runtime_error(model.error().what);
  auto arm = find_arm(*model, {.tip = tip});
  if (!arm) throw std::runtime_error(arm.error().what);
  return {std::move(*model), std::move(*arm)};
}

inline Loaded load_shipped(const std::string& name) {
  const auto file = find_model_file(name);
  if (!file) throw std::runtime_error(file.error().what);
  return load_file(*file);
}

inline Loaded load_text(const std::string& mjcf) {
  const support::TempFolder folder;
  return load_file(folder.write("arm.xml", mjcf), "tool");
}

inline Controller controller_of(const Loaded& robot, ControlMode mode) {
  auto controller = Controller::make(robot.model, robot.arm, mode);
  if (!controller) throw std::runtime_error(controller.error().what);
  return std::move(*controller);
}

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
