// What overlays become in MuJoCo's scene: colours, labels, arrows, and the edges of what is drawn;
// and cameras, by MuJoCo's own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/render/framing.hpp"
#include "mjarm/render/overlay_shapes.hpp"
#include "mjarm/render/polyline.hpp"
#include "mjarm/render/scene.hpp"
#include "mjarm/render/trail.hpp"

namespace mjarm::render {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

Model lit_room(int shadows) {
  std::string lights;
  for (int i = 0; i < shadows; ++i) lights += "<light pos='0 0 3' dir='0 0 -1' castshadow='true'/>";
  return Model::from_mjcf("<mujoco><worldbody>" + lights +
                          "<camera pos='0 0 1'/><geom size='0.1'/></worldbody></mujoco>")
      .value();
}

/// The geoms that an overlay adds to an almost empty scene.
std::vector<mjvGeom> geoms_for(const Overlay& overlay, RenderQuality quality = RenderQuality::low,
                               int shadows = 0) {
  Scene scene(lit_room(shadows), quality);
  scene.update({});
  const int bare = scene.raw().ngeom;
  scene.update(overlay);
  return {scene.raw().geoms + bare, scene.raw().geoms + scene.raw().ngeom};
}

TEST(OverlayLooks, LabelsAreAsciiAndEndInTime) {
  Overlay overlay;
  const std::pair<std::string, std::string> labels[] = {
      {"tool", "tool"},
      {"工具 1", "?? 1"},
      {"a\tb\nc", "a?b?c"},
      {"\x7F", "?"},
      {"", ""},
      {std::string(99, 'x'), std::string(99, 'x')},
      {std::string(100, 'x'), std::string(99, 'x')},
      {std::string(98, 'x') + "中y", std::string(98, 'x') + "?"}};
  for (const auto& [text, shown] : labels) overlay.labels.push_back({{1, 2, 3}, text});
  const std::vector<mjvGeom> geoms = geoms_for(overlay);
  ASSERT_EQ(geoms.size(), std::size(labels));
  for (std::size_t i = 0; i < geoms.size(); ++i) {
    EXPECT_EQ(geoms[i].type, mjGEOM_LABEL);
    EXPECT_STREQ(geoms[i].label, labels[i].second.c_str());
    EXPECT_EQ(geoms[i].pos[2], 3);
  }
}

TEST(OverlayLooks, EveryShapeHasTheColourThatIsAsked) {
  const Rgba color{0.1F, 0.2F, 0.3F, 0.4F};
  Overlay overlay;
  overlay.spheres.push_back({.color = color});
  overlay.lines.push_back({.points_W = {{0, 0, 0}, {1, 0, 0}}, .color = color});
  overlay.arrows.push_back({.color = color});
  overlay.ellipsoids.push_back({.color = color});
  overlay.boxes.push_back({.color = color});
  overlay.capsules.push_back({.color = color});
  overlay.segments.push_back({.ends_W = {{0, 0, 0}, {1, 0, 0}}, .color = color});
  const std::vector<mjvGeom> geoms = geoms_for(overlay);
  ASSERT_EQ(geoms.size(), 7U);
  for (const mjvGeom& geom : geoms) {
    EXPECT_EQ((Rgba{geom.rgba[0], geom.rgba[1], geom.rgba[2], geom.rgba[3]}), color) << geom.type;
    EXPECT_EQ(geom.category, mjCAT_DECOR);
    EXPECT_EQ(geom.castshadow, 0) << "nothing of it throws a shadow on the model";
    EXPECT_EQ(geom.objid, -1) << "and it cannot be taken for a part of it";
  }
}

/// Each light with shadows draws thin lines once more on top: together they make the colour.
TEST(OverlayLooks, ThinLinesAreNotBrighterForMoreLights) {
  Overlay overlay;
  overlay.lines.push_back({.points_W = {{0, 0, 0}, {1, 0, 0}},
                           .color = {0.8F, 0.4F, 0.2F, 0.9F},
                           .look = LineLook::thin});
  const auto brightness = [&](RenderQuality quality, int lights) {
    return geoms_for(overlay, quality, lights).at(0).rgba[0];
  };
  EXPECT_FLOAT_EQ(brightness(RenderQuality::low, 3), 0.8F) << "without shadows there is one pass";
  EXPECT_FLOAT_EQ(brightness(RenderQuality::medium, 1), 0.4F);
  EXPECT_FLOAT_EQ(brightness(RenderQuality::medium, 3), 0.2F);
  EXPECT_FLOAT_EQ(geoms_for(overlay, RenderQuality::medium, 3).at(0).rgba[3], 0.9F);
}

TEST(OverlayLooks, FramesHaveTheirAxesInRedGreenAndBlue) {
  const Pose X{{0.1, 0.2, 0.3}, from_euler({0.4, -0.7, 1.2})};
  Overlay overlay;
  overlay.frames.push_back({.X_WF = X, .length = 0.2, .width = 0.01});
  const std::vector<mjvGeom> geoms = geoms_for(overlay);
  ASSERT_EQ(geoms.size(), 3U);
  for (int i = 0; i < 3; ++i) {
    const mjvGeom& axis = geoms[static_cast<std::size_t>(i)];
    EXPECT_EQ(std::max_element(axis.rgba, axis.rgba + 3) - axis.rgba, i);
    const Vector3d middle(axis.pos[0], axis.pos[1], axis.pos[2]);
    EXPECT_LT((middle - X.p - 0.1 * X.R.col(i)).norm(), 1e-6);
    EXPECT_FLOAT_EQ(axis.size[0], 0.005F) << "half of the width";
    EXPECT_FLOAT_EQ(axis.size[2], 0.1F) << "half of the length";
  }
}

/// Whatever is asked for, labels, arrows and frames are shown before thousands of balls are.
TEST(OverlayLooks, FewThingsGoBeforeManyAndTheNoticeCountsAll) {
  Overlay overlay;
  overlay.spheres.assign(kMaxOverlayShapes + 500, {});
  overlay.labels.assign(300, {{0, 0, 0}, "x"});
  overlay.arrows.assign(200, {});
  std::size_t labels = 0, arrows = 0, balls = 0;
  for (const mjvGeom& geom : geoms_for(overlay)) {
    labels += geom.type == mjGEOM_LABEL ? 1U : 0U;
    arrows += geom.type == mjGEOM_ARROW ? 1U : 0U;
    balls += geom.type == mjGEOM_SPHERE ? 1U : 0U;
  }
  EXPECT_EQ(labels, 300U);
  EXPECT_EQ(arrows, 200U);
  EXPECT_EQ(balls, kMaxOverlayShapes - 500);
  EXPECT_EQ(overlay_notice(overlay), "20000 of 21000 shapes are drawn");
  const LanguageScope chinese(Language::chinese);
  EXPECT_EQ(overlay_notice(overlay), "共 21000 个图形，只绘制 20000 个");
  overlay.spheres.resize(kMaxOverlayShapes - 500);
  EXPECT_EQ(overlay_notice(overlay), "") << "exactly as many as can be drawn";
}

/// A straight line of many points is one piece, so it is neither thinned nor told of.
TEST(OverlayLooks, PointsThatAreNotSeenDoNotCount) {
  Overlay overlay;
  OverlayLine& line = overlay.lines.emplace_back();
  for (int i = 0; i <= 60000; ++i) line.points_W.emplace_back(1e-4 * i, 0, 0);
  EXPECT_GT(shapes_of(overlay), kMaxOverlayShapes);
  EXPECT_EQ(overlay_notice(overlay), "");
  const std::vector<mjvGeom> geoms = geoms_for(overlay);
  EXPECT_LT(geoms.size(), 1000U);
  double length = 0;
  for (const mjvGeom& geom : geoms) {
    length += geom.type == mjGEOM_LINE ? geom.size[2] : 2 * geom.size[2];
  }
  EXPECT_NEAR(length, 6, 1e-3) << "and it is drawn from end to end";
}

TEST(OverlayLooks, ContactsWithForcesThatAreNoneAreBarePoints) {
  const double inf = std::numeric_limits<double>::infinity();
  Overlay overlay;
  const std::vector<ContactMark> marks = {
      {.p_W = {1, 2, 3}, .force_W = Vector3d(0, inf, 0)},
      {.p_W = {1, 2, 3}, .force_W = Vector3d(std::nan(""), 0, 0)},
      {.p_W = {1, 2, 3}, .force_W = Vector3d(-30, 0, 40)}};
  add_contacts(overlay, marks);
  EXPECT_EQ(overlay.spheres.size(), 3U);
  ASSERT_EQ(overlay.arrows.size(), 1U);
  EXPECT_LT((overlay.arrows[0].to_W - Vector3d(1 - 0.06, 2, 3 + 0.08)).norm(), 1e-12);
  // A pair nearer than its margin is red, at the margin it is not; a negative margin is none.
  Overlay pairs;
  for (const auto& [distance, margin] : {std::pair(0.01, 0.02), std::pair(0.02, 0.02),
                                         std::pair(0.0, -1.0), std::pair(-1e-9, 0.0)}) {
    add_closest_pair(pairs, {0, 0, 0}, {0, 0, 0.01}, distance, margin);
  }
  const bool red[] = {true, false, false, true};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(pairs.lines.at(i).color.r > 0.5F, red[i]) << i;
    EXPECT_EQ(pairs.spheres.at(2 * i).color, pairs.lines[i].color);
  }
  EXPECT_LT((pairs.labels.at(0).p_W - Vector3d(0, 0, 0.005)).norm(), 1e-12);
}

/// However often a dash begins and ends: dashes and gaps take turns in the lengths asked for.
TEST(OverlayLooks, DashesOfRandomWaysHaveTheirLengths) {
  Rng rng(12);
  for (int round = 0; round < 100; ++round) {
    std::vector<Vector3d> way{Vector3d::Zero()};
    std::vector<double> run{0};  // length up to each point
    for (std::uint64_t i = 0, n = 2 + rng.below(30); i < n; ++i) {
      way.push_back(way.back() +
                    Vector3d(rng.uniform(0, 0.3), rng.uniform(-0.3, 0.3), rng.uniform(-1, 1)));
      run.push_back(run.back() + (way.back() - way[way.size() - 2]).norm());
    }
    const double dash = rng.uniform(0.02, 0.4), gap = rng.uniform(0.02, 0.4);
    double expected = 0;
    for (double at = 0; at < run.back(); at += dash + gap) {
      expected += std::min(dash, run.back() - at);
    }
    double drawn = 0;
    const std::vector<Vector3d> ends = dashes(way, dash, gap);
    for (std::size_t i = 0; i < ends.size(); i += 2) {
      const double piece = (ends[i + 1] - ends[i]).norm();
      EXPECT_LE(piece, dash + 1e-9);
      drawn += piece;
    }
    EXPECT_NEAR(drawn, expected, 1e-9 * run.back() * static_cast<double>(ends.size()));
  }
}

TEST(OverlayLooks, BallsOfATrailKeepTheirDistanceAlongTheWay) {
  Trail trail({.spacing = 0, .balls = true, .ball_spacing = 0.05});
  for (int i = 0; i <= 1000; ++i)
    trail.add({0.2 * std::cos(0.02 * i), 0.2 * std::sin(0.02 * i), 0});
  Overlay overlay;
  trail.draw(overlay);
  // Three laps and more: along the way, not across the circle.
  EXPECT_NEAR(static_cast<double>(overlay.spheres.size()), 0.2 * 20 / 0.052, 2);
  // Less room than two points is two.
  Trail small({.max_points = 0, .spacing = 0});
  for (int i = 0; i < 10; ++i) small.add({1.0 * i, 0, 0});
  EXPECT_EQ(small.size(), 2U);
  EXPECT_EQ(small.points().front().x(), 8);
}

/// MuJoCo's camera for a view stands where `camera_place` says, and sees `lookat` in its middle.
TEST(CameraViews, AreWhereMujocoPutsThem) {
  Scene scene(lit_room(0), RenderQuality::low);
  Rng rng(14);
  for (int round = 0; round < 100; ++round) {
    const CameraView view{.lookat_W = {rng.uniform(-3, 3), rng.uniform(-3, 3), rng.uniform(-3, 3)},
                          .distance = std::pow(10.0, rng.uniform(-1, 2)),
                          .azimuth = rng.uniform(-10, 10),
                          .elevation = rng.uniform(-1.5, 1.5)};
    ASSERT_TRUE(scene.set_camera({.view = view}));
    const CameraView back = scene.view();
    EXPECT_EQ(back.lookat_W, view.lookat_W);
    EXPECT_NEAR(back.azimuth, view.azimuth, 1e-12);
    EXPECT_NEAR(back.elevation, view.elevation, 1e-12);
    scene.update({});
    const mjvGLCamera gl = mjv_averageCamera(&scene.raw().camera[0], &scene.raw().camera[1]);
    const Vector3d p(gl.pos[0], gl.pos[1], gl.pos[2]);
    const Vector3d forward(gl.forward[0], gl.forward[1], gl.forward[2]);
    EXPECT_LT((camera_place(view) - p).norm(), 1e-5 * view.distance + 1e-6);
    EXPECT_LT((p + view.distance * forward - view.lookat_W).norm(), 1e-5 * view.distance + 1e-6);
  }
}

/// Twice as large is twice as far away; turned about z it is seen from as much farther round.
TEST(CameraViews, FramingFollowsWhatItFrames) {
  const Model model = lit_room(0);
  Rng rng(15);
  for (int round = 0; round < 50; ++round) {
    std::vector<FramedBall> balls(1 + rng.below(5)), scaled, turned;
    const double turn = rng.uniform(-3, 3);
    const Eigen::Matrix3d R = from_euler({0, 0, turn});
    for (FramedBall& ball : balls) {
      ball = {{rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(0, 1)}, rng.uniform(0.05, 0.3)};
      scaled.push_back({2 * ball.p_W, 2 * ball.radius});
      turned.push_back({R * ball.p_W, ball.radius});
    }
    const LineOfSight sight{rng.uniform(-3, 3), rng.uniform(-1.2, 1.2), rng.uniform(0.5, 2)};
    const CameraView view = framing_view(model, balls, sight);
    const CameraView twice = framing_view(model, scaled, sight);
    EXPECT_LT((camera_place(twice) - 2 * camera_place(view)).norm(), 1e-9);
    LineOfSight round_sight = sight;
    round_sight.azimuth += turn;
    const CameraView other = framing_view(model, turned, round_sight);
    EXPECT_LT((camera_place(other) - R * camera_place(view)).norm(), 1e-9);
    // More to see is never seen from nearer.
    balls.push_back({{2, 2, 2}, 0.5});
    const Vector3d forward = (view.lookat_W - camera_place(view)).normalized();
    const CameraView more = framing_view(model, balls, sight);
    EXPECT_LE((camera_place(more) - camera_place(view)).dot(forward), 1e-9);
  }
}

TEST(CameraViews, RefusalsNameTheNumberAndWhatIsExpected) {
  const Model model = lit_room(0);
  EXPECT_THAT(camera_names(model), ::testing::IsEmpty()) << "a camera without a name";
  const auto why = [&](const CameraView& view) {
    const Result<void> checked = check_camera(model, {.view = view});
    EXPECT_FALSE(checked);
    return checked ? std::string() : checked.error().what;
  };
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(why({.distance = 0}), "camera: distance is 0, expected a number above 0");
  EXPECT_EQ(why({.distance = inf}), "camera: distance is inf, expected a number above 0");
  EXPECT_EQ(why({.azimuth = -inf}), "camera: azimuth is -inf, expected a finite number");
  EXPECT_EQ(why({.lookat_W = {0, 0, inf}}), "camera: lookat z is inf, expected a finite number");
  const Result<void> none = check_camera(model, {.name = "front"});
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().what, HasSubstr("no camera \"front\" (cameras: none)"));
  EXPECT_TRUE(check_camera(model, {.name = "front", .view = CameraView{}})) << "the view counts";
}

}  // namespace
}  // namespace mjarm::render
