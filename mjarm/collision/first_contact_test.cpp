#include "mjarm/collision/first_contact.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "mjarm/collision/random_scene_test.hpp"
#include "mjarm/collision/sphere_model.hpp"
#include "mjarm/collision/verify_edge.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"

namespace mjarm {
namespace {

/// A ball of 1 mm on a slide along x, and a plate of 0.1 mm across its way at x = 0.1234.
SphereModel ball_and_plate() {
  const Arm arm = testing::make_arm(
      "slider", {{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, -1, 1, JointType::slide}}, Pose());
  SphereSet set;
  set.links = {{"ball", 0, {{Eigen::Vector3d::Zero(), 1e-3}}}};
  const Obstacles world{
      {{"plate", {{0.1234, 0, 0}, Eigen::Matrix3d::Identity()}, BoxShape{{5e-5, 0.1, 0.1}}}}};
  return sphere_model(arm, set, world).value();
}

TEST(EdgeContact, FindsAPlateThatTheSpacingDoesNotPass) {
  const SphereModel made = ball_and_plate();
  ExactChecker checker(made.model, made.arm, {.margin = 0});
  const std::vector<double> q0{-1}, q1{1};
  const auto fine = first_contact(checker, q0, q1, 1e-3);
  ASSERT_TRUE(fine.has_value() && fine->has_value());
  EXPECT_NEAR(2 * (*fine)->t - 1, 0.1234, 1.1e-3);
  EXPECT_EQ((std::set{(*fine)->contact.pair.geom1, (*fine)->contact.pair.geom2}),
            (std::set<std::string>{"s0_0", "o0"}));
  EXPECT_GT((*fine)->contact.depth, 0);
  // Samples 5 mm apart pass by a plate that stops a ball over 2.1 mm; verify_edge() is not fooled.
  const auto coarse = first_contact(checker, q0, q1);
  ASSERT_TRUE(coarse.has_value());
  EXPECT_FALSE(coarse->has_value());
}

TEST(EdgeContact, LooksAtBothEnds) {
  const SphereModel made = ball_and_plate();
  ExactChecker checker(made.model, made.arm, {.margin = 0});
  const std::vector<double> away{-0.5}, in{0.1234};
  const auto t_of = [&](std::span<const double> q0, std::span<const double> q1) {
    return first_contact(checker, q0, q1, 10).value().value().t;
  };
  EXPECT_EQ(t_of(away, in), 1);
  EXPECT_EQ(t_of(in, away), 0);
  EXPECT_EQ(t_of(in, in), 0);
}

TEST(EdgeContact, WhatItRefuses) {
  const SphereModel made = ball_and_plate();
  ExactChecker checker(made.model, made.arm, {.margin = 0});
  const std::vector<double> q{0}, two{0, 0}, none{std::nan("")};
  const auto refused = [&](std::span<const double> q0, std::span<const double> q1, double step) {
    const auto result = first_contact(checker, q0, q1, step);
    return !result && result.error().code == Errc::bad_input && !result.error().what.empty();
  };
  EXPECT_FALSE(refused(q, q, 0.1));
  EXPECT_TRUE(refused(q, two, 0.1));
  EXPECT_TRUE(refused(two, q, 0.1));
  EXPECT_TRUE(refused(q, none, 0.1));
  for (const double step : {0.0, -1.0, std::nan("")}) EXPECT_TRUE(refused(q, q, step)) << step;
  const std::vector<double> far{1};
  EXPECT_TRUE(refused(q, far, 1e-9));
}

/// MuJoCo's word against ours: an edge that is proved free has no contact, and where MuJoCo touches
/// something the edge is hit, not later.
TEST(EdgeContact, AgreesWithVerifyEdge) {
  Rng rng(61);
  std::array<int, 4> count{};
  int contacts = 0;
  const int scenes = testing::rounds(60, 2000);
  for (int round = 0; round < scenes; ++round) {
    const Arm arm = testing::random_arm(1 + round % 7, rng);
    SphereSet set = testing::random_spheres(arm, rng);
    set.links.erase(set.links.begin());  // the piece at rest, which MuJoCo leaves out
    std::erase_if(set.pairs, [](const auto& pair) { return pair[0] == 0 || pair[1] == 0; });
    for (auto& pair : set.pairs) pair = {pair[0] - 1, pair[1] - 1};
    const Obstacles world = testing::random_world(rng, 3, round % 2 == 0);
    const SphereModel made = sphere_model(arm, set, world).value();
    ExactChecker checker(made.model, made.arm, {.margin = 0});
    for (int k = 0; k < 5; ++k) {
      const JointVec q0 = testing::random_q(arm, rng);
      const JointVec q1 = q0 + rng.uniform(0, 0.5) * (testing::random_q(arm, rng) - q0);
      const VerifyResult ours = verify_edge(arm, set, world, as_span(q0), as_span(q1)).value();
      const auto theirs = first_contact(checker, as_span(q0), as_span(q1), 0.01);
      ASSERT_TRUE(theirs.has_value());
      ++count[static_cast<std::size_t>(ours.verdict)];
      if (!theirs->has_value()) continue;
      ++contacts;
      ASSERT_EQ(ours.verdict, EdgeVerdict::hit) << "round " << round;
      ASSERT_LE(ours.t, (*theirs)->t + 1e-9);
    }
  }
  EXPECT_GT(count[static_cast<std::size_t>(EdgeVerdict::free)], scenes / 2);
  EXPECT_GT(contacts, scenes / 2);
}

}  // namespace
}  // namespace mjarm
