#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "mjarm/control/link_errors.hpp"
#include "mjarm/control/step_inverse.hpp"
#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/model/wrong_model.hpp"

namespace mjarm {

/// What is not known of an arm whose contacts shall be noticed. Every default is usable as is.
struct ContactOptions {
  int late_steps = 0;  ///< time steps from a command to when it acts, 0 .. 20
  double encoder_step = 1.7453292519943295e-4;  ///< [rad or m] >= 0; 0.01 deg
  double torque_noise = 0.01;  ///< >= 0, standard deviation of a torque over that torque
  /// Of masses and centres as in a wrong model; of friction the most that a joint may have.
  ModelErrors errors = {};
  /// A contact is told where its torques are so unlikely: the squared distance, in standard
  /// deviations, of what they do to the motion from what noise and errors explain. > 0
  double surprise = 49;
};

/// A contact, as joints tell it.
struct NoticedContact {
  JointVec torque;      ///< [N m or N] (dof,) what it does to the joints
  double since = 0;     ///< [s] for how long it has been there
  double surprise = 0;  ///< see ContactOptions
  /// (dof, dof), (dof,) A torque t from outside has the log likelihood
  /// t evidence - t information t / 2, beside that of none.
  Eigen::MatrixXd information = {};
  Eigen::VectorXd evidence = {};
};

/// Notices a force on an arm that nobody planned, from positions and commands alone. The
/// generalised momentum of the arm changes by what drives it and what the model explains (A. De
/// Luca, R. Mattone, ICRA 2005, p. 999); a Kalman filter estimates it from positions, together with
/// all that the model does not know: masses and centres of mass (LinkErrors), dry friction, a slow
/// drift (A. Wahrburg et al., IEEE CASE 2015, p. 1246). A joint near its reversal, whose friction
/// may have turned or not, has a torque of its own that comes and goes within some steps. A contact
/// is a torque that was not there before: the filter's innovations are compared with what steps of
/// torque that began 1 .. kWindow steps ago would make of them (generalised likelihood ratio, A.
/// Willsky, H. Jones, IEEE TAC 21 (1976) 108). So the threshold follows from noise and from what is
/// not known yet. Owns its memory: one a thread.
class ContactObserver {
 public:
  static constexpr int kWindow = 16;  ///< steps for which a contact is looked for

  /// @return bad_input where an option is out of its range.
  [[nodiscard]] static Result<ContactObserver> create(const Model& model, const Arm& arm,
                                                      const ContactOptions& options);

  /// Once a step, before its command; take() has to follow.
  /// @param qpos, qvel  full state of the model; of the arm's rows the positions alone are read.
  [[nodiscard]] std::optional<NoticedContact> look(std::span<const double> qpos,
                                                   std::span<const double> qvel);
  /// What the actuators were told in the end, (dof,) [N m or N].
  void take(const JointVec& torque);

  /// The arm was somewhere else meanwhile, or felt what was planned: goes on with what it learned.
  void restart() { told_.clear(); }
  /// (dof,) [N m or N] Torque from outside, as the last kWindow steps have it; for plots.
  [[nodiscard]] JointVec torque() const;
  /// The largest surprise of the last step.
  [[nodiscard]] double surprise() const noexcept { return surprise_; }

 private:
  ContactObserver(const Model& model, const Arm& arm, const ContactOptions& options);
  void begin(const JointVec& q);
  void predict(const JointVec& torque);
  void find_moving(const JointVec& q);
  void correct(const JointVec& q);
  [[nodiscard]] std::optional<NoticedContact> weigh();
  [[nodiscard]] JointVec most_friction() const;
  void replace(Eigen::Index to, Eigen::Index from, double factor);
  // Where the unknowns of a joint stand: its friction when it moves, drift, friction when it may
  // stand.
  [[nodiscard]] Eigen::Index friction(int joint) const {
    return 2 * joints_ + errors_.count() + joint;
  }
  [[nodiscard]] Eigen::Index drift(int joint) const { return friction(joint) + joints_; }
  [[nodiscard]] Eigen::Index standing(int joint) const { return drift(joint) + joints_; }

  /// Which torque would have begun when, and what came of it: innovations of the steps since.
  struct Onset {
    Eigen::MatrixXd information;  ///< (dof, dof)
    Eigen::VectorXd evidence;     ///< (dof,)
  };
  [[nodiscard]] JointVec explain(const Onset& onset) const;

  Arm arm_;
  ContactOptions options_;
  StepInverse inverse_;
  LinkErrors errors_;
  double h_;
  int joints_;
  Eigen::Index unknown_;  ///< link errors, friction, drift, friction of joints that may stand
  JointVec prior_;        ///< (dof,) inverse variance of the torque of a contact
  std::vector<double> qpos_, qvel_;
  bool runs_ = false;
  Eigen::VectorXd x_;  ///< positions, velocities, unknowns
  Eigen::MatrixXd P_;  ///< its covariance
  JointVec s_, w_;     ///< direction of motion, 0 where nobody knows it; acceleration
  std::deque<JointVec> told_, seen_;
  Eigen::MatrixXd traces_;     ///< what each torque of each onset did to the error of x
  std::vector<Onset> onsets_;  ///< a ring
  int newest_ = 0, filled_ = 0;
  double surprise_ = 0;
};

}  // namespace mjarm
