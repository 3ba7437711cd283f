#include "mjarm/collision/verify_edge.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "mjarm/collision/edge_check.hpp"
#include "mjarm/collision/edge_samples_test.hpp"
#include "mjarm/collision/problems_test.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"

namespace mjarm {
namespace {

constexpr std::array kVerifyLevels{SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512};

/// An arm, its spheres and what stands round it.
struct Scene {
  Arm arm;
  SphereSet set;
  Obstacles world;
};

VerifyResult verify(const Scene& scene, std::span<const double> q0, std::span<const double> q1,
                    const VerifyOptions& options = {}) {
  const auto result = verify_edge(scene.arm, scene.set, scene.world, q0, q1, options);
  EXPECT_TRUE(result.has_value()) << result.error().what;
  return result.value_or(VerifyResult{});
}

/// True clearance of the pair that a result names.
double clearance_of(const Scene& scene, const VerifyResult& result, std::span<const double> q) {
  SphereSet part;
  part.links = {scene.set.links[static_cast<std::size_t>(result.link)]};
  const auto solids = static_cast<int>(scene.world.solids.size());
  if (result.obstacle >= solids) {
    const Obstacles one{{},
                        {scene.world.clouds[static_cast<std::size_t>(result.obstacle - solids)]}};
    return testing::true_clearance(scene.arm, part, one, q);
  }
  if (result.obstacle >= 0) {
    const Obstacles one{{scene.world.solids[static_cast<std::size_t>(result.obstacle)]}};
    return testing::true_clearance(scene.arm, part, one, q);
  }
  part.links.push_back(scene.set.links[static_cast<std::size_t>(result.other_link)]);
  part.pairs = {{0, 1}};
  return testing::true_clearance(scene.arm, part, {}, q);
}

struct VerifyTally {
  int free = 0, hit = 0, undecided = 0;
};

/// One edge against the oracle at `samples` places.
void compare_with_samples(const Scene& scene, std::span<const double> q0,
                          std::span<const double> q1, int samples, VerifyTally& tally) {
  const VerifyResult result = verify(scene, q0, q1);
  const double least = testing::least_clearance(scene.arm, scene.set, scene.world, q0, q1, samples);
  const std::vector<double> at = testing::on_edge(q0, q1, result.t);
  const double found = clearance_of(scene, result, at);
  // Of a place inside a solid the oracle knows the depth, the distance is 0.
  ASSERT_LE(found, result.distance + 1e-10);
  if (result.verdict != EdgeVerdict::hit) {
    ASSERT_NEAR(found, result.distance, 1e-10);
  }
  switch (result.verdict) {
    case EdgeVerdict::free:
      ++tally.free;
      ASSERT_GT(least, 0) << "false proof";
      ASSERT_GT(result.distance, 0);
      break;
    case EdgeVerdict::hit:
      ++tally.hit;
      ASSERT_LT(result.distance, 0);
      break;
    default:
      ++tally.undecided;
      ASSERT_LT(std::abs(result.distance), 1e-5);
  }
}

int samples_of(std::span<const double> q0, std::span<const double> q1, double spacing) {
  double squares = 0;
  for (std::size_t i = 0; i < q0.size(); ++i) squares += (q1[i] - q0[i]) * (q1[i] - q0[i]);
  return static_cast<int>(std::ceil(std::sqrt(squares) / spacing));
}

Scene random_scene(int dof, int obstacles, bool thin, Rng& rng) {
  Scene scene{testing::random_arm(dof, rng), {}, testing::random_world(rng, obstacles, thin)};
  scene.set = testing::random_spheres(scene.arm, rng);
  for (LinkSpheres& link : scene.set.links) {
    for (Sphere& sphere : link.spheres) sphere.radius *= thin ? 0.3 : 1.0;
  }
  return scene;
}

TEST(VerifyEdge, AgreesWithDenseSamples) {
  Rng rng(41);
  VerifyTally tally;
  const int scenes = testing::rounds(50, 5000, 15);
  for (int round = 0; round < scenes; ++round) {
    const Scene scene = random_scene(1 + round % 7, 3, round % 2 == 0, rng);
    for (int k = 0; k < 10; ++k) {
      const JointVec q0 = testing::random_q(scene.arm, rng);
      const JointVec q1 = q0 + rng.uniform(0, 0.5) * (testing::random_q(scene.arm, rng) - q0);
      compare_with_samples(scene, as_span(q0), as_span(q1), 100, tally);
      if (::testing::Test::HasFatalFailure()) return;
    }
  }
  EXPECT_GT(tally.free, scenes);
  EXPECT_GT(tally.hit, scenes);
  EXPECT_LE(tally.undecided, scenes / 100);
}

/// Clouds, meshes, polytopes and height fields.
TEST(VerifyEdge, AgreesWithDenseSamplesInCrowds) {
  Rng rng(45);
  VerifyTally tally;
  int certified = 0, proved = 0;
  const int scenes = testing::rounds(20, 2000, 10);
  for (int round = 0; round < scenes; ++round) {
    Scene scene = random_scene(2 + round % 6, 1, true, rng);
    for (int k = 0; k < 2; ++k) scene.world.solids.push_back(testing::random_composite(rng));
    scene.world.clouds = {testing::random_cloud(rng, 50, 0.002)};
    const auto robot = FastRobot::create(scene.arm, scene.set).value();
    const auto checker = FastChecker::create(robot, scene.world).value();
    for (int k = 0; k < 5; ++k) {
      const JointVec q0 = testing::random_q(scene.arm, rng);
      const JointVec q1 = q0 + rng.uniform(0, 0.5) * (testing::random_q(scene.arm, rng) - q0);
      const int free = tally.free;
      compare_with_samples(scene, as_span(q0), as_span(q1), 50, tally);
      if (::testing::Test::HasFatalFailure()) return;
      if (check_edge(checker, as_span(q0), as_span(q1)).verdict != EdgeVerdict::free) continue;
      ++certified;
      proved += tally.free - free;
    }
  }
  EXPECT_GT(tally.free, scenes / 2);
  EXPECT_GT(tally.hit, scenes / 2);
  EXPECT_LE(tally.undecided, scenes / 30);
  EXPECT_GE(proved, certified - scenes / 60);
}

/// What the fast kernels certify, this code proves as well; and nothing between samples 1e-3 apart
/// speaks against it.
TEST(VerifyEdge, ProvesEveryCertifiedEdgeAmongPlatesAndWires) {
  Rng rng(42);
  const int wanted = testing::rounds(300, 100'000, 200);
  int certified = 0;
  for (int round = 0; certified < wanted; ++round) {
    const Scene scene = random_scene(2 + round % 6, 5, true, rng);
    const auto robot = FastRobot::create(scene.arm, scene.set).value();
    const auto checker = FastChecker::create(robot, scene.world, kVerifyLevels[round % 3]).value();
    if (checker.fixed_overlap()) continue;
    for (int k = 0; k < 20; ++k) {
      const JointVec q0 = testing::random_q(scene.arm, rng);
      const JointVec q1 = q0 + rng.uniform(0.02, 1) * (testing::random_q(scene.arm, rng) - q0);
      if (check_edge(checker, as_span(q0), as_span(q1)).verdict != EdgeVerdict::free) continue;
      const VerifyResult result = verify(scene, as_span(q0), as_span(q1));
      ASSERT_EQ(result.verdict, EdgeVerdict::free)
          << "edge " << certified << ": clearance " << result.distance << " at t " << result.t;
      if (++certified % testing::rounds(4, 1) != 0) continue;
      const int samples = samples_of(as_span(q0), as_span(q1), 1e-3);
      ASSERT_GT(testing::least_clearance(scene.arm, scene.set, scene.world, as_span(q0),
                                         as_span(q1), samples),
                0)
          << "false certificate";
    }
  }
}

TEST(VerifyEdge, ProvesCertifiedEdgesOfThePublicProblems) {
  MJARM_TEST_FILE(file, "motionbenchmaker/mbm_panda_public.json.gz");
  const testing::PlanningProblems all = testing::read_problems(file);
  const auto robot = FastRobot::create(all.arm, all.set).value();
  Rng rng(43);
  int certified = 0;
  const std::size_t stride = static_cast<std::size_t>(testing::rounds(20, 1));
  for (std::size_t i = 0; i < all.problems.size(); i += stride) {
    const testing::PlanningProblem& problem = all.problems[i];
    const auto checker = FastChecker::create(robot, problem.obstacles).value();
    for (int k = 0; k < 8; ++k) {
      const JointVec q0 = joint_vec(problem.start);
      const JointVec q1 = q0 + rng.uniform(0.05, 1) * (testing::random_q(all.arm, rng) - q0);
      if (check_edge(checker, as_span(q0), as_span(q1)).verdict != EdgeVerdict::free) continue;
      ++certified;
      const auto result =
          verify_edge(all.arm, all.set, problem.obstacles, as_span(q0), as_span(q1));
      ASSERT_TRUE(result.has_value());
      ASSERT_EQ(result->verdict, EdgeVerdict::free) << problem.id << " at t " << result->t;
      ASSERT_GE(result->distance, testing::least_clearance(all.arm, all.set, problem.obstacles,
                                                           as_span(q0), as_span(q1), 100) -
                                      0.01);
    }
  }
  EXPECT_GT(certified, 30);
}

/// A plate of 0.1 mm is put into the way of a tiny sphere, where samples pass it by.
TEST(VerifyEdge, FindsAPlateBetweenTwoSamples) {
  Rng rng(44);
  int missed = 0;
  const int rounds = testing::rounds(300, 10'000);
  for (int round = 0; round < rounds; ++round) {
    Scene scene{testing::random_arm(2 + round % 6, rng), {}, {}};
    const int last = scene.arm.dof() - 1;
    scene.set.links = {{"probe", last, {{testing::random_vector(rng, 0.3), 1e-5}}}};
    const JointVec q0 = testing::random_q(scene.arm, rng);
    const JointVec q1 = testing::random_q(scene.arm, rng);
    const double t = rng.uniform(0.01, 0.99);
    const auto center_at = [&](double s) {
      std::vector<Pose> X_WJ(static_cast<std::size_t>(scene.arm.dof()));
      fk_all(scene.arm, testing::on_edge(as_span(q0), as_span(q1), s), X_WJ);
      return Eigen::Vector3d(X_WJ.back() * scene.set.links[0].spheres[0].center);
    };
    Obstacle plate{"plate", {center_at(t), {}}, BoxShape{{0.05, 0.05, 5e-5}}};
    const Eigen::Vector3d along = center_at(t + 1e-6) - center_at(t - 1e-6);
    if (along.norm() < 1e-7) continue;
    plate.X_WO.R = rotation_between(Eigen::Vector3d::UnitZ(), along);
    scene.world.solids = {plate};
    const VerifyResult result = verify(scene, as_span(q0), as_span(q1));
    ASSERT_EQ(result.verdict, EdgeVerdict::hit) << "round " << round;
    ASSERT_LE(result.t, t + 1e-9);
    const double found =
        clearance_of(scene, result, testing::on_edge(as_span(q0), as_span(q1), result.t));
    ASSERT_LT(found, 0);
    ASSERT_NEAR(found, result.distance, 1e-10);
    const int samples = samples_of(as_span(q0), as_span(q1), 0.005);
    missed += testing::least_clearance(scene.arm, scene.set, scene.world, as_span(q0), as_span(q1),
                                       samples) > 0;
  }
  EXPECT_GT(missed, rounds / 2);
}

/// A probe sets out along a plate of 0.1 mm and bends into it with all the second derivative that
/// its joints have together: a bound that forgets one of their terms steps over the plate.
TEST(VerifyEdge, FindsAPlateThatTheEdgeBendsInto) {
  const testing::JointRow hinge{{0, 0, 0}, {0, 0, 0}, {0, 0, 1}, -1, 1};
  const testing::JointRow far_hinge{{1, 0, 0}, {0, 0, 0}, {0, 0, 1}, -1, 1};
  const testing::JointRow slide{{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, -1, 1, JointType::slide};
  const testing::JointRow boom{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, -1, 1, JointType::slide};
  struct Case {
    std::vector<testing::JointRow> rows;
    std::vector<double> from, way;
    Eigen::Vector3d place, toward;  // where the probe is at first, and the plate seen from there
  };
  const Case cases[] = {
      {{hinge}, {0}, {0.9}, {1, 0, 0}, {-0.02, 0, 0}},
      {{hinge, hinge}, {0, 0}, {0.4, 0.4}, {1, 0, 0}, {-0.02, 0, 0}},
      {{hinge, hinge, hinge}, {0, 0, 0}, {0.3, 0.3, 0.3}, {1, 0, 0}, {-0.02, 0, 0}},
      {{hinge, far_hinge}, {0, 0}, {0.4, 0.4}, {1, 0, 0}, {-0.02, 0, 0}},
      {{hinge, slide}, {0, 0}, {0.1, 1}, {0, 0, 0}, {-0.01, 0, 0}},
      {{hinge, boom}, {0, 1}, {0.9, 0}, {0, 0, 0}, {-0.02, 0, 0}},
  };
  for (const Case& one : cases) {
    Scene scene{testing::make_arm("bent", one.rows, Pose()), {}, {}};
    const int last = scene.arm.dof() - 1;
    scene.set.links = {{"probe", last, {{one.place, 1e-5}}}};
    std::vector<double> q1 = one.from;
    for (std::size_t i = 0; i < q1.size(); ++i) q1[i] += one.way[i];
    const Eigen::Vector3d start = fk(scene.arm, one.from) * one.place;
    scene.world.solids = {{"plate", {start + one.toward, {}}, BoxShape{{5e-5, 0.5, 0.5}}}};
    scene.world.solids[0].X_WO.R.setIdentity();
    EXPECT_EQ(verify(scene, one.from, q1).verdict, EdgeVerdict::hit) << one.rows.size();
  }
}

/// A ball of 0.1 m on a slide along x, over a floor at z = 0.
Scene ball_over_floor(double height) {
  Scene scene;
  scene.arm = testing::make_arm(
      "slider", {{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, -1, 1, JointType::slide}}, Pose());
  scene.set.links = {{"ball", 0, {{{0, 0, height + 0.1}, 0.1}}}};
  scene.world.solids = {{"floor", Pose(), HalfSpaceShape{}}};
  return scene;
}

TEST(VerifyEdge, MicronsOfClearanceAreEnoughAndNanometresOfOverlapTooMuch) {
  const std::vector<double> q0{-1}, q1{1};
  for (const double height : {1e-3, 1e-6, 1e-9, 1e-10}) {
    const VerifyResult result = verify(ball_over_floor(height), q0, q1);
    EXPECT_EQ(result.verdict, EdgeVerdict::free) << height;
    EXPECT_NEAR(result.distance, height, 1e-12);
    EXPECT_EQ(result.obstacle, 0);
    EXPECT_EQ(verify(ball_over_floor(-height), q0, q1).verdict, EdgeVerdict::hit) << height;
  }
  EXPECT_EQ(verify(ball_over_floor(0), q0, q1).verdict, EdgeVerdict::undecided);
}

TEST(VerifyEdge, AllowedDepthIsAllowed) {
  const std::vector<double> q0{-1}, q1{1};
  const Scene scene = ball_over_floor(-1e-3);
  EXPECT_EQ(verify(scene, q0, q1, {.allow_depth = 9.9e-4}).verdict, EdgeVerdict::hit);
  const VerifyResult result = verify(scene, q0, q1, {.allow_depth = 1.1e-3});
  EXPECT_EQ(result.verdict, EdgeVerdict::free);
  EXPECT_NEAR(result.distance, -1e-3, 1e-12);
}

TEST(VerifyEdge, LimitsNumbersAndEdgesOfNoLength) {
  const Scene scene = ball_over_floor(0.1);
  const std::vector<double> inside{0.5}, edge{1.00005}, out{1.001}, none{std::nan("")};
  EXPECT_EQ(verify(scene, inside, inside).verdict, EdgeVerdict::free);
  EXPECT_EQ(verify(scene, inside, edge).verdict, EdgeVerdict::free);
  EXPECT_EQ(verify(scene, inside, edge, {.limit_slack = 0}).verdict, EdgeVerdict::outside);
  for (const std::vector<double>& bad : {out, none}) {
    const VerifyResult result = verify(scene, inside, bad);
    EXPECT_EQ(result.verdict, EdgeVerdict::outside);
    EXPECT_EQ(result.t, 1);
    EXPECT_EQ(result.joint, 0);
    EXPECT_EQ(verify(scene, bad, inside).t, 0);
  }
  const Scene touching = ball_over_floor(-0.01);
  EXPECT_EQ(verify(touching, inside, inside).verdict, EdgeVerdict::hit);
}

TEST(VerifyEdge, GivesUpWhereItsLooksAreUsedUp) {
  const std::vector<double> q0{-1}, q1{1};
  Scene scene = ball_over_floor(1e-3);
  scene.arm = testing::make_arm("wheel", {{{0, 0, 1}, {0, 0, 0}, {0, 1, 0}, -2, 2}}, Pose());
  scene.set.links[0].spheres[0].center = {0, 0, -0.899};
  EXPECT_EQ(verify(scene, q0, q1).verdict, EdgeVerdict::free);
  EXPECT_EQ(verify(scene, q0, q1, {.max_looks = 1}).verdict, EdgeVerdict::undecided);
}

TEST(VerifyEdge, WhatItRefuses) {
  const Scene good = ball_over_floor(1);
  const std::vector<double> q{0}, two{0, 0};
  const auto refused = [&](const Scene& scene, std::span<const double> q1,
                           const VerifyOptions& options = {}) {
    const auto result = verify_edge(scene.arm, scene.set, scene.world, q, q1, options);
    return !result && result.error().code == Errc::bad_input && !result.error().what.empty();
  };
  EXPECT_FALSE(refused(good, q));
  EXPECT_TRUE(refused(good, two));
  EXPECT_TRUE(refused(good, {}));
  EXPECT_TRUE(refused(good, q, {.allow_depth = -1}));
  EXPECT_TRUE(refused(good, q, {.limit_slack = std::nan("")}));
  EXPECT_TRUE(refused(good, q, {.least_step = 0}));
  EXPECT_TRUE(refused(good, q, {.max_looks = 0}));
  Scene bad = good;
  bad.set.links[0].joint = 3;
  EXPECT_TRUE(refused(bad, q));
  bad = good;
  bad.world.solids[0].shape = BallShape{-1};
  EXPECT_TRUE(refused(bad, q));
}

}  // namespace
}  // namespace mjarm
