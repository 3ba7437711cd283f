#pragma once

#include <string>

#include "mjarm/model/robot.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::testing {

/// Two slides carry a ball of 20 mm over a table whose top is at z = 0, from one side of a fence to
/// the other. The fence is 0.2 m high, the ceiling `room` above it and 50 mm.
inline Robot slider(double room) {
  const support::TempFolder folder;
  const std::string xml = R"(<mujoco><worldbody>
    <geom name="table" type="box" size="1 1 0.05" pos="0 0 -0.05"/>
    <geom name="fence" type="box" size="0.01 1 0.1" pos="0 0 0.1"/>
    <geom name="ceiling" type="box" size="1 1 0.05" pos="0 0 )" +
                          std::to_string(0.25 + room) + R"("/>
    <body name="x"><joint name="x" type="slide" axis="1 0 0" range="-0.6 0.6" limited="true"/>
      <geom type="sphere" size="0.001" contype="0" conaffinity="0"/>
      <body name="z"><joint name="z" type="slide" axis="0 0 1" range="0 0.6" limited="true"/>
        <geom name="ball" type="sphere" size="0.02"/><site name="tcp"/></body></body>
    </worldbody>
    <actuator><position joint="x"/><position joint="z"/></actuator></mujoco>)";
  return load_robot(folder.write("slider.xml", xml).string(), {.tip = "tcp"}).value();
}

}  // namespace mjarm::testing
