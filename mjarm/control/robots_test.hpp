#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

#include "mjarm/control/controller.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/model.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::testing {

/// A model with its arm.
struct Loaded {
  Model model;
  Arm arm;
};

/// These throw where a model, an arm or a controller cannot be had; the test fails by it.
inline Loaded load_file(const std::filesystem::path& file, const std::string& tip = {}) {
  auto model = Model::load(file);
  if (!model) throw std::runtime_error(model.error().what);
  auto arm = find_arm(*model, {.tip = tip});
  if (!arm) throw std::runtime_error(arm.error().what);
  return {std::move(*model), std::move(*arm)};
}

inline Loaded load_text(const std::string& mjcf) {
  const support::TempFolder folder;
  return load_file(folder.write("arm.xml", mjcf), "tool");
}

inline Loaded load_shipped(const std::string& name) {
  const auto file = find_model_file(name);
  if (!file) throw std::runtime_error(file.error().what);
  return load_file(*file);
}

inline Controller controller_of(const Loaded& robot, ControlMode mode,
                                const ControlOptions& options = {}) {
  auto controller = Controller::create(robot.model, robot.arm, mode, options);
  if (!controller) throw std::runtime_error(controller.error().what);
  return std::move(*controller);
}

/// Three joints of different kind whose actuators differ in every way a joint drive can: a geared
/// position servo, a slide with a servo of odd bias and its own damping, a torque motor turned
/// backwards. A free ball flies beside it, so that the arm's rows are not the first ones.
/// @param option  attributes of <option>, @param flag attributes of <flag>.
inline std::string odd_arm(const std::string& option, const std::string& flag = "") {
  return R"(<mujoco model="odd">
  <compiler angle="radian" autolimits="true"/>
  <option timestep="0.002" )" +
         option + "><flag " + flag + R"(/></option>
  <worldbody>
    <body name="ball" pos="2 0 3"><freejoint name="ball_free"/><geom size="0.05" mass="1"/></body>
    <body name="one" pos="0 0 1">
      <joint name="first" axis="0 1 0.3" damping="2" armature="0.1" range="-3 3"/>
      <geom type="capsule" fromto="0 0 0 0.4 0 0" size="0.04" mass="3"/>
      <body name="two" pos="0.4 0 0">
        <joint name="second" type="slide" axis="1 0 0" stiffness="30" springref="0.1" range="-1 1"/>
        <geom type="box" pos="0.1 0 0" size="0.1 0.04 0.03" mass="1.5"/>
        <body name="three" pos="0.3 0 0">
          <joint name="third" axis="0 0.2 1" damping="0.05" armature="0.02" range="-3 3"/>
          <geom type="capsule" fromto="0 0 0 0.3 0 0.1" size="0.03" mass="1"/>
          <site name="tool" pos="0.3 0 0.1"/>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator>
    <position name="servo" joint="first" kp="8" kv="0.7" gear="12" forcerange="-300 300"/>
    <general name="odd" joint="second" gear="-3" gainprm="70" biastype="affine"
             biasprm="1.5 -65 -4" damping="2.5"/>
    <motor name="motor" joint="third" gear="-5" ctrlrange="-40 40"/>
  </actuator>
</mujoco>)";
}

}  // namespace mjarm::testing
