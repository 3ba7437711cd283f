#include "mjarm/render/overlay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include "mjarm/render/overlay_internal.hpp"
#include "mjarm/render/overlay_shapes.hpp"
#include "mjarm/render/polyline.hpp"
#include "mjarm/render/scene.hpp"
#include "mjarm/render/trail.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::render {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

/// A hinge arm of two links, and a ball beside it.
constexpr const char* kTwoLinks = R"(
<mujoco model="two">
  <worldbody>
    <geom name="floor" type="plane" size="2 2 0.1"/>
    <body name="upper" pos="0 0 0.5">
      <joint name="a" axis="0 1 0"/>
      <geom name="upper" type="capsule" fromto="0 0 0 0.4 0 0" size="0.05" rgba="1 0 0 1"/>
      <body name="lower" pos="0.4 0 0">
        <joint name="b" axis="0 1 0"/>
        <geom name="lower" type="capsule" fromto="0 0 0 0.3 0 0" size="0.04" rgba="1 0 0 1"/>
        <site name="tool" pos="0.3 0 0"/>
      </body>
    </body>
    <body name="ball" pos="0 1 1"><freejoint/><geom type="sphere" size="0.1"/></body>
  </worldbody>
</mujoco>)";

class OverlayScene : public ::testing::Test {
 protected:
  void SetUp() override {
    Result<Model> loaded = Model::load(folder_.write("two.xml", kTwoLinks));
    ASSERT_TRUE(loaded) << loaded.error().what;
    scene_ = std::make_unique<Scene>(*loaded, RenderQuality::low);
    scene_->update({});
    bare_ = scene_->raw().ngeom;
  }
  /// The geoms that an overlay adds.
  std::vector<mjvGeom> added(const Overlay& overlay) {
    scene_->update(overlay);
    const mjvScene& raw = scene_->raw();
    EXPECT_LE(raw.ngeom, raw.maxgeom);
    return {raw.geoms + bare_, raw.geoms + raw.ngeom};
  }
  std::map<int, int> kinds(const Overlay& overlay) {
    std::map<int, int> count;
    for (const mjvGeom& geom : added(overlay)) ++count[geom.type];
    return count;
  }
  support::TempFolder folder_;
  std::unique_ptr<Scene> scene_;
  int bare_ = 0;
};

/// A zigzag, of which no point can be left out.
OverlayLine line_of(std::size_t pieces) {
  OverlayLine line;
  for (std::size_t i = 0; i <= pieces; ++i) {
    line.points_W.emplace_back(0.01 * static_cast<double>(i), i % 2 == 0 ? 0 : 0.01, 1);
  }
  return line;
}

TEST_F(OverlayScene, SolidsStandWhereTheyAreAsked) {
  Overlay overlay;
  const Pose X = {{0.1, 0.2, 0.3}, Eigen::AngleAxisd(0.4, Vector3d(1, 2, 2) / 3).matrix()};
  overlay.ellipsoids.push_back({.X_WE = X, .semi_axes = {0.3, 0.2, 0.1}});
  overlay.boxes.push_back({.X_WB = X, .half_sizes = {0.3, 0.2, 0.1}});
  overlay.capsules.push_back({.from_W = {0, 0, 0}, .to_W = {0, 0, 2}, .radius = 0.1});
  const std::vector<mjvGeom> geoms = added(overlay);
  ASSERT_EQ(geoms.size(), 3U);
  EXPECT_EQ(geoms[0].type, mjGEOM_ELLIPSOID);
  EXPECT_EQ(geoms[1].type, mjGEOM_BOX);
  for (int k = 0; k < 2; ++k) {
    for (int i = 0; i < 3; ++i) {
      EXPECT_FLOAT_EQ(geoms[k].pos[i], static_cast<float>(X.p[i]));
      EXPECT_FLOAT_EQ(geoms[k].size[i], static_cast<float>(0.3 - 0.1 * i));
      for (int j = 0; j < 3; ++j) {
        EXPECT_FLOAT_EQ(geoms[k].mat[3 * i + j], static_cast<float>(X.R(i, j)));
      }
    }
    EXPECT_EQ(geoms[k].castshadow, 0);
  }
  EXPECT_EQ(geoms[2].type, mjGEOM_CAPSULE);
  EXPECT_FLOAT_EQ(geoms[2].pos[2], 1);
  EXPECT_FLOAT_EQ(geoms[2].size[0], 0.1F);
  EXPECT_FLOAT_EQ(geoms[2].size[2], 1);
}

TEST_F(OverlayScene, AFlatEllipsoidStaysVisibleAndAnEmptyOneIsNothing) {
  Overlay overlay;
  overlay.ellipsoids.push_back({.semi_axes = {0.2, 0.1, 0}});
  overlay.ellipsoids.push_back({.semi_axes = {0, 0, 0}});
  const std::vector<mjvGeom> geoms = added(overlay);
  ASSERT_EQ(geoms.size(), 1U);
  EXPECT_GT(geoms[0].size[2], 0);
  EXPECT_LT(geoms[0].size[2], 0.001F);
}

TEST_F(OverlayScene, LongLinesAreThinShortOnesTubes) {
  Overlay overlay;
  overlay.lines = {line_of(2000), line_of(100)};
  EXPECT_EQ(kinds(overlay), (std::map<int, int>{{mjGEOM_CAPSULE, 100}, {mjGEOM_LINE, 2000}}));
  overlay.lines[0].look = LineLook::tube;
  overlay.lines[1].look = LineLook::thin;
  EXPECT_EQ(kinds(overlay), (std::map<int, int>{{mjGEOM_CAPSULE, 2000}, {mjGEOM_LINE, 100}}));
}

TEST_F(OverlayScene, SegmentsAreSeparate) {
  Overlay overlay;
  overlay.segments.push_back({.ends_W = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {5, 5, 5}}});
  EXPECT_EQ(added(overlay).size(), 2U);
}

TEST_F(OverlayScene, TooMuchIsThinnedEvenlyAndSaid) {
  Overlay overlay;
  EXPECT_EQ(overlay_notice(overlay), "");
  OverlaySegments& tree = overlay.segments.emplace_back();
  constexpr int kEdges = 100000;
  for (int i = 0; i < kEdges; ++i) {
    tree.ends_W.emplace_back(i, 0, 0);
    tree.ends_W.emplace_back(i, 0.5, 0);
  }
  overlay.labels.push_back({{0, 0, 0}, "goal"});
  overlay.frames.push_back({});
  EXPECT_EQ(shapes_of(overlay), kEdges + 4U);
  EXPECT_THAT(overlay_notice(overlay), HasSubstr("100004"));
  const std::vector<mjvGeom> geoms = added(overlay);
  EXPECT_EQ(geoms.size(), kMaxOverlayShapes);
  int tenths[10] = {0};
  std::map<int, int> count;
  for (const mjvGeom& geom : geoms) {
    ++count[geom.type];
    if (geom.type == mjGEOM_LINE) ++tenths[static_cast<int>(geom.pos[0]) / (kEdges / 10)];
  }
  EXPECT_EQ(count[mjGEOM_LABEL], 1);
  EXPECT_EQ(count[mjGEOM_CAPSULE], 3) << "the frame";
  for (const int tenth : tenths) EXPECT_NEAR(tenth, static_cast<int>(kMaxOverlayShapes) / 10, 2);
}

TEST_F(OverlayScene, AThinnedLineStaysConnected) {
  Overlay overlay;
  overlay.lines = {line_of(50001)};
  const std::vector<mjvGeom> geoms = added(overlay);
  ASSERT_EQ(geoms.size(), kMaxOverlayShapes);
  // A thin line begins at its position and runs along its z axis.
  Vector3d end = {0, 0, 1};
  for (const mjvGeom& geom : geoms) {
    const Vector3d begin(geom.pos[0], geom.pos[1], geom.pos[2]);
    EXPECT_LT((begin - end).norm(), 1e-3);
    end = begin + geom.size[2] * Vector3d(geom.mat[2], geom.mat[5], geom.mat[8]);
  }
  EXPECT_NEAR(end.x(), 500.01, 0.03);
}

TEST_F(OverlayScene, WhatIsNoNumberIsLeftOut) {
  const double nan = std::nan("");
  const double inf = std::numeric_limits<double>::infinity();
  Overlay overlay;
  overlay.spheres.push_back({{nan, 0, 0}, 0.1, {}});
  overlay.lines.push_back({.points_W = {{0, 0, 0}, {inf, 0, 0}, {1, nan, 0}}});
  overlay.arrows.push_back({.to_W = {0, 0, inf}});
  overlay.labels.push_back({{0, nan, 0}, "x"});
  overlay.boxes.push_back({.half_sizes = {nan, 1, 1}});
  overlay.ellipsoids.push_back({.semi_axes = {nan, nan, nan}});
  overlay.capsules.push_back({.from_W = {nan, 0, 0}});
  overlay.lines.push_back({.points_W = {{0, 0, 0}, {nan, 0, 0}}, .dash = 0.1});
  overlay.ghosts.push_back({.qpos_index = {0}, .qpos = {nan}});
  overlay.ghosts.push_back({.qpos_index = {0, 1}, .qpos = {1}});
  EXPECT_TRUE(added(overlay).empty());
}

TEST_F(OverlayScene, AGhostIsWhatMovesOnceMore) {
  Overlay overlay;
  overlay.ghosts.push_back({.qpos_index = {1}, .qpos = {1.0}, .color = {0, 1, 0, 0.3F}});
  const std::vector<mjvGeom> lower = added(overlay);
  ASSERT_EQ(lower.size(), 1U) << "the upper link is where it was, the ball and floor too";
  EXPECT_FLOAT_EQ(lower[0].rgba[1], 1);
  EXPECT_FLOAT_EQ(lower[0].rgba[3], 0.3F);
  EXPECT_EQ(lower[0].castshadow, 0);
  // Turned by 1 rad about y, the middle of the lower link is below the elbow,
  // but for the 2 mm towards the camera.
  EXPECT_NEAR(lower[0].pos[0], 0.4 + 0.15 * std::cos(1.0), 2.1e-3);
  EXPECT_NEAR(lower[0].pos[2], 0.5 - 0.15 * std::sin(1.0), 2.1e-3);
  overlay.ghosts = {{.qpos_index = {0}, .qpos = {1.0}}};
  EXPECT_EQ(added(overlay).size(), 2U);
  overlay.ghosts = {{.qpos_index = {0}, .qpos = {0.0}}};
  EXPECT_TRUE(added(overlay).empty()) << "nothing flickers where the ghost stands in the robot";
  overlay.ghosts = {{.qpos_index = {-1, 1000}, .qpos = {1, 1}}};
  EXPECT_TRUE(added(overlay).empty());
  overlay.ghosts.assign(100, {.qpos_index = {0}, .qpos = {1.0}});
  EXPECT_EQ(added(overlay).size(), 2 * kMaxGhosts);
}

TEST_F(OverlayScene, AGhostLeavesTheStateAlone) {
  Overlay overlay;
  overlay.ghosts.push_back({.qpos_index = {0, 1}, .qpos = {1.0, 0.5}});
  added(overlay);
  scene_->update({});
  ASSERT_EQ(scene_->raw().ngeom, bare_);
  for (int i = 0; i < bare_; ++i) EXPECT_GT(scene_->raw().geoms[i].rgba[3], 0.99F);
}

TEST(Overlays, AreAppendedWithAllTheyHold) {
  Overlay one;
  one.spheres.emplace_back();
  one.lines = {line_of(3)};
  one.arrows.emplace_back();
  one.frames.emplace_back();
  one.labels.emplace_back();
  one.ellipsoids.emplace_back();
  one.boxes.emplace_back();
  one.capsules.emplace_back();
  one.segments.push_back({.ends_W = {{0, 0, 0}, {1, 0, 0}}});
  one.ghosts.emplace_back();
  EXPECT_EQ(shapes_of(one), 1U + 3 + 1 + 3 + 1 + 1 + 1 + 1 + 1);
  Overlay sum;
  append(sum, one);
  append(sum, one);
  EXPECT_EQ(shapes_of(sum), 2 * shapes_of(one));
  EXPECT_EQ(sum.ghosts.size(), 2U);
}

TEST(Dashes, AreHalfOfTheLineAndLieOnIt) {
  std::vector<Vector3d> arc;
  for (int i = 0; i <= 500; ++i) arc.emplace_back(std::cos(0.01 * i), std::sin(0.01 * i), 0);
  const std::vector<Vector3d> ends = dashes(arc, 0.1, 0.1);
  ASSERT_EQ(ends.size() % 2, 0U);
  double drawn = 0;
  for (std::size_t i = 0; i < ends.size(); i += 2) drawn += (ends[i + 1] - ends[i]).norm();
  EXPECT_NEAR(drawn, 2.5, 0.06);
  for (const Vector3d& end : ends) EXPECT_NEAR(end.norm(), 1, 1e-4);
  EXPECT_EQ(ends.front(), arc.front());
}

TEST(Dashes, AreNeverTooMany) {
  const std::vector<Vector3d> line = {{0, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(dashes(line, 0.1, 0.15).size(), 2U * 4);
  EXPECT_LE(dashes(line, 1e-9, 1e-9, 50).size(), 2U * 51);
  EXPECT_TRUE(dashes({}, 0.1, 0.1).empty());
  EXPECT_TRUE(dashes(line, 0, 0.1).empty());
  EXPECT_TRUE(dashes(std::vector<Vector3d>{{1, 1, 1}, {1, 1, 1}}, 0.1, 0.1).empty());
  EXPECT_TRUE(dashes(std::vector<Vector3d>{{0, 0, 0}, {std::nan(""), 1, 1}}, 0.1, 0.1).empty());
}

TEST(Simplified, LeavesOutOnlyWhatIsNotSeen) {
  std::vector<Vector3d> way;
  for (int i = 0; i <= 2000; ++i) {
    const double a = 0.01 * i;
    way.emplace_back(0.5 * std::cos(a), 0.3 * std::sin(a), 0.01 * a);
  }
  const double tolerance = 0.0005;
  const std::vector<Vector3d> kept = simplified(way, tolerance);
  EXPECT_LT(kept.size(), 600U);
  EXPECT_EQ(kept.front(), way.front());
  EXPECT_EQ(kept.back(), way.back());
  std::size_t piece = 1;
  for (const Vector3d& p : way) {
    // Points come in the order of the pieces that stand for them.
    if (piece + 1 < kept.size() && p == kept[piece]) ++piece;
    const Vector3d along = kept[piece] - kept[piece - 1];
    const double share =
        std::clamp((p - kept[piece - 1]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    EXPECT_LE((p - kept[piece - 1] - share * along).norm(), tolerance + 1e-12);
  }
  EXPECT_EQ(simplified(line_of(500).points_W, tolerance).size(), 501U);
  EXPECT_TRUE(simplified({}, tolerance).empty());
  const std::vector<Vector3d> same(200, Vector3d(1, 2, 3));
  EXPECT_LE(simplified(same, tolerance).size(), 5U);
}

TEST(OverlayShapes, ContactsShowWhereAndHowMuch) {
  Overlay overlay;
  const std::vector<ContactMark> marks = {{.p_W = {1, 0, 0}},
                                          {.p_W = {2, 0, 0}, .force_W = Vector3d(0, 0, 50)},
                                          {.p_W = {3, 0, 0}, .force_W = Vector3d(0, 1e6, 0)},
                                          {.p_W = {4, 0, 0}, .force_W = Vector3d(0, 0, 0)}};
  add_contacts(overlay, marks, {.metres_per_newton = 0.002, .longest = 0.3});
  EXPECT_EQ(overlay.spheres.size(), 4U);
  ASSERT_EQ(overlay.arrows.size(), 2U);
  EXPECT_LT((overlay.arrows[0].to_W - Vector3d(2, 0, 0.1)).norm(), 1e-12);
  EXPECT_LT((overlay.arrows[1].to_W - Vector3d(3, 0.3, 0)).norm(), 1e-12);
}

TEST(OverlayShapes, TheClosestPairTellsItsDistance) {
  Overlay overlay;
  add_closest_pair(overlay, {0, 0, 0}, {0.0123, 0, 0}, 0.0123);
  ASSERT_EQ(overlay.labels.size(), 1U);
  EXPECT_EQ(overlay.labels[0].text, "12.3 mm");
  EXPECT_LT(overlay.lines.at(0).color.r, 0.5F);
  Overlay deep;
  add_closest_pair(deep, {0, 0, 0}, {0.002, 0, 0}, -0.002);
  EXPECT_EQ(deep.labels.at(0).text, "-2.0 mm");
  EXPECT_GT(deep.lines.at(0).color.r, 0.5F);
}

TEST(OverlayShapes, APlannedPathIsDashedOverItsLength) {
  std::vector<Pose> poses(101);
  for (int i = 0; i <= 100; ++i) poses[static_cast<std::size_t>(i)].p = {0.02 * i, 0, 0};
  Overlay overlay;
  add_planned_path(overlay, poses);
  EXPECT_NEAR(overlay.lines.at(0).dash, 2.0 / 120, 1e-12);
  EXPECT_EQ(overlay.lines.at(0).points_W.size(), 101U);
  add_planned_path(overlay, poses, {.dashed = false});
  EXPECT_EQ(overlay.lines.at(1).dash, 0);
  EXPECT_LT(overlay.lines.at(0).width, 0.5 * TrailOptions{}.width) << "seen in what was done";
}

TEST(OverlayShapes, SeveralPlannedPathsShareTheirDashes) {
  std::vector<std::vector<Pose>> paths(3, std::vector<Pose>(2));
  for (std::size_t i = 0; i < 3; ++i) paths[i][1].p = {0.1 * static_cast<double>(i + 1), 0, 0};
  Overlay overlay;
  add_planned_paths(overlay, paths);
  ASSERT_EQ(overlay.lines.size(), 3U);
  for (const OverlayLine& line : overlay.lines) EXPECT_NEAR(line.dash, 0.6 / 120, 1e-12);
}

TEST(OverlayShapes, AGhostNamesTheJointsOfTheArm) {
  Arm arm;
  arm.joints.resize(2);
  arm.joints[0].qpos = 7;
  arm.joints[1].qpos = 9;
  const OverlayGhost ghost = ghost_of(arm, std::vector<double>{0.1, 0.2});
  EXPECT_EQ(ghost.qpos_index, (std::vector<int>{7, 9}));
  EXPECT_EQ(ghost.qpos, (std::vector<double>{0.1, 0.2}));
}

}  // namespace
}  // namespace mjarm::render
