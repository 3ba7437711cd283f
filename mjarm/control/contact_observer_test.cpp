#include "mjarm/control/contact_observer.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "mjarm/control/world_test.hpp"

namespace mjarm::testing {
namespace {

/// A push of MuJoCo's own on a body, and what the observer made of it.
struct Push {
  int body = 0;
  double from = 1e9;  ///< [s]
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();
};
struct Watched {
  std::optional<double> noticed = {};  ///< [s]
  NoticedContact first = {}, strongest = {};
  JointVec true_torque;  ///< (dof,) of the push then, J^T f by MuJoCo
};

/// Three seconds of a swing by computed torque, positions rounded as an encoder has them.
Watched watch_swing(const Loaded& robot, const Push& push, double heavier = 1) {
  constexpr double kEncoder = 1.7453292519943295e-4;  // [rad]
  const Arm& arm = robot.arm;
  Controller controller = controller_of(robot, ControlMode::computed_torque);
  Result<ContactObserver> observer = ContactObserver::create(robot.model, arm, {});
  if (!observer) throw std::runtime_error(observer.error().what);
  World world(robot, arm.home);
  for (int body = 1; body < world.m().nbody; ++body) world.m().body_mass[body] *= heavier;
  const double h = robot.model.timestep();
  Watched out;
  JointVec pushed = JointVec::Zero(arm.dof());
  for (int i = 0; i * h < 3; ++i) {
    mjData& d = world.d();
    std::vector<double> read(d.qpos, d.qpos + world.m().nq);
    for (const ArmJoint& joint : arm.joints) {
      double& q = read[static_cast<std::size_t>(joint.qpos)];
      q = kEncoder * std::round(q / kEncoder);
    }
    const auto noticed = observer->look(read, {d.qvel, static_cast<std::size_t>(world.m().nv)});
    if (noticed && !out.noticed) {
      out.noticed = i * h;
      out.first = *noticed;
    }
    if (noticed && i * h < *out.noticed + 0.014 && noticed->surprise > out.strongest.surprise) {
      out.strongest = *noticed;
      out.true_torque = pushed;
    }
    if (i * h >= push.from) {
      for (int x = 0; x < 3; ++x) d.xfrc_applied[6 * push.body + x] = push.force_W[x];
      std::vector<double> J(3 * static_cast<std::size_t>(world.m().nv));
      mj_jacBodyCom(&world.m(), &d, J.data(), nullptr, push.body);
      pushed = JointVec::Zero(arm.dof());
      for (int j = 0; j < arm.dof(); ++j) {
        for (int x = 0; x < 3; ++x) {
          pushed[j] +=
              push.force_W[x] * J[static_cast<std::size_t>(x * world.m().nv + arm.joints[j].dof)];
        }
      }
    }
    world.step(controller, swing_reference(arm, i, h));
    observer->take(controller.torque());
  }
  return out;
}

TEST(ContactObserver, NoticesAPushWithinTwentyMilliseconds) {
  const Loaded robot = load_shipped("ur5e");
  const int body = mj_name2id(robot.model.raw(), mjOBJ_BODY, "forearm_link");
  ASSERT_GT(body, 0);
  for (const Eigen::Vector3d& way : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 0.6, 0.8)}) {
    const Watched watched = watch_swing(robot, {body, 1.0, 20 * way});
    ASSERT_TRUE(watched.noticed.has_value());
    EXPECT_GE(*watched.noticed, 1.0);
    EXPECT_LE(*watched.noticed, 1.02);
    // The forearm hangs at the third joint: no joint beyond it feels the push.
    EXPECT_LT(watched.strongest.torque.tail(3).norm(), 0.1 * watched.strongest.torque.norm());
    const double size = watched.true_torque.norm();
    EXPECT_LT((watched.strongest.torque - watched.true_torque).norm(), 0.3 * size)
        << watched.strongest.torque.transpose() << " | " << watched.true_torque.transpose();
  }
}

TEST(ContactObserver, WrongMassesAreNoContact) {
  for (const double factor : {0.8, 1.0, 1.2}) {
    EXPECT_FALSE(watch_swing(load_shipped("ur5e"), {}, factor).noticed) << factor;
    EXPECT_FALSE(watch_swing(load_shipped("panda"), {}, factor).noticed) << factor;
  }
}

TEST(ContactObserver, OptionsOutOfRangeAreRefused) {
  const Loaded robot = load_shipped("ur5e");
  for (const ContactOptions& options :
       {ContactOptions{.late_steps = -1}, ContactOptions{.late_steps = 21},
        ContactOptions{.encoder_step = -1e-3}, ContactOptions{.torque_noise = -1},
        ContactOptions{.errors = {.mass = 1}}, ContactOptions{.surprise = 0}}) {
    EXPECT_FALSE(ContactObserver::create(robot.model, robot.arm, options).has_value());
  }
}

}  // namespace
}  // namespace mjarm::testing
