#pragma once

#include <mujoco/mujoco.h>

#include <limits>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/find_arm.hpp"

/// The steps of find_arm.
namespace mjarm {

inline constexpr double kInf = std::numeric_limits<double>::infinity();

/// Pose of a position (3,) [m] and a quaternion (4,) [w, x, y, z] in MuJoCo's tables.
[[nodiscard]] inline Pose pose_of(const mjtNum* pos, const mjtNum* quat) {
  return {Eigen::Vector3d(pos), to_matrix(Quat(quat[0], quat[1], quat[2], quat[3]))};
}

/// The axis of a frame that is nearest to `v`.
[[nodiscard]] inline Eigen::Vector3d nearest_axis(const Eigen::Vector3d& v) {
  int k = 0;
  v.cwiseAbs().maxCoeff(&k);
  return Eigen::Vector3d::Unit(k) * (v[k] < 0 ? -1 : 1);
}

/// A tool frame T, fixed to a body.
struct TipFrame {
  std::string name;
  int body = 0;
  Pose X_BT;  ///< in the body's frame
};

/// Name of an object of the model; "#ID" where it has none.
[[nodiscard]] std::string object_name(const mjModel* m, mjtObj type, int id);

/// Names of all sites and bodies but the world, sites first.
[[nodiscard]] std::vector<std::string> frame_names(const mjModel* m);

/// The site or body of that name. @return an error with the nearest name.
[[nodiscard]] Result<TipFrame> find_frame(const Model& model, std::string_view name);

/// The tool frame of the only arm. @return an error that lists the choices.
[[nodiscard]] Result<TipFrame> find_tip(const Model& model);

/// Bodies from the child of the world down to `body`, both included.
[[nodiscard]] std::vector<int> bodies_to(const mjModel* m, int body);

/// Hinge and slide joints from the world to `body`, in the order in which they move it.
[[nodiscard]] std::vector<int> joints_to(const mjModel* m, int body);

/// True for the world, `body` and all that hangs on it.
[[nodiscard]] bool hangs_on(const mjModel* m, int descendant, int body);

/// Pose of `tip` in the world as a chain of joints: fills `arm.joints` (geometry, indices, damping)
/// and `arm.X_JT`. Free joints stay as in `qpos` (nq,).
[[nodiscard]] Result<void> fill_chain(const Model& model, const TipFrame& tip, const double* qpos,
                                      Arm& arm);

/// What drives a hinge or slide alone, as a plain servo or motor; none where nothing, several
/// actuators or one of another kind do.
[[nodiscard]] std::optional<ArmActuator> sole_actuator(const mjModel* m, int joint);

/// Fills `arm.joints[i].actuator`.
void fill_actuators(const mjModel* m, const std::vector<int>& joints, Arm& arm);

/// Fills `arm.limits`.
void fill_limits(const Model& model, const std::vector<int>& joints, Arm& arm);

/// The gripper beyond the last of `joints`, if there is one.
[[nodiscard]] std::optional<Gripper> find_gripper(const mjModel* m, const std::vector<int>& joints);

}  // namespace mjarm
