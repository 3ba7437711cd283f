#include "mjarm/identification/excitation.hpp"

#include <gtest/gtest.h>

#include "mjarm/model/robot.hpp"

namespace mjarm {
namespace {

TEST(Excitation, MovesEveryJointWithinItsLimitsAndComesBack) {
  for (const char* name : {"ur5e", "panda"}) {
    const Robot robot = load_robot(name).value();
    const JointVec home = robot.arm.home;
    const Trajectory motion =
        excitation(robot.model, robot.arm, home, {.seconds = 10, .tries = 3}).value();
    EXPECT_DOUBLE_EQ(motion.duration(), 10);
    EXPECT_EQ(motion.at(10).q, home);
    EXPECT_EQ(motion.at(0).v.norm(), 0);
    const LimitUse use = check_limits(motion, robot.arm.limits);
    EXPECT_LE(use.worst(), 0.45) << name;
    EXPECT_EQ(use.position.cwiseAbs().maxCoeff(), 0) << name;
    JointVec farthest = JointVec::Zero(home.size());
    for (double t = 0; t < 10; t += 0.01) {
      farthest = farthest.cwiseMax((motion.at(t).q - home).cwiseAbs());
    }
    EXPECT_GT(farthest.minCoeff(), 0.1) << name;
  }
}

TEST(Excitation, IsTheSameForOneSeedAndAnotherForAnother) {
  const Robot robot = load_robot("ur5e").value();
  const auto middle = [&](std::uint64_t seed) {
    const ExcitationOptions options{.seconds = 5, .seed = seed, .tries = 2};
    return excitation(robot.model, robot.arm, robot.arm.home, options).value().at(2.3).q;
  };
  EXPECT_EQ(middle(1), middle(1));
  EXPECT_GT((middle(1) - middle(2)).norm(), 1e-3);
}

TEST(Excitation, StaysWhereItMayAndSaysWhereItCannot) {
  const Robot robot = load_robot("ur5e").value();
  const JointVec home = robot.arm.home;
  ExcitationOptions options{.seconds = 5, .tries = 3};
  options.valid = [&](std::span<const double> q) { return std::abs(q[0] - home[0]) < 0.4; };
  const Trajectory motion = excitation(robot.model, robot.arm, home, options).value();
  for (double t = 0; t < 5; t += 0.01) EXPECT_LT(std::abs(motion.at(t).q[0] - home[0]), 0.41);
  options.valid = [](std::span<const double>) { return false; };
  EXPECT_EQ(excitation(robot.model, robot.arm, home, options).error().code, Errc::impossible);
  EXPECT_EQ(excitation(robot.model, robot.arm, home, {.seconds = 1}).error().code, Errc::bad_input);
}

TEST(Excitation, ThatIsFreeKeepsAwayFromThings) {
  const Robot robot = load_robot("ur5e").value();
  const JointVec home = robot.arm.home;
  const ExcitationOptions options{.seconds = 5, .tries = 3};
  // Something stands 0.3 rad from home on one side of the first joint.
  const ClearanceCheck wall = [&](std::span<const double> q) {
    return Clearance{.distance = home[0] + 0.3 - q[0], .pair = {}};
  };
  const Trajectory motion = free_excitation(robot.model, robot.arm, home, wall, options).value();
  for (double t = 0; t < 5; t += 0.01) EXPECT_LT(motion.at(t).q[0], home[0] + 0.3);
  const Trajectory anywhere = free_excitation(robot.model, robot.arm, home, {}, options).value();
  EXPECT_EQ(anywhere.at(2).q, excitation(robot.model, robot.arm, home, options).value().at(2).q);
  const ClearanceCheck never = [](std::span<const double>) {
    return Clearance{.distance = 0, .pair = {}};
  };
  EXPECT_EQ(free_excitation(robot.model, robot.arm, home, never, options).error().code,
            Errc::impossible);
  // Far away as it is told, and yet in the way.
  const ClearanceCheck odd([](std::span<const double>) { return Clearance{}; },
                           [](std::span<const double>) { return false; });
  EXPECT_NE(free_excitation(robot.model, robot.arm, home, odd, options).error().what.find("0.00 s"),
            std::string::npos);
}

}  // namespace
}  // namespace mjarm
