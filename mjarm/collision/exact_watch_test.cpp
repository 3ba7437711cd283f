#include "mjarm/collision/exact_watch.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <memory>

#include "mjarm/core/rng.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm {
namespace {

/// MuJoCo's own world, in which the arm is put anywhere.
class OracleWorld {
 public:
  explicit OracleWorld(const Robot& robot)
      : robot_(robot), m_(robot.model.raw()), d_(mj_makeData(m_)) {
    mj_resetDataKeyframe(m_, d_.get(), 0);
    for (int b = 0; b < static_cast<int>(m_->nbody); ++b) {
      moves_.push_back(b > 0 && (b == m_->dof_bodyid[robot.arm.joints.front().dof] ||
                                 moves_[static_cast<std::size_t>(m_->body_parentid[b])]));
    }
  }
  [[nodiscard]] std::vector<double> qpos(const JointVec& q) {
    for (int k = 0; k < q.size(); ++k) {
      d_->qpos[robot_.arm.joints[static_cast<std::size_t>(k)].qpos] = q[k];
    }
    return {d_->qpos, d_->qpos + m_->nq};
  }
  /// True where a part of the arm overlaps something, but for a finger that has a free body.
  [[nodiscard]] bool touches(const JointVec& q) {
    (void)qpos(q);
    mj_kinematics(m_, d_.get());
    mj_comPos(m_, d_.get());
    mj_collision(m_, d_.get());
    for (int i = 0; i < static_cast<int>(d_->ncon); ++i) {
      const int b1 = m_->geom_bodyid[d_->contact[i].geom[0]];
      const int b2 = m_->geom_bodyid[d_->contact[i].geom[1]];
      const bool arm = moves_[static_cast<std::size_t>(b1)] || moves_[static_cast<std::size_t>(b2)];
      if (d_->contact[i].dist < 0 && arm && !(grips(b1, b2) || grips(b2, b1))) return true;
    }
    return false;
  }

 private:
  struct Free {
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  bool grips(int finger, int thing) const {
    const auto joint_of = [&](int body) {
      return m_->body_jntnum[body] > 0 ? m_->jnt_type[m_->body_jntadr[body]] : -1;
    };
    const int last = m_->dof_bodyid[robot_.arm.joints.back().dof];
    return finger > last && moves_[static_cast<std::size_t>(finger)] && joint_of(finger) >= 0 &&
           joint_of(thing) == mjJNT_FREE;
  }
  const Robot& robot_;
  const mjModel* m_;
  std::unique_ptr<mjData, Free> d_;
  std::vector<bool> moves_;
};

TEST(SceneWatch, WhatIsFreeIsFreeAllAlong) {
  for (const char* scene :
       {"franka_emika_panda/clutter.xml", "universal_robots_ur5e/clutter.xml"}) {
    const Robot robot = load_robot(scene).value();
    SceneWatch watch = SceneWatch::create(robot.model, robot.arm).value();
    OracleWorld world(robot);
    Rng rng(5);
    int free = 0, refused = 0, missed = 0;
    for (int i = 0; i < 300; ++i) {
      JointVec q0 = robot.arm.home, step(q0.size());
      for (int k = 0; k < q0.size(); ++k) {
        q0[k] += rng.uniform(-0.7, 0.7);
        step[k] = rng.uniform(-0.2, 0.2);
      }
      q0 = q0.cwiseMax(robot.arm.limits.lower).cwiseMin(robot.arm.limits.upper);
      if (world.touches(q0)) continue;
      watch.take(world.qpos(q0), q0, -1);
      const JointVec q1 = q0 + 0.3 * step, q2 = q0 + step;
      const bool is_free = watch.check_way(q1, q2).free;
      bool touches = false;
      for (int t = 0; t <= 100 && !touches; ++t) touches = world.touches(q0 + 0.01 * t * step);
      EXPECT_FALSE(is_free && touches) << scene << ", way " << i;
      free += is_free;
      refused += !is_free;
      missed += !is_free && !touches;
    }
    EXPECT_GT(free, 40) << scene;
    EXPECT_GT(refused - missed, 5) << scene << ": some ways do touch something";
  }
}

TEST(SceneWatch, RefusesMarginsThatAreNone) {
  const Robot robot = load_robot("ur5e").value();
  EXPECT_FALSE(SceneWatch::create(robot.model, robot.arm, {.margin = 0}));
  EXPECT_FALSE(SceneWatch::create(robot.model, robot.arm, {.held_margin = -1}));
}

TEST(SceneWatch, RefusesGroundThatItCannotMeasure) {
  const Model model = Model::from_mjcf(R"(<mujoco>
    <asset><hfield name="hills" nrow="2" ncol="2" size="1 1 0.1 0.1" elevation="0 1 1 0"/></asset>
    <worldbody><geom name="ground" type="hfield" hfield="hills"/>
      <body pos="0 0 1"><joint name="j" axis="0 1 0"/><geom size="0.1"/>
        <body pos="0.3 0 0"><joint name="k" axis="0 1 0"/><geom size="0.1"/><site name="tip"/></body>
      </body></worldbody>
    <actuator><motor joint="j"/><motor joint="k"/></actuator></mujoco>)")
                          .value();
  const auto arm = find_arm(model);
  ASSERT_TRUE(arm) << arm.error().what;
  const auto watch = SceneWatch::create(model, *arm);
  ASSERT_FALSE(watch);
  EXPECT_EQ(watch.error().code, Errc::not_available);
  EXPECT_NE(watch.error().what.find("ground"), std::string::npos);
}

}  // namespace
}  // namespace mjarm
