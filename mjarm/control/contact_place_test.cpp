#include "mjarm/control/contact_place.hpp"

#include <gtest/gtest.h>

#include <string>

#include "mjarm/control/world_test.hpp"
#include "mjarm/core/rng.hpp"

namespace mjarm::testing {
namespace {

/// What an observer without any noise would tell of a push of 40 N, torques by MuJoCo's Jacobian.
NoticedContact contact_of(const Loaded& robot, World& world, int body, const Eigen::Vector3d& p_W,
                          const Eigen::Vector3d& way_W) {
  const int nv = static_cast<int>(world.m().nv), dof = robot.arm.dof();
  std::vector<double> J(3 * static_cast<std::size_t>(nv));
  mj_jac(&world.m(), &world.d(), J.data(), nullptr, p_W.data(), body);
  NoticedContact out{.torque = JointVec::Zero(dof)};
  for (int j = 0; j < dof; ++j) {
    for (int x = 0; x < 3; ++x) {
      out.torque[j] +=
          40 * way_W[x] * J[static_cast<std::size_t>(x * nv + robot.arm.joints[j].dof)];
    }
  }
  out.information = 25 * Eigen::MatrixXd::Identity(dof, dof);  // 0.2 N m
  out.evidence = out.information * out.torque;
  out.surprise = out.torque.dot(out.evidence);
  return out;
}

struct Named {
  int pushes = 0, right = 0, near = 0, force = 0;
};
/// The last joint that moves a body, -1 for none.
int mover_of(const Loaded& robot, const mjModel& m, int body) {
  int out = -1;
  for (int j = 0; j < robot.arm.dof(); ++j) {
    for (int b = body; b > 0; b = m.body_parentid[b]) {
      if (b == m.dof_bodyid[robot.arm.joints[j].dof]) out = j;
    }
  }
  return out;
}

/// Pushes on all links where a ray of MuJoCo's towards the middle of a link meets what is drawn.
Named name_pushes(const std::string& name) {
  const Loaded robot = load_shipped(name);
  JointVec q = robot.arm.home;
  for (int j = 0; j < q.size(); ++j) q[j] += j % 2 == 0 ? 0.35 : -0.25;
  World world(robot, q);
  mj_forward(&world.m(), &world.d());
  const ContactPlaces places(robot.model, robot.arm);
  const mjtByte drawn[mjNGROUP] = {1, 1, 1, 0, 0, 0};
  Rng rng(1);
  Named out;
  for (int body = 1; body < world.m().nbody; ++body) {
    const int joint = mover_of(robot, world.m(), body);
    if (joint < 1) continue;
    for (int push = 0; push < 30; ++push) {
      const Eigen::Vector3d way =
          Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
      const Eigen::Vector3d from = Eigen::Vector3d(world.d().xipos + 3 * body) - way;
      int geom = -1;
      Eigen::Vector3d normal;
      const double far = mj_ray(&world.m(), &world.d(), from.data(), way.data(), drawn, 1, -1,
                                &geom, normal.data());
      if (geom < 0 || world.m().geom_bodyid[geom] != body || -normal.dot(way) < 0.9) continue;
      const NoticedContact contact = contact_of(robot, world, body, from + far * way, way);
      if (contact.surprise < 64) continue;
      const ContactPlace place = places.find(q, contact);
      ++out.pushes;
      out.right += place.joint == joint ? 1 : 0;
      out.near += std::abs(place.joint - joint) <= 1 ? 1 : 0;
      out.force += std::abs(place.force_W.norm() - 40) < 20 ? 1 : 0;
    }
  }
  return out;
}

TEST(ContactPlaces, TheLinkThatIsPushedIsNamed) {
  for (const char* robot : {"ur5e", "panda"}) {
    const Named named = name_pushes(robot);
    EXPECT_GE(named.pushes, 30) << robot;
    EXPECT_GE(named.right, 0.5 * named.pushes) << robot << " of " << named.pushes;
    EXPECT_GE(named.near, 0.8 * named.pushes) << robot << " of " << named.pushes;
    EXPECT_GE(named.force, 0.5 * named.pushes) << robot << " of " << named.pushes;
  }
}

/// An arm of three links: how they are drawn, and the start of the second one's element.
Loaded three_links(const std::string& group, const std::string& two) {
  return load_text(R"(<mujoco><compiler angle="radian"/><default>
    <joint axis="0 1 0" range="-2 2" limited="true"/>
    <geom type="capsule" fromto="0 0 0 0 0 .3" size=".03" group=")" +
                   group + R"("/></default>
    <worldbody><body name="one"><joint name="a"/><geom/>
    )" + two + R"( pos="0 0 .3"><joint name="b" axis="1 0 0"/><geom/>
    <body name="three" pos="0 0 .3"><joint name="c"/><geom/><site name="tool" pos="0 0 .3"/>
    </body></body></body></worldbody>
    <actuator><motor joint="a"/><motor joint="b"/><motor joint="c"/></actuator></mujoco>)");
}

TEST(ContactPlaces, ALinkWithoutANameHasASurfaceToo) {
  const Loaded robot = three_links("2", "<body"), named = three_links("2", R"(<body name="two")");
  World world(robot, robot.arm.home);
  mj_forward(&world.m(), &world.d());
  // Aside of its middle: pushes at the centre of mass alone would not tell this.
  const Eigen::Vector3d way = Eigen::Vector3d(1, 0.4, 0).normalized();
  const NoticedContact contact = contact_of(robot, world, 2, {-0.02, -0.01, 0.55}, way);
  const ContactPlace place = ContactPlaces(robot.model, robot.arm).find(robot.arm.home, contact);
  const ContactPlace as = ContactPlaces(named.model, named.arm).find(robot.arm.home, contact);
  EXPECT_EQ(place.body, "#2");
  EXPECT_EQ(as.body, "two");
  EXPECT_EQ(place.force_W, as.force_W);
}

TEST(ContactPlaces, ALinkOfWhichNothingIsDrawnHasAPlaceToo) {
  const Loaded robot = three_links("3", R"(<body name="two")");
  World world(robot, robot.arm.home);
  mj_forward(&world.m(), &world.d());
  const ContactPlaces places(robot.model, robot.arm);
  for (const char* name : {"two", "three"}) {
    const int body = mj_name2id(&world.m(), mjOBJ_BODY, name);
    ASSERT_GT(body, 0);
    const Eigen::Vector3d middle(world.d().xipos + 3 * body);
    const Eigen::Vector3d way = Eigen::Vector3d(1, 0.4, 0).normalized();
    const NoticedContact contact = contact_of(robot, world, body, middle, way);
    EXPECT_EQ(places.find(robot.arm.home, contact).body, name);
  }
}

}  // namespace
}  // namespace mjarm::testing
