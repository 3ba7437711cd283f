#include "mjarm/model/surface.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

namespace mjarm {
namespace {

/// [m^3] enclosed, by Gauss's theorem: right only where all triangles go round the same way.
double volume_of(const Surface& surface) {
  double sum = 0;
  for (const auto& [a, b, c] : surface.triangles) {
    const auto at = [&](int i) { return surface.vertices[static_cast<std::size_t>(i)]; };
    sum += at(a).dot(at(b).cross(at(c))) / 6;
  }
  return sum;
}

double top_of(const Surface& surface) {
  double z = -1e9;
  for (const Eigen::Vector3d& v : surface.vertices) z = std::max(z, v.z());
  return z;
}

TEST(Surface, BoxesAndCylindersEncloseTheirVolume) {
  EXPECT_NEAR(volume_of(box_surface({0.1, 0.2, 0.3})), 0.048, 1e-12);
  EXPECT_NEAR(volume_of(cylinder_surface(0.1, 0.3)), std::numbers::pi * 0.01 * 0.6, 1e-12);
  Surface both = box_surface({0.1, 0.1, 0.1});
  append(both, box_surface({0.1, 0.1, 0.1}), {.p = {1, 2, 3}});
  EXPECT_NEAR(volume_of(both), 0.016, 1e-12);
  EXPECT_NEAR(top_of(both), 3.1, 1e-12);
}

TEST(Surface, PointsAreSpreadByArea) {
  Surface two = box_surface({0.1, 0.2, 0.3});
  append(two, box_surface({0.2, 0.4, 0.6}), {.p = {5, 0, 0}});
  const SurfacePoints points(two);
  EXPECT_NEAR(points.area(), 0.88 + 3.52, 1e-12);
  constexpr int kDraws = 8000;
  int on_first = 0, on_top = 0;
  Rng rng(1);
  for (int i = 0; i < kDraws; ++i) {
    const auto [p, outward] = points.draw((i + 0.5) / kDraws, rng);
    const bool first = p.x() < 2.5;
    const double size = first ? 1 : 2;
    const Eigen::Vector3d at = (p - Eigen::Vector3d(first ? 0 : 5, 0, 0))
                                   .cwiseQuotient(size * Eigen::Vector3d(0.1, 0.2, 0.3));
    EXPECT_NEAR(at.cwiseAbs().maxCoeff(), 1, 1e-12);  // on a face of the box
    EXPECT_NEAR(at.dot(outward), 1, 1e-12);           // whose normal this is
    on_first += first ? 1 : 0;
    on_top += outward.z() > 0.5 ? 1 : 0;
  }
  EXPECT_NEAR(on_first / double{kDraws}, 0.2, 1e-3);
  EXPECT_NEAR(on_top / double{kDraws}, 0.08 / 0.88, 1e-3);
  EXPECT_EQ(SurfacePoints({}).area(), 0);
}

constexpr const char* kThings = R"(
<mujoco>
  <asset><mesh name="wedge" vertex="0 0 0  1 0 0  0 1 0  0 0 1"/></asset>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <body name="ball"><freejoint/><geom type="sphere" size="0.1" pos="0 0 0.5"/></body>
    <body name="pill"><freejoint/><geom type="capsule" size="0.1 0.2" euler="0 90 0"/></body>
    <body name="egg"><freejoint/><geom type="ellipsoid" size="0.1 0.2 0.3"/></body>
    <body name="wedge"><freejoint/><geom type="mesh" mesh="wedge"/></body>
    <body name="two"><freejoint/><geom type="box" size="0.1 0.1 0.1" pos="0 0 1"/>
      <geom type="cylinder" size="0.1 0.1"/><geom type="box" size="2 2 2" group="3"/>
      <geom type="box" size="2 2 2" rgba="1 1 1 0"/></body>
    <body name="unseen"><freejoint/><geom type="box" size="1 1 1" group="3"/></body>
  </worldbody>
</mujoco>)";

TEST(Surface, OfABodyIsThatOfItsGeomsInItsFrame) {
  const Model model = *Model::from_mjcf(kThings);
  const auto of = [&](const char* body) { return *body_surface(model, body); };
  const double ball = 4.0 / 3 * std::numbers::pi;
  EXPECT_NEAR(volume_of(of("ball")), ball * 1e-3, 5e-5);
  EXPECT_NEAR(top_of(of("ball")), 0.6, 1e-12);
  EXPECT_NEAR(volume_of(of("pill")), ball * 1e-3 + std::numbers::pi * 0.01 * 0.4, 1e-4);
  EXPECT_NEAR(top_of(of("pill")), 0.1, 1e-3);
  EXPECT_NEAR(volume_of(of("egg")), ball * 6e-3, 1e-4);
  EXPECT_NEAR(volume_of(of("wedge")), 1.0 / 6, 1e-6);
  EXPECT_NEAR(top_of(of("wedge")), 1, 1e-6)
      << "MuJoCo moves meshes to their centre, the body does not";
  EXPECT_NEAR(volume_of(of("two")), 8e-3 + std::numbers::pi * 2e-3, 1e-9);
  EXPECT_NE(body_surface(model, "wegde").error().what.find("\"wedge\""), std::string::npos);
  EXPECT_FALSE(body_surface(model, "unseen"));
  EXPECT_FALSE(body_surface(model, "world"));
  const Model unnamed = *Model::from_mjcf(
      R"(<mujoco><worldbody><body/><body><geom type="box" size=".1 .1 .1"/></body></worldbody></mujoco>)");
  EXPECT_NEAR(volume_of(*body_surface(unnamed, 2)), 8e-3, 1e-9);
  EXPECT_FALSE(body_surface(unnamed, 1));
}

TEST(Surface, BodiesLookAlikeWhereNothingThatIsDrawnTellsThemApart) {
  const Model model = *Model::from_mjcf(R"(
<mujoco>
  <worldbody>
    <body name="a" pos="1 0 0"><freejoint/><geom type="box" size="1 2 3" rgba="1 0 0 1"/></body>
    <body name="same" pos="5 0 0" euler="0 0 30"><freejoint/>
      <geom type="box" size="1 2 3" rgba="1 0 0 1" mass="7"/>
      <geom type="sphere" size="1" group="3"/></body>
    <body name="blue" pos="9 0 0"><freejoint/><geom type="box" size="1 2 3" rgba="0 0 1 1"/></body>
    <body name="long" pos="13 0 0"><freejoint/><geom type="box" size="1 2 4" rgba="1 0 0 1"/></body>
    <body name="two" pos="17 0 0"><freejoint/><geom type="box" size="1 2 3" rgba="1 0 0 1"/>
      <geom type="sphere" size="1"/></body>
    <body name="off" pos="21 0 0"><freejoint/>
      <geom type="box" size="1 2 3" pos="0 0 1" rgba="1 0 0 1"/></body>
  </worldbody>
</mujoco>)");
  EXPECT_TRUE(look_alike(model, "a", "a"));
  EXPECT_TRUE(look_alike(model, "a", "same"));
  for (const char* other : {"blue", "long", "two", "off", "nobody"}) {
    EXPECT_FALSE(look_alike(model, "a", other)) << other;
    EXPECT_FALSE(look_alike(model, other, "a")) << other;
  }
}

}  // namespace
}  // namespace mjarm
