#pragma once

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "mjarm/control/robots_test.hpp"

namespace mjarm::testing {

/// MuJoCo with the arm at `q`, at rest; nothing of our own simulation.
class World {
 public:
  World(const Loaded& robot, const JointVec& q)
      : robot_(robot),
        m_(mj_copyModel(nullptr, robot.model.raw())),
        d_(mj_makeData(m_.get())),
        ctrl_(robot.model.nu(), 0.0) {
    for (int i = 0; i < robot.arm.dof(); ++i) d_->qpos[robot.arm.joints[i].qpos] = q[i];
  }
  bool step(Controller& controller, const StepReference& reference) {
    const bool limited = controller.command({d_->qpos, std::size_t(m_->nq)},
                                            {d_->qvel, std::size_t(m_->nv)}, reference, ctrl_);
    mju_copy(d_->ctrl, ctrl_.data(), static_cast<int>(m_->nu));
    mj_step(m_.get(), d_.get());
    return limited;
  }
  [[nodiscard]] JointVec q() const {
    JointVec q(robot_.arm.dof());
    for (int i = 0; i < q.size(); ++i) q[i] = d_->qpos[robot_.arm.joints[i].qpos];
    return q;
  }
  [[nodiscard]] mjModel& m() { return *m_; }  ///< what the controller does not know
  [[nodiscard]] mjData& d() { return *d_; }
  [[nodiscard]] const std::vector<double>& ctrl() const { return ctrl_; }

 private:
  struct Deleter {
    void operator()(mjModel* m) const { mj_deleteModel(m); }
    void operator()(mjData* d) const { mj_deleteData(d); }
  };
  const Loaded& robot_;
  std::unique_ptr<mjModel, Deleter> m_;
  std::unique_ptr<mjData, Deleter> d_;
  std::vector<double> ctrl_;
};

/// Smooth swing about `home`, at rest at t = 0.
inline JointVec swing(const Arm& arm, double t, double size = 0.3) {
  const double s = 1 - std::cos(2 * std::max(t, 0.0));
  return arm.home.array() + size * s;
}

/// What step `i` of that swing refers to, in steps of `h` [s].
inline StepReference swing_reference(const Arm& arm, int i, double h) {
  return {swing(arm, (i - 1) * h), swing(arm, i * h), swing(arm, (i + 1) * h)};
}

/// Largest error of a joint in so many steps of that swing; no limit may cut a command.
inline double worst_tracking_error(const Loaded& robot, ControlMode mode, int steps = 1500) {
  Controller controller = controller_of(robot, mode);
  World world(robot, robot.arm.home);
  const double h = robot.model.timestep();
  double worst = 0;
  for (int i = 0; i < steps; ++i) {
    const StepReference reference = swing_reference(robot.arm, i, h);
    EXPECT_FALSE(world.step(controller, reference)) << "step " << i;
    worst = std::max(worst, (world.q() - reference.next).cwiseAbs().maxCoeff());
  }
  return worst;
}

}  // namespace mjarm::testing
