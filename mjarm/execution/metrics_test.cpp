#include "mjarm/execution/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mjarm/core/rotation.hpp"

namespace mjarm {
namespace {

Curve x_axis_metre() {
  Pose to;
  to.p.x() = 1;
  return *Curve::line(Pose{}, to);
}

TEST(MeasurePath, PerfectRunHasNoErrorAndFullCoverage) {
  const Curve curve = *Curve::ellipse({.a = 0.3, .b = 0.15});
  std::vector<Eigen::Vector3d> p_W;
  for (int i = 0; i <= 2000; ++i) p_W.push_back(curve.at(curve.length() * i / 2000).p);
  const PathError error = path_error(curve, p_W);
  EXPECT_LT(error.max, 1e-9);
  EXPECT_LE(error.rms, error.max);
  EXPECT_EQ(error.coverage, 1.0);
}

TEST(MeasurePath, OffsetIsTheError) {
  std::vector<Eigen::Vector3d> p_W;
  for (int i = 0; i <= 100; ++i) p_W.emplace_back(0.01 * i, 0.0003, 0.0004);
  const PathError error = path_error(x_axis_metre(), p_W);
  EXPECT_NEAR(error.max, 0.0005, 1e-12);
  EXPECT_NEAR(error.rms, 0.0005, 1e-12);
  EXPECT_EQ(error.coverage, 1.0);
}

TEST(MeasurePath, WorstPlaceIsNamed) {
  std::vector<Eigen::Vector3d> p_W;
  for (int i = 0; i <= 100; ++i) p_W.emplace_back(0.01 * i, i == 70 ? 0.001 : 0.0, 0.0);
  const PathError error = path_error(x_axis_metre(), p_W);
  EXPECT_NEAR(error.max, 0.001, 1e-12);
  EXPECT_NEAR(error.at, 0.7, 1e-9);
  EXPECT_NEAR(error.rms, 0.001 / std::sqrt(101), 1e-12);
}

TEST(MeasurePath, ToolThatNeverMovedCoversNextToNothing) {
  const std::vector<Eigen::Vector3d> p_W(500, Eigen::Vector3d::Zero());
  const PathError error = path_error(x_axis_metre(), p_W);
  EXPECT_LT(error.max, 1e-12);
  EXPECT_LT(error.coverage, 0.01);
}

TEST(MeasurePath, HalfARunCoversHalf) {
  std::vector<Eigen::Vector3d> p_W;
  for (int i = 0; i <= 50; ++i) p_W.emplace_back(0.01 * i, 0, 0);
  EXPECT_NEAR(path_error(x_axis_metre(), p_W).coverage, 0.5, 0.01);
}

TEST(MeasurePath, GapIsNotCovered) {
  std::vector<Eigen::Vector3d> p_W;
  for (int i = 0; i <= 40; ++i) p_W.emplace_back(0.01 * i, 0, 0);
  p_W.emplace_back(0.5, 0.2, 0);  // a detour over the middle fifth
  for (int i = 60; i <= 100; ++i) p_W.emplace_back(0.01 * i, 0, 0);
  const double coverage = path_error(x_axis_metre(), p_W).coverage;
  EXPECT_GT(coverage, 0.78);
  EXPECT_LT(coverage, 0.83);
}

TEST(MeasurePath, NothingExecuted) { EXPECT_EQ(path_error(x_axis_metre(), {}).coverage, 0.0); }

TEST(PoseError, PositionAndAngle) {
  Pose goal;
  Pose tool;
  tool.p = {0.03, 0, 0.04};
  tool.R = from_euler({0, 0, 0.2});
  const PoseError error = pose_error(goal, tool);
  EXPECT_NEAR(error.position, 0.05, 1e-15);
  EXPECT_NEAR(error.rotation, 0.2, 1e-14);
}

}  // namespace
}  // namespace mjarm
