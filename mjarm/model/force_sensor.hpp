#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// A force sensor (MJCF `force`) between an arm's last link and what it carries.
struct ForceSensor {
  std::string name;
  std::size_t at = 0;                                  ///< of its three numbers in the sensor data
  Eigen::Matrix3d R_TS = Eigen::Matrix3d::Identity();  ///< its frame in the tool frame

  /// [N] What the arm pushes the part beyond it with, a pen or a gripper, in the tool frame: what
  /// that part presses on things with, less its weight.
  /// @param sensor_data  as MuJoCo orders it, of Sim::sensor_data().
  [[nodiscard]] Eigen::Vector3d force(std::span<const double> sensor_data) const {
    return R_TS * Eigen::Vector3d(sensor_data[at], sensor_data[at + 1], sensor_data[at + 2]);
  }
};

/// The first force sensor of `model` whose site stands still in the frame of the arm's tool; none
/// where there is none.
[[nodiscard]] std::optional<ForceSensor> find_force_sensor(const Model& model, const Arm& arm);

}  // namespace mjarm
