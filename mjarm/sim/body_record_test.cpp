#include "mjarm/sim/body_record.hpp"

#include <gtest/gtest.h>

#include "mjarm/model/shipped_test.hpp"

namespace mjarm {
namespace {

/// Lets the car roll for a while, and records it.
void roll(Sim& sim, double seconds, BodyRecord& record) {
  const std::vector<double> ctrl(sim.ctrl().size(), 1);
  const double end = sim.time() + seconds;
  while (sim.time() < end) {
    ASSERT_TRUE(sim.step(ctrl));
    if (record.is_due(sim.time())) record.add(sim.snapshot());
  }
}

class Record : public ::testing::Test {
 protected:
  Model model_ = testing::shipped("car");
  Sim sim_{model_};
  BodyRecord record_{model_};
};

TEST_F(Record, HoldsAMomentEverySixtiethOfASecond) {
  record_.add(sim_.snapshot());
  roll(sim_, 1, record_);
  EXPECT_NEAR(static_cast<double>(record_.size()), 61, 1);
  for (std::size_t i = 0; i < record_.size(); ++i) {
    EXPECT_NEAR(record_.time(i), static_cast<double>(i) * BodyRecord::kInterval, model_.timestep());
  }
}

TEST_F(Record, HoldsWhereTheBodiesStood) {
  record_.add(sim_.snapshot());
  roll(sim_, 0.5, record_);
  BodyPoses poses(model_);
  const Snapshot last = sim_.snapshot();
  record_.add(last);
  ASSERT_TRUE(poses.set(last));
  const std::size_t end = record_.size() - 1;
  EXPECT_DOUBLE_EQ(record_.time(end), last.time);
  for (int i = 0; i < 3 * poses.size(); ++i) {
    EXPECT_EQ(record_.p_W(end)[static_cast<std::size_t>(i)],
              poses.p_W()[static_cast<std::size_t>(i)]);
  }
  EXPECT_EQ(record_.qpos(end).size(), static_cast<std::size_t>(model_.nq()));
  EXPECT_EQ(record_.quat(end).size(), static_cast<std::size_t>(4 * poses.size()));
}

TEST_F(Record, AnotherRunFollowsTheOneBefore) {
  record_.add(sim_.snapshot());
  roll(sim_, 0.5, record_);
  const std::size_t first = record_.size();
  ASSERT_TRUE(sim_.reset());
  EXPECT_TRUE(record_.is_due(0));
  record_.add(sim_.snapshot());
  roll(sim_, 0.5, record_);
  ASSERT_GT(record_.size(), first + 20);
  EXPECT_NEAR(record_.time(first) - record_.time(first - 1), BodyRecord::kInterval, 1e-9);
  EXPECT_NEAR(record_.time(record_.size() - 1), 1, 0.05);
}

TEST_F(Record, OfALongRunEverySecondMomentGoes) {
  Snapshot now = sim_.snapshot();
  for (int i = 0; i < 20000; ++i) {
    now.time = i * BodyRecord::kInterval;
    if (record_.is_due(now.time)) record_.add(now);
  }
  EXPECT_LE(record_.size(), BodyRecord::kMaxMoments);
  EXPECT_GE(record_.size(), BodyRecord::kMaxMoments / 2);
  EXPECT_EQ(record_.time(0), 0);
  EXPECT_NEAR(record_.time(record_.size() - 1), 20000 * BodyRecord::kInterval, 0.1);
  EXPECT_NEAR(record_.time(1), 4 * BodyRecord::kInterval, 1e-9);
}

TEST_F(Record, ASnapshotOfAnotherModelIsLeftOut) {
  record_.add({.time = 1, .state = {1, 2, 3}});
  EXPECT_TRUE(record_.empty());
}

}  // namespace
}  // namespace mjarm
