#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mjarm/control/regressor.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/identification/joint_log.hpp"
#include "mjarm/model/payload.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm {

/// A number that was estimated.
struct Estimate {
  double value = 0;
  double error = 0;   ///< standard error, of the same unit
  bool known = true;  ///< the log tells it; else `value` is the model's and `error` infinite
};
/// "1.500 +- 0.002", as many digits as the error leaves; "-" for what is not known.
[[nodiscard]] std::string describe(const Estimate& estimate);

/// How one joint resists beside what its links need.
struct JointEstimate {
  Estimate friction;  ///< [N m or N] dry
  Estimate viscous;   ///< [N m s/rad or N s/m]
  Estimate offset;    ///< [N m or N] of the torque that is told
  /// [kg m^2 or kg] Of the rotor, at the joint; where links are unknown those of the first joints
  /// cannot be told from them.
  Estimate inertia;
  double rms = 0;  ///< [N m or N] of what the estimates leave unexplained
};

/// What hangs at the tool, as a point mass.
struct PayloadEstimate {
  Estimate mass;                   ///< [kg]
  std::array<Estimate, 3> center;  ///< [m] centre of mass in the tool's frame

  /// Whether there is more than nothing: by three standard errors.
  [[nodiscard]] bool is_told() const { return mass.known && mass.value > 3 * mass.error; }
  [[nodiscard]] Payload payload() const {
    return {mass.value, {center[0].value, center[1].value, center[2].value}};
  }
};

/// What identify() is to look for, and in what.
struct IdentifyTask {
  const JointLog* log = nullptr;  ///< never null
  const JointLog* empty =
      nullptr;          ///< of the arm without the payload of `log`; null: there is none
  bool payload = true;  ///< of `log`, beside what the model has at the tool
  bool links = false;   ///< the links are not as in the model; goes without saying with `empty`
  StopCheck stop = {};  ///< ends the work
};

/// What torques and positions tell of an arm.
struct Identification {
  std::vector<JointEstimate> joints;
  std::optional<PayloadEstimate> payload;
  BaseColumns base;             ///< which parameters `links` are; empty where they were not asked
  std::vector<Estimate> links;  ///< base parameters [kg, kg m, kg m^2], payload not included
  Eigen::VectorXd model_links;  ///< the same as the model has them
  double delay = 0;             ///< [s] by which torques in the log are told before they act
  std::size_t rows = 0;         ///< of the equations that were solved
};

/// Estimates by weighted linear least squares what joint torques are linear in: differences of the
/// links from the model, dry and viscous friction, offset and rotor inertia of each joint, and the
/// payload (J. Swevers, W. Verdonck, J. De Schutter, IEEE Control Systems 27 (2007) no. 5, 58).
/// Positions are smoothed and differentiated, torques smoothed alike; moments in which a joint
/// stands or turns back are left out of its equations; each joint counts by how well its torques
/// are explained. Standard errors are those of residuals that go together within a window of
/// smoothing, across joints (cluster-robust covariance). The delay is that which explains most.
/// Directions that the log does not excite are left as the model has them.
///
/// A payload cannot be told from an error of the last link: with one log the links are taken to be
/// as in the model, with two, one of them of the empty arm, nothing is.
/// @return bad_input for a log that is too short, too coarse, or in which nothing moves; stopped()
///         where `stop` ended the work.
[[nodiscard]] Result<Identification> identify(const Robot& robot, const IdentifyTask& task);

}  // namespace mjarm
