#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cstdint>

#include "mjarm/collision/cover_robots_test.hpp"
#include "mjarm/collision/exact.hpp"
#include "mjarm/collision/exact_arm_bodies_internal.hpp"
#include "mjarm/collision/fast_check.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"

/// Covers against MuJoCo: never free where MuJoCo sees a contact, never in collision where
/// everything is farther away than the cover sticks out.
namespace mjarm {
namespace {

using testing::CoveredRobot;

/// Whether MuJoCo itself reports an overlap that the arm's joints can change.
class ForwardContacts {
 public:
  explicit ForwardContacts(const CoveredRobot& robot)
      : m_(*robot.model.raw()), bodies_(m_, robot.arm), d_(mj_makeData(&m_), mj_deleteData) {
    const std::vector<double> rest = detail::rest_configuration(m_);
    std::copy(rest.begin(), rest.end(), d_->qpos);
  }

  bool any(std::span<const double> q) {
    for (std::size_t i = 0; i < q.size(); ++i) d_->qpos[bodies_.addresses[i]] = q[i];
    mj_kinematics(&m_, d_.get());
    mj_comPos(&m_, d_.get());
    mj_collision(&m_, d_.get());
    for (int k = 0; k < d_->ncon; ++k) {
      const mjContact& contact = d_->contact[k];
      if (contact.dist < 0 && piece(contact.geom[0]) != piece(contact.geom[1])) return true;
    }
    return false;
  }

 private:
  int piece(int geom) const {
    return bodies_.pieces[static_cast<std::size_t>(m_.geom_bodyid[geom])];
  }
  const mjModel& m_;
  detail::ArmBodies bodies_;
  std::unique_ptr<mjData, void (*)(mjData*)> d_;
};

struct CoverTally {
  int states = 0, hit = 0, overstated = 0;
};

/// @param is_scene_exact  every geom that stands has a solid of its own kind.
void compare_with_exact(const CoveredRobot& robot, int states, std::uint64_t seed,
                        CoverTally& tally, bool is_scene_exact = true,
                        const CoverOptions& options = {}) {
  const auto cover = cover_model(robot.model, robot.arm, options);
  ASSERT_TRUE(cover.has_value()) << cover.error().what;
  const auto fast = FastRobot::create(robot.arm, cover->spheres);
  ASSERT_TRUE(fast.has_value()) << fast.error().what;
  const auto checker = FastChecker::create(*fast, cover->scene);
  ASSERT_TRUE(checker.has_value()) << checker.error().what;
  const double reach = 2 * (cover->bound + fast->padding()) + 1e-4;
  ExactChecker exact(robot.model, robot.arm, {.margin = reach});
  ForwardContacts forward(robot);
  Rng rng(seed);
  constexpr int kBatch = 512;
  std::vector<double> rows;
  std::vector<std::uint8_t> free(kBatch);
  for (int done = 0; done < states; done += kBatch) {
    rows.clear();
    for (int k = 0; k < kBatch; ++k) {
      const JointVec q = testing::random_q(robot.arm, rng);
      rows.insert(rows.end(), q.data(), q.data() + q.size());
    }
    checker->check(rows, free);
    const auto dof = static_cast<std::size_t>(robot.arm.dof());
    for (std::size_t k = 0; k < kBatch; ++k) {
      const std::span<const double> q(rows.data() + k * dof, dof);
      ++tally.states;
      const bool really_free = exact.is_free(q);
      if (free[k] != 0) {
        ASSERT_TRUE(really_free) << describe(*exact.check(q));
        ASSERT_FALSE(forward.any(q));
        continue;
      }
      ++tally.hit;
      if (!really_free) continue;
      ++tally.overstated;
      if (!is_scene_exact) continue;
      const auto report = exact.check(q);
      ASSERT_TRUE(report->nearest.has_value()) << "in collision, and nothing within " << reach;
    }
  }
}

void record(const CoverTally& tally) {
  ::testing::Test::RecordProperty("states", tally.states);
  ::testing::Test::RecordProperty("called_colliding", tally.hit);
  ::testing::Test::RecordProperty("though_free", tally.overstated);
  std::printf("%d states, %d called in collision, %d of them free\n", tally.states, tally.hit,
              tally.overstated);
  EXPECT_GT(tally.states - tally.hit, tally.states / 50);
  EXPECT_GT(tally.hit - tally.overstated, tally.states / 50);
}

void compare_robot(const CoveredRobot& robot, std::uint64_t seed) {
  CoverTally tally;
  compare_with_exact(robot, testing::rounds(10'000, 1'000'000), seed, tally);
  record(tally);
}

TEST(CoverAgainstMujoco, Ur5e) { compare_robot(testing::covered_robot("ur5e"), 301); }
TEST(CoverAgainstMujoco, Panda) { compare_robot(testing::covered_robot("panda"), 302); }
TEST(CoverAgainstMujoco, PandaFromUrdf) {
  const auto scene = find_model_file("panda").value();
  compare_robot(testing::covered_file(scene.parent_path() / "panda.urdf"), 303);
}
TEST(CoverAgainstMujoco, Ur5eFromUrdf) {
  const auto scene = find_model_file("ur5e").value();
  compare_robot(testing::covered_file(scene.parent_path() / "ur5e.urdf"), 304);
}

TEST(CoverAgainstMujoco, RandomTrees) {
  const support::TempFolder folder;
  Rng rng(305);
  CoverTally tally;
  for (int round = 0; round < testing::rounds(12, 400); ++round) {
    const CoveredRobot robot =
        testing::covered_file(folder.write("tree.xml", testing::random_tree(rng)), "tip");
    compare_with_exact(robot, testing::rounds(1'000, 2'500), rng.next(), tally, false,
                       {.bound = 0.02});
    ASSERT_FALSE(HasFatalFailure()) << "round " << round;
  }
  record(tally);
}

}  // namespace
}  // namespace mjarm
