#include "mjarm/sim/imperfect_drives.hpp"

#include <cmath>

namespace mjarm {

ImperfectDrives::ImperfectDrives(const Arm& arm, const DriveFaults& faults, double timestep,
                                 const Rng& rng)
    : arm_(arm), faults_(faults), h_(timestep), rng_(rng) {}

void ImperfectDrives::read(std::span<const double> qpos, std::span<const double> qvel) {
  const std::vector<double> before = qpos_;
  qpos_.assign(qpos.begin(), qpos.end());
  qvel_.assign(qvel.begin(), qvel.end());
  for (const ArmJoint& joint : arm_.joints) {
    double& q = qpos_[static_cast<std::size_t>(joint.qpos)];
    if (faults_.encoder_step > 0) q = faults_.encoder_step * std::round(q / faults_.encoder_step);
    qvel_[static_cast<std::size_t>(joint.dof)] =
        before.empty() ? 0 : (q - before[static_cast<std::size_t>(joint.qpos)]) / h_;
  }
}

void ImperfectDrives::pass(std::span<double> ctrl) {
  JointVec told(arm_.dof());
  for (int i = 0; i < arm_.dof(); ++i) told[i] = ctrl[arm_.joints[i].actuator->id];
  while (static_cast<int>(commands_.size()) <= faults_.late_steps) commands_.push_back(told);
  const JointVec now = commands_.front();
  commands_.pop_front();
  for (int i = 0; i < arm_.dof(); ++i) {
    ctrl[arm_.joints[i].actuator->id] = now[i] * (1 + faults_.noise * rng_.normal());
  }
}

}  // namespace mjarm
