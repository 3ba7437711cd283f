#include "mjarm/collision/sphere_model.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "mjarm/collision/exact.hpp"
#include "mjarm/collision/problems_test.hpp"
#include "mjarm/collision/random_scene_test.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"

namespace mjarm {
namespace {

TEST(SphereModel, CollidesWhereTheOracleSaysSo) {
  Rng rng(51);
  int free = 0, hit = 0;
  const int scenes = testing::rounds(100, 3000);
  for (int round = 0; round < scenes; ++round) {
    const Arm arm = testing::random_arm(1 + round % 7, rng);
    const SphereSet set = testing::random_spheres(arm, rng);
    Obstacles world = testing::random_world(rng, 3, round % 2 == 0);
    world.clouds = {testing::random_cloud(rng, 10, 0.01)};
    const auto made = sphere_model(arm, set, world);
    ASSERT_TRUE(made.has_value()) << made.error().what;
    ExactChecker checker(made->model, made->arm, {.margin = 0});
    for (int k = 0; k < 30; ++k) {
      const JointVec q = testing::random_q(arm, rng);
      const double truth = testing::true_clearance(arm, set, world, as_span(q), true);
      const auto report = checker.check(as_span(q));
      ASSERT_TRUE(report.has_value());
      if (std::abs(truth) > 1e-9) {
        ASSERT_EQ(report->free, truth > 0) << "round " << round << ", clearance " << truth;
      }
      ++(report->free ? free : hit);
    }
  }
  EXPECT_GT(free, scenes);
  EXPECT_GT(hit, scenes);
}

/// The same places, but nothing collides, and the arm can be seen without its spheres.
TEST(SphereModel, ForPicturesNothingCollides) {
  Rng rng(52);
  for (int dof = 1; dof <= 7; ++dof) {
    const Arm arm = testing::random_arm(dof, rng);
    const SphereSet set = testing::random_spheres(arm, rng);
    Obstacles world = testing::random_world(rng, 4);
    world.clouds = {testing::random_cloud(rng, 10, 0.01)};
    const auto plain = sphere_model(arm, set, world);
    const SphereModelLook look{.see_through = {1}};
    const auto made = sphere_model(arm, set, world, &look);
    ASSERT_TRUE(made.has_value()) << made.error().what;
    EXPECT_EQ(made->parts, plain->parts);
    const mjModel& m = *made->model.raw();
    EXPECT_EQ(m.npair, 0);
    for (int solid = 0; solid < 4; ++solid) {
      const int geom = mj_name2id(&m, mjOBJ_GEOM, ("o" + std::to_string(solid)).c_str());
      EXPECT_EQ(m.geom_rgba[4 * geom + 3] < 1, solid == 1);
    }
    EXPECT_GT(m.nlight, 0);
    int spheres = 0, rods = 0;
    for (int geom = 0; geom < m.ngeom; ++geom) {
      EXPECT_EQ(m.geom_contype[geom] | m.geom_conaffinity[geom], 0);
      spheres += m.geom_group[geom] == 3 ? 1 : 0;
      rods += m.geom_group[geom] == 1 ? 1 : 0;
    }
    EXPECT_EQ(spheres, static_cast<int>(set.size()));
    EXPECT_GT(rods, 0);
    EXPECT_LE(rods, dof + 1);
  }
}

TEST(SphereModel, ContactsAreTracedToLinkAndObstacle) {
  const Arm arm = testing::make_arm(
      "slider", {{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, -1, 1, JointType::slide}}, Pose());
  SphereSet set;
  // Names may be anything, and the same twice.
  set.links = {{"<post> & \"co\"", -1, {{{0.6, 0, 0}, 0.1}}},
               {"tool", 0, {{{0, 0, 0}, 0.05}, {{0, 0, 0.2}, 0.05}}},
               {"tool", 0, {{{0, 0, 0.4}, 0.05}}}};
  set.pairs = {{0, 1}};
  Obstacles world{{{"wall", {{-0.6, 0, 0}, Eigen::Matrix3d::Identity()}, BoxShape{{0.1, 1, 1}}},
                   {"", {{5, 0, 0}, Eigen::Matrix3d::Identity()}, CapsuleShape{0.1, 0}}}};
  const auto made = sphere_model(arm, set, world);
  ASSERT_TRUE(made.has_value()) << made.error().what;
  ExactChecker checker(made->model, made->arm, {.margin = 0});
  const auto parts_at = [&](double x) {
    std::set<std::string> parts;
    const CollisionReport report = checker.check(std::vector<double>{x}).value();
    for (const ContactPoint& contact : report.contacts) {
      parts.insert(made->parts.at(contact.pair.geom1));
      parts.insert(made->parts.at(contact.pair.geom2));
    }
    return parts;
  };
  EXPECT_EQ(parts_at(0), (std::set<std::string>{}));
  EXPECT_EQ(parts_at(0.5), (std::set<std::string>{"<post> & \"co\"", "tool"}));
  EXPECT_EQ(parts_at(-0.5), (std::set<std::string>{"wall", "tool"}));
}

TEST(SphereModel, WhatIsRefused) {
  const Arm arm = testing::panda();
  SphereSet set;
  EXPECT_EQ(sphere_model(arm, set, {}).error().code, Errc::bad_input);
  set.links = {{"hand", 6, {{Eigen::Vector3d::Zero(), 0.05}}}};
  EXPECT_TRUE(sphere_model(arm, set, {}).has_value());
  const Obstacles bad{{{"dot", Pose(), BallShape{0}}}};
  EXPECT_NE(sphere_model(arm, set, bad).error().what.find("dot"), std::string::npos);
  const Obstacles hull{{{"hull", Pose(), PolytopeShape{{{0, 0, 1, 0}}, {-1, -1, -1}, {1, 1, 1}}}}};
  const auto refused = sphere_model(arm, set, hull);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::not_available);
  EXPECT_NE(refused.error().what.find("hull"), std::string::npos);
}

TEST(SphereModel, StartsOfThePublicProblems) {
  MJARM_TEST_FILE(file, "motionbenchmaker/mbm_panda_public.json.gz");
  const testing::PlanningProblems all = testing::read_problems(file);
  int looked = 0;
  for (std::size_t i = 0; i < all.problems.size(); i += 10) {
    const testing::PlanningProblem& problem = all.problems[i];
    const auto made = sphere_model(all.arm, all.set, problem.obstacles);
    ASSERT_TRUE(made.has_value()) << problem.id << ": " << made.error().what;
    ExactChecker checker(made->model, made->arm, {.margin = 0});
    EXPECT_EQ(checker.is_free(problem.start), problem.start_free) << problem.id;
    for (std::size_t k = 0; k < problem.goals.size(); ++k) {
      ++looked;
      EXPECT_EQ(checker.is_free(problem.goals[k]), problem.goals_free[k]) << problem.id;
    }
  }
  EXPECT_GE(looked, 35);
}

}  // namespace
}  // namespace mjarm
