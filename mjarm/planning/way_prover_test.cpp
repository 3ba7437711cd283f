// What is proved beside planned paths, against exact geometry.
#include "mjarm/planning/way_prover.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "mjarm/collision/exact.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/planning/planning_world.hpp"
#include "mjarm/planning/slider_test.hpp"

namespace mjarm {
namespace {

JointVec at(double x, double z) { return joint_vec(std::vector{x, z}); }

class WayProverTest : public ::testing::Test {
 protected:
  PlannedPath planned(const JointVec& from, const JointVec& to, double clearance) {
    return world_.plan(as_span(from), std::vector{to}, {.clearance = clearance}).value();
  }
  /// [m] by MuJoCo's own geometry, every half millimetre.
  double exact_clearance(const JointVec& from, const JointVec& to) {
    double least = 1;
    const int samples = 1 + static_cast<int>((to - from).norm() / 5e-4);
    for (int k = 0; k <= samples; ++k) {
      const auto report = checker_.check(as_span(from + (to - from) * k / samples)).value();
      if (!report.free) return -1;
      if (report.nearest) least = std::min(least, report.nearest->distance);
    }
    return least;
  }

  Robot robot_ = testing::slider(0.3);
  PlanningWorld world_ = PlanningWorld::create(robot_).value();
  ExactChecker checker_{robot_.model, robot_.arm, {.margin = 1}};
};

TEST_F(WayProverTest, RefusesWhatLeadsIntoTheFenceOrBeyondALimit) {
  const PlannedPath path = planned(at(-0.4, 0.1), at(0.4, 0.1), 0.01);
  const WayProver prover = world_.prover(std::vector{path}).value();
  for (std::size_t i = 1; i < path.q.size(); ++i) {
    EXPECT_TRUE(prover.is_proved(path.q[i - 1], path.q[i])) << i;
  }
  EXPECT_FALSE(prover.is_proved(at(-0.2, 0.3), at(0.2, 0.05)));
  EXPECT_FALSE(prover.is_proved(at(-0.4, 0.1), at(-0.7, 0.1)));
  EXPECT_TRUE(prover.is_free(at(-0.0401, 0.1)));
  EXPECT_FALSE(prover.is_free(at(-0.0399, 0.1))) << "9.9 mm from the fence";
}

/// The ball passes the fence 20 mm beside what it has to keep.
TEST_F(WayProverTest, ProvesWhatLiesBesideAWay) {
  const PlannedPath path = planned(at(-0.4, 0.1), at(0.4, 0.1), 0.01);
  const WayProver prover = world_.prover(std::vector{path}).value();
  const auto is_proved = [&](double x, double z) {
    return prover.is_proved(at(-0.06, 0.05), at(-0.06, 0.1), at(x, z));
  };
  EXPECT_TRUE(is_proved(0.0195, 0));
  EXPECT_TRUE(is_proved(0, 0.0195));
  EXPECT_FALSE(is_proved(0.0205, 0)) << "the fence";
  EXPECT_FALSE(is_proved(0, 0.0205)) << "the table";
  EXPECT_FALSE(prover.is_proved(at(-0.59, 0.3), at(-0.5, 0.3), at(0.011, 0))) << "a limit";
}

/// What is proved keeps the clearance, and what keeps a little more than it is proved.
TEST_F(WayProverTest, ProvesWhatKeepsTheClearanceAndNothingElse) {
  constexpr double kClearance = 0.02, kNearly = 1e-3;
  const PlannedPath path = planned(at(-0.4, 0.1), at(0.4, 0.1), kClearance);
  const WayProver prover = world_.prover(std::vector{path}).value();
  Rng rng(1, 1);
  int proved = 0, refused = 0;
  for (int k = 0; k < 300; ++k) {
    const JointVec from = at(1.0 * rng.uniform() - 0.5, 0.03 + 0.25 * rng.uniform());
    const JointVec to = from + at(0.2 * rng.uniform() - 0.1, 0.2 * rng.uniform() - 0.1);
    const double exact = exact_clearance(from, to);
    if (prover.is_proved(from, to)) {
      EXPECT_GE(exact, kClearance - 1e-6);
      ++proved;
    } else {
      EXPECT_LT(exact, kClearance + kNearly);
      ++refused;
    }
  }
  EXPECT_GT(proved, 50);
  EXPECT_GT(refused, 50);
}

/// The ball begins 4 mm above the table: near there, and only there, as little will do.
TEST_F(WayProverTest, LessWillDoNearAnEndThatHasLess) {
  const JointVec low = at(-0.4, 0.024);
  const PlannedPath path = planned(low, at(0.4, 0.15), 0.03);
  const WayProver prover = world_.prover(std::vector{path}).value();
  const auto is_proved = [&](const JointVec& from, const JointVec& way) {
    return prover.is_proved(from, JointVec(from + way));
  };
  EXPECT_TRUE(is_proved(low, at(0.005, 0.002)));
  EXPECT_TRUE(prover.is_free(low));
  EXPECT_FALSE(is_proved(low, at(0.002, -0.003))) << "nearer than the end";
  EXPECT_FALSE(is_proved(low + at(0.2, 0), at(0.01, 0))) << "elsewhere";
}

}  // namespace
}  // namespace mjarm
