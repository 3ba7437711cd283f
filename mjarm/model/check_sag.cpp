#include <algorithm>
#include <cmath>
#include <functional>

#include "mjarm/core/messages/check.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/check_internal.hpp"
#include "mjarm/model/check_pose_internal.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/mujoco_guard.hpp"

namespace mjarm {
namespace {

/// Sag of the tool that is more than a property of position servos [m].
constexpr double kMaxSag = 0.05;
/// Less is nothing to tell [m]: the arm is balanced, and what is left is rounding.
constexpr double kNoSag = 1e-5;

/// The arm at rest: torques that hold it, and where its tool goes when joints yield.
class RestingArm {
 public:
  explicit RestingArm(const CheckContext& context)
      : m_(context.model->raw()),
        arm_(*context.arm),
        data_(mj_makeData(m_)),
        qpos_(home_qpos(context)) {
    if (const auto tip = find_frame(*context.model, arm_.tip)) tip_ = *tip;
  }

  [[nodiscard]] JointVec home() const { return arm_.home; }

  /// Distance of the tool from the first joint, square to gravity [m].
  double reach(const JointVec& q) {
    place(q);
    mj_kinematics(m_, data_.get());
    const int base = m_->jnt_bodyid[m_->dof_jntid[arm_.joints.front().dof]];
    const Eigen::Vector3d p = tip() - Eigen::Vector3d(data_->xanchor + 3 * m_->body_jntadr[base]);
    const Eigen::Vector3d g(m_->opt.gravity);
    return g.norm() > 0 ? p.cross(g.normalized()).norm() : p.norm();
  }

  /// Joint torques that balance gravity and springs, (dof,) [N m or N].
  JointVec holding_torque(const JointVec& q) {
    place(q);
    mj_fwdPosition(m_, data_.get());
    mj_fwdVelocity(m_, data_.get());
    JointVec torque(arm_.dof());
    for (int i = 0; i < arm_.dof(); ++i) {
      const int dof = arm_.joints[static_cast<std::size_t>(i)].dof;
      torque[i] = data_->qfrc_bias[dof] - data_->qfrc_passive[dof];
    }
    return torque;
  }

  /// Where the tool goes for each joint's yielding, 3 x dof [m/rad or m/m], after holding_torque.
  Eigen::Matrix3Xd jacobian() {
    Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> J(3, m_->nv);
    const Eigen::Vector3d point = tip();
    mj_jac(m_, data_.get(), J.data(), nullptr, point.data(), tip_.body);
    Eigen::Matrix3Xd arm(3, arm_.dof());
    for (int i = 0; i < arm_.dof(); ++i) {
      arm.col(i) = J.col(arm_.joints[static_cast<std::size_t>(i)].dof);
    }
    return arm;
  }

 private:
  void place(const JointVec& q) {
    std::copy(qpos_.begin(), qpos_.end(), data_->qpos);
    for (int i = 0; i < arm_.dof(); ++i) {
      data_->qpos[arm_.joints[static_cast<std::size_t>(i)].qpos] = q[i];
    }
  }
  [[nodiscard]] Eigen::Vector3d tip() const {
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(data_->xmat +
                                                                           9 * tip_.body);
    return R * tip_.X_BT.p + Eigen::Vector3d(data_->xpos + 3 * tip_.body);
  }

  const mjModel* m_;
  const Arm& arm_;
  MjDataPtr data_;
  std::vector<double> qpos_;
  TipFrame tip_;
};

/// The configuration within the limits whose tool is farthest out: coordinate search with a
/// halving step, from home and from a few random starts.
JointVec stretched_out(RestingArm& resting, const Arm& arm) {
  const auto lower = [&](int i) { return std::max(arm.limits.lower[i], -3.2); };
  const auto upper = [&](int i) { return std::min(arm.limits.upper[i], 3.2); };
  Rng rng(1);
  JointVec best = arm.home;
  double farthest = -1;
  for (int start = 0; start < 6; ++start) {
    JointVec q = arm.home;
    for (int i = 0; i < arm.dof() && start > 0; ++i) q[i] = rng.uniform(lower(i), upper(i));
    double here = resting.reach(q);
    for (double step = 0.8; step > 1e-3; step /= 2) {
      for (int i = 0; i < 2 * arm.dof(); ++i) {
        JointVec trial = q;
        trial[i / 2] += i % 2 == 0 ? step : -step;
        trial[i / 2] = std::clamp(trial[i / 2], lower(i / 2), std::max(lower(i / 2), upper(i / 2)));
        const double there = resting.reach(trial);
        if (there > here + 1e-9) {
          here = there;
          q = trial;
        }
      }
    }
    if (here > farthest + 1e-6) {
      farthest = here;
      best = q;
    }
  }
  return best;
}

/// Sag at one configuration.
struct Sag {
  double tool = 0;   ///< [m] of the tool
  int joint = -1;    ///< the one that adds most
  double share = 0;  ///< [m] what that joint alone does
};

Sag sag_at(RestingArm& resting, const Arm& arm, const JointVec& q) {
  const JointVec torque = resting.holding_torque(q);
  const Eigen::Matrix3Xd J = resting.jacobian();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Sag sag;
  for (int i = 0; i < arm.dof(); ++i) {
    const auto& actuator = arm.joints[static_cast<std::size_t>(i)].actuator;
    const double stiffness = actuator ? -actuator->bias[1] * actuator->gear * actuator->gear : 0;
    if (!(stiffness > 0)) continue;
    const Eigen::Vector3d part = J.col(i) * (torque[i] / stiffness);
    sum += part;
    if (part.norm() > sag.share) {
      sag.share = part.norm();
      sag.joint = i;
    }
  }
  sag.tool = sum.norm();
  return sag;
}

void report_sag(const CheckContext& context, const Sag& home, const Sag& stretched) {
  const Sag& worst = home.tool > stretched.tool ? home : stretched;
  if (worst.joint < 0 || worst.tool < kNoSag) return;
  const ArmJoint& joint = context.arm->joints[static_cast<std::size_t>(worst.joint)];
  const ArmActuator& servo = *joint.actuator;
  const double stiffness = -servo.bias[1] * servo.gear * servo.gear;
  context.add(CheckCode::servo_sag, worst.tool > kMaxSag ? Grade::warning : Grade::note,
              context.description.actuator(servo.name, {"kp", "biasprm"}),
              text(msg::check_sag, 1000 * home.tool, 1000 * stretched.tool, 1000 * worst.share,
                   joint.name, stiffness));
}

void check_torques(const CheckContext& context, const JointVec& torque) {
  const Arm& arm = *context.arm;
  for (int i = 0; i < arm.dof(); ++i) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
    if (arm.limits.sources[static_cast<std::size_t>(i)].torque != LimitSource::file) continue;
    if (std::abs(torque[i]) <= arm.limits.torque[i]) continue;
    const Place place = joint.actuator
                            ? context.description.actuator(joint.actuator->name, {"forcerange"})
                            : context.description.joint(joint.name);
    context.add(
        CheckCode::torque_too_small, Grade::warning, place,
        text(msg::check_torque_small, std::abs(torque[i]), joint.name, arm.limits.torque[i]));
  }
}

}  // namespace

void check_sag(const CheckContext& context) {
  const Arm& arm = *context.arm;
  Sag home;
  Sag stretched;
  JointVec torque;
  RestingArm resting(context);
  const MujocoOutcome outcome = call_mujoco([&] {
    const JointVec far = stretched_out(resting, arm);
    home = sag_at(resting, arm, arm.home);
    stretched = sag_at(resting, arm, far);
    torque = resting.holding_torque(far);
  });
  if (outcome.failed) return;
  report_sag(context, home, stretched);
  check_torques(context, torque);
}

}  // namespace mjarm
