#include "mjarm/session/arm_figures.hpp"

#include <gtest/gtest.h>

#include "mjarm/model/shipped_test.hpp"

namespace mjarm::session {
namespace {

using mjarm::testing::shipped_arm;
using mjarm::testing::TestArm;

constexpr int kFirst = 500;

std::size_t points(const ArmFigures& figures) {
  return figures.plots().at(0).series.at(0).x.size();
}

class Figures : public ::testing::Test {
 protected:
  void add(int count, double period = 0.01) {
    for (int i = 0; i < count; ++i) figures_.add(sim_, time_ += period, robot_.arm, {});
  }
  TestArm robot_ = shipped_arm("ur5e");
  Sim sim_{robot_.model};
  ArmFigures figures_{robot_.arm, kFirst, {true}};
  double time_ = 0;
};

TEST_F(Figures, TheUserChoosesWhichAreShown) {
  const view::PanelSection section = figures_.section();
  ASSERT_EQ(section.items.size(), kLiveFigures);
  EXPECT_TRUE(std::get<view::PanelCheckbox>(section.items[0].what).on);
  EXPECT_FALSE(std::get<view::PanelCheckbox>(section.items[1].what).on);
  EXPECT_EQ(figures_.plots().size(), 1U);
  for (int i = 0; i < static_cast<int>(kLiveFigures); ++i) {
    EXPECT_EQ(section.items[static_cast<std::size_t>(i)].id, kFirst + i);
    EXPECT_TRUE(figures_.handle({kFirst + i, i < 4 ? 1.0 : 0.0}));
  }
  EXPECT_EQ(figures_.plots().size(), 4U);
  EXPECT_FALSE(figures_.handle({kFirst - 1, 1}));
  EXPECT_FALSE(figures_.handle({kFirst + static_cast<int>(kLiveFigures), 1}));
}

TEST_F(Figures, TakeARowEveryTenMilliseconds) {
  add(9, 0.001);
  EXPECT_EQ(points(figures_), 1U);
  add(2, 0.001);
  EXPECT_EQ(points(figures_), 2U);
  figures_.clear();
  add(3, 0.1);
  EXPECT_EQ(points(figures_), 3U);
}

/// A simulation that begins anew, or is looked back at, is not waited for.
TEST_F(Figures, GoOnWhenTimeGoesBack) {
  add(100, 0.1);
  time_ = 0;
  add(5, 0.1);
  EXPECT_EQ(points(figures_), 5U);
  EXPECT_NEAR(figures_.plots().at(0).series.at(0).x.back(), 0.5, 1e-9);
}

}  // namespace
}  // namespace mjarm::session
