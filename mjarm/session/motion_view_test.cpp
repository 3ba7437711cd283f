#include "mjarm/session/motion_view.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include "mjarm/program/load_program.hpp"
#include "mjarm/render/framing.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::session {
namespace {

/// At the end of the program that writes letters the arm stands over them, and hides few of their
/// points, by MuJoCo's own rays.
TEST(MotionView, TheArmDoesNotHideWhatItWrote) {
  const program::LoadedProgram loaded =
      program::load_program(program::find_shipped_program("letters").value().string()).value();
  const Robot& robot = loaded.robot;
  const MotionOutline outline = outline_of(loaded.plan);
  ASSERT_GT(outline.marks_W.size(), 50U);
  const render::CameraView view = motion_view(robot.model, robot.arm, outline, false);
  const Eigen::Vector3d eye = render::camera_place(view);
  const mjModel* m = robot.model.raw();
  mjData* d = mj_makeData(m);
  for (std::size_t j = 0; j < robot.arm.joints.size(); ++j) {
    d->qpos[robot.arm.joints[j].qpos] = loaded.plan.q_end()[static_cast<Eigen::Index>(j)];
  }
  mj_kinematics(m, d);
  int hidden = 0;
  for (const Eigen::Vector3d& p_W : outline.marks_W) {
    const Eigen::Vector3d way = p_W - eye;
    const double hit = mj_ray(m, d, eye.data(), way.data(), nullptr, 1, -1, nullptr, nullptr);
    hidden += hit >= 0 && hit * way.norm() < way.norm() - 0.015 ? 1 : 0;
  }
  mj_deleteData(d);
  EXPECT_LT(hidden, 0.2 * static_cast<double>(outline.marks_W.size()));
  // It looks at the plane that was written on (y is constant) from the front or the back.
  EXPECT_GT(std::abs((eye - view.lookat_W).normalized().y()), 0.45);
}

/// A picture of a moment in between is of where the arm is then.
TEST(MotionView, AnOutlineEndsWhenItIsLeft) {
  const program::LoadedProgram loaded =
      program::load_program(program::find_shipped_program("letters").value().string()).value();
  const MotionPlan& plan = loaded.plan;
  const MotionOutline whole = outline_of(plan);
  EXPECT_EQ(whole.postures.back(), plan.q_end());
  const double begin = plan.moves.at(0).trajectory.duration();
  const MotionOutline part = outline_of(plan, begin + 0.1);
  EXPECT_EQ(part.postures.back(), plan.moves.at(1).trajectory.at(0.1).q);
  EXPECT_LT(part.postures.size(), whole.postures.size());
  EXPECT_EQ(part.marks_W.size(), whole.marks_W.size()) << "all that is planned is drawn";
}

}  // namespace
}  // namespace mjarm::session
