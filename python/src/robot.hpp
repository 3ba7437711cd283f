#pragma once

#include <nanobind/nanobind.h>

#include <span>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/floating_base.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm::python {

/// `mjarm.Robot`: a loaded file, the arm in it, and what its calls need again and again.
struct BoundRobot {
  explicit BoundRobot(Robot loaded)
      : robot(std::move(loaded)), ik(robot.arm), base(floating_base(robot.model, robot.arm)) {}

  Robot robot;
  IkSolver ik;                      ///< with options as they are by default
  std::optional<std::string> base;  ///< body that carries the arm and is free

  [[nodiscard]] const Arm& arm() const { return robot.arm; }
  [[nodiscard]] int dof() const { return robot.arm.dof(); }

  /// Joint values of a caller: (dof,), or the whole configuration (nq,) of the model.
  /// @throws a BadInput that names the argument: another shape, no numbers, degrees.
  [[nodiscard]] JointVec joints(nanobind::handle value, const char* name) const;
  [[nodiscard]] JointVec joints(std::span<const double> values, const char* name) const;
  /// From the world with the base as at home to where it stands in `value`, the whole configuration
  /// of the model; the identity where that has joint values only, or the base stands fast.
  [[nodiscard]] Pose moved_base(nanobind::handle value) const;
  /// The same where `None` means home.
  [[nodiscard]] JointVec joints_or_home(nanobind::handle value, const char* name) const;
  /// (n, dof).
  [[nodiscard]] std::vector<double> rows(nanobind::handle value, const char* name) const;
  /// The same as one vector a row.
  [[nodiscard]] std::vector<JointVec> waypoints(nanobind::handle value, const char* name) const;
};

/// The arm's part of a whole configuration (nq,), shape (dof,).
[[nodiscard]] JointVec joints_in(std::span<const double> qpos, const Arm& arm);

/// A whole configuration (nq,) of the model; empty for None.
/// @throws a BadInput for another shape, or no numbers.
[[nodiscard]] std::vector<double> qpos_of(nanobind::handle value, const Model& model);

}  // namespace mjarm::python
