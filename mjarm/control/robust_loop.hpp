#pragma once

#include <Eigen/Core>
#include <deque>
#include <span>
#include <vector>

#include "mjarm/control/friction_split.hpp"
#include "mjarm/control/reference.hpp"
#include "mjarm/control/step_inverse.hpp"
#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// Control of an arm whose model is wrong. Every default is usable as is.
struct RobustOptions {
  double bandwidth = 50;  ///< [rad/s] > 0, both poles of the loop that follows
  double observer = 140;  ///< [rad/s] > 0, the three poles of the observer
  int late_steps = 0;     ///< time steps from a command to when it acts, 0 .. 20
  /// [rad/s or m/s] > 0, the speed of the reference from which its dry friction has turned.
  double friction_speed = 1e-3;
};

/// Computed torque with an observer of what the model does not know: it estimates position,
/// velocity and the torque that disturbs each joint from positions and commands alone (extended
/// state observer, J. Han, IEEE Trans. Industrial Electronics 56 (2009) 900), looks ahead by the
/// steps that a command is late, and tells dry friction from load, so that a joint that turns finds
/// its friction turned too. Quantised positions are as good as its own smoothing of them; the
/// measured velocities of the arm are not used. A command that is late by `late_steps` makes the
/// arm follow later by as much, on the same path.
class RobustLoop {
 public:
  /// @return bad_input where an option is out of its range, or too fast for time step and lateness.
  [[nodiscard]] static Result<RobustLoop> create(const Model& model, const Arm& arm,
                                                 const RobustOptions& options);

  /// Joint torque (dof,) [N m or N] for the step that comes; take() has to follow.
  /// @param qpos, qvel  full state of the model; of the arm's rows the positions alone are read.
  [[nodiscard]] JointVec torque(std::span<const double> qpos, std::span<const double> qvel,
                                const StepReference& reference);
  /// What the actuators were told in the end, (dof,) [N m or N].
  void take(const JointVec& torque);

  /// Goes on with the frictions and loads that another one of as many joints has learned.
  void learn_from(const RobustLoop& other);
  /// (dof,) [N m or N] >= 0
  [[nodiscard]] JointVec friction() const;
  /// (dof,) [N m or N] What disturbs the joints beside that friction.
  [[nodiscard]] const JointVec& load() const noexcept { return load_; }

 private:
  RobustLoop(const Model& model, const Arm& arm, const RobustOptions& options);
  /// A command on its way, and the direction of the reference that it was made for.
  struct Pending {
    JointVec torque, s;
  };
  /// The model at one state.
  struct Motion {
    Eigen::MatrixXd mass;  ///< (dof, dof), with what the integrator adds
    JointVec rest;         ///< (dof,) torque that gives no acceleration
  };

  void begin(std::span<const double> qpos, const JointVec& q);
  [[nodiscard]] Motion motion_at(const JointVec& q, const JointVec& v);
  void observe(const JointVec& q, const Motion& motion);
  void learn(const JointVec& q);
  [[nodiscard]] JointVec directions(const JointVec& v) const;
  void put(const JointVec& q, const JointVec& v);

  Arm arm_;
  RobustOptions options_;
  StepInverse inverse_;
  double h_;
  double gain_q_, gain_v_, gain_load_;
  std::vector<double> qpos_, qvel_;  ///< full state, the arm's rows as asked for last
  bool runs_ = false;
  JointVec q_, v_, load_, friction_;
  JointVec s_, s_lag_[3];  ///< direction of motion now, and as slow as the observer
  JointVec s_next_;        ///< of the reference of torque()
  std::deque<Pending> pending_;
  std::deque<JointVec> seen_;   ///< latest positions
  std::vector<double> moving_;  ///< [s] for which each joint has moved that way
  std::vector<FrictionSplit> split_;
};

}  // namespace mjarm
