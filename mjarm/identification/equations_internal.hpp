#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mjarm/control/regressor.hpp"
#include "mjarm/control/step_inverse.hpp"
#include "mjarm/identification/smooth_log_internal.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm::detail {

/// The unknowns of the equations, and where each stands among them.
struct Unknowns {
  int dof = 0;
  bool has_payload = false;
  std::optional<BaseColumns> base = {};  ///< of the links, where they are unknown

  [[nodiscard]] int friction(int joint) const { return joint; }
  [[nodiscard]] int viscous(int joint) const { return dof + joint; }
  [[nodiscard]] int offset(int joint) const { return 2 * dof + joint; }
  [[nodiscard]] int inertia(int joint) const { return 3 * dof + joint; }
  [[nodiscard]] int payload() const { return 4 * dof; }  ///< mass and moment
  [[nodiscard]] int link(int base_parameter) const {
    return 4 * dof + (has_payload ? 4 : 0) + base_parameter;
  }
  [[nodiscard]] int size() const { return link(base ? static_cast<int>(base->kept.size()) : 0); }
};

/// What came of them.
struct Solution {
  Eigen::VectorXd x;  ///< differences from the model
  Eigen::MatrixXd covariance;
  std::vector<bool> known;  ///< of each unknown; what is not known is 0
  JointVec rms;             ///< [N m or N] of the residuals of each joint
  double delay = 0;         ///< [s]
  std::size_t rows = 0;
};

/// torque - (what the model needs) = W x, an equation a joint and moment.
class Equations {
 public:
  /// [rad/s or m/s] What moves slower stands: friction of a joint at rest is unknown.
  static constexpr double kSlowest = 0.03;

  Equations(const Robot& robot, const Eigen::Vector3d& gravity, const Unknowns& unknowns);

  void add(const SmoothLog& log, bool loaded);
  /// Whether there is enough to begin with.
  [[nodiscard]] bool moves() const;
  /// (10,) The payload has these parameters beside the unknown ones.
  void set_point_inertia(const Eigen::VectorXd& parameters) { point_inertia_ = parameters; }
  /// @return stopped() where `stop` ended the work.
  [[nodiscard]] Result<Solution> solve(const StopCheck& stop) const;

 private:
  struct Row {
    int log, sample, joint, cluster;
    double known;  ///< [N m or N] that the model needs
  };
  void add_row(const SmoothLog& log, std::size_t sample, int joint, bool loaded,
               const JointVec& known, const Regressor& regressor);
  [[nodiscard]] Eigen::VectorXd right_side(double delay) const;
  [[nodiscard]] JointVec joint_rms(const Eigen::VectorXd& residual) const;
  [[nodiscard]] Eigen::MatrixXd clustered(const Eigen::MatrixXd& W,
                                          const Eigen::VectorXd& residual) const;

  Robot robot_;
  Eigen::Vector3d gravity_;
  Unknowns unknowns_;
  StepInverse inverse_;
  std::vector<double> qpos_, qvel_;
  std::vector<SmoothLog> logs_;
  std::vector<Row> rows_;
  std::vector<Eigen::VectorXd> columns_;          ///< a row of W each
  std::vector<Eigen::VectorXd> inertia_columns_;  ///< (10,) of the payload, zero in the empty log
  Eigen::VectorXd point_inertia_ = Eigen::VectorXd::Zero(kInertialSize);
};

}  // namespace mjarm::detail
