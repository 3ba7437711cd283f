#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mjarm/core/rotation.hpp"
#include "mjarm/perception/find_objects.hpp"
#include "mjarm/perception/tag_detector.hpp"
#include "mjarm/render/png.hpp"
#include "mjarm/render/rgbd.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::perception::testing {

/// A table at z = 0 with a box that has a tag on it, two cylinders, a post of its own shape (a mesh
/// that is not convex) and a stranger; a camera that can be put anywhere, all at places of their
/// own.
constexpr const char* kTable = R"(
<mujoco model="table">
  <statistic extent="1.5" center="0 0 0"/>
  <visual><headlight ambient="0.5 0.5 0.5" diffuse="0.3 0.3 0.3" specular="0 0 0"/></visual>
  <asset>
    <texture name="tag" type="2d" file="tag.png"/>
    <material name="tag" texture="tag" texuniform="false" specular="0"/>
    <mesh name="step" vertex="
      -0.04 -0.025 0  0.04 -0.025 0  0.04 -0.025 0.03  0 -0.025 0.03  0 -0.025 0.07  -0.04 -0.025 0.07
      -0.04  0.025 0  0.04  0.025 0  0.04  0.025 0.03  0  0.025 0.03  0  0.025 0.07  -0.04  0.025 0.07"
      face="0 1 2  0 2 3  0 3 5  3 4 5  6 8 7  6 9 8  6 11 9  9 11 10
            0 7 1  0 6 7  1 8 2  1 7 8  2 9 3  2 8 9  3 10 4  3 9 10  4 11 5  4 10 11  5 6 0  5 11 6"/>
  </asset>
  <worldbody>
    <light pos="0.5 0.3 2" dir="-0.2 -0.1 -1" directional="true" diffuse="0.5 0.5 0.5"/>
    <geom name="top" type="box" size="0.6 0.6 0.02" pos="0 0 -0.02" rgba="0.6 0.55 0.5 1"/>
    <geom name="floor" type="plane" size="3 3 0.1" pos="0 0 -0.7" rgba="0.3 0.3 0.35 1"/>
    <body name="eye"><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
      <camera name="eye" fovy="42"/></body>
    <body name="box"><freejoint/>
      <geom type="box" size="0.05 0.04 0.03" rgba="0.8 0.3 0.2 1"/>
      <geom type="box" size="0.0375 0.0375 0.0001" pos="0.005 0 0.0301" material="tag" mass="0"
            contype="0" conaffinity="0"/></body>
    <body name="can"><freejoint/><geom type="cylinder" size="0.033 0.05" rgba="0.2 0.5 0.3 1"/></body>
    <body name="step"><freejoint/><geom type="mesh" mesh="step" rgba="0.3 0.3 0.7 1"/></body>
    <body name="stranger"><freejoint/><geom type="box" size="0.03 0.06 0.02" rgba="0.7 0.7 0.2 1"/></body>
    <body name="twin"><freejoint/><geom type="cylinder" size="0.033 0.05" rgba="0.2 0.5 0.3 1"/></body>
  </worldbody>
</mujoco>)";

inline constexpr int kTag = 7;
inline constexpr double kTagSize = 0.06;
inline const Pose kTagOnBox{.p = {0.005, 0, 0.0302}};
inline const std::array<const char*, 6> kBodies{"eye", "box", "can", "step", "stranger", "twin"};

/// Where bodies stand; those without a place are out of sight.
struct Places {
  Pose eye;                                        ///< X_WC, x right, y down
  std::array<std::optional<Pose>, 5> bodies = {};  ///< box, can, step, stranger, twin of the can
};

class Look {
 public:
  explicit Look(const render::RgbdOptions& options = {}) {
    if (has_tags()) {
      EXPECT_TRUE(render::write_png(*tag_picture(kTag, 24), folder_.path() / "tag.png"));
    } else {
      EXPECT_TRUE(render::write_png({2, 2, std::vector<std::uint8_t>(12, 255)},
                                    folder_.path() / "tag.png"));
    }
    model_ = std::make_unique<Model>(*Model::load(folder_.write("table.xml", kTable)));
    sim_ = std::make_unique<Sim>(*model_);
    Result<render::RgbdCamera> camera = render::RgbdCamera::create(*model_, "eye", options);
    if (camera) camera_ = std::make_unique<render::RgbdCamera>(std::move(*camera));
  }
  [[nodiscard]] bool works() const { return camera_ != nullptr; }
  [[nodiscard]] const Model& model() const { return *model_; }

  render::RgbdFrame operator()(const Places& places, Rng& noise) {
    // A camera of MuJoCo looks along -z, with y upwards.
    const Eigen::Matrix3d flip = Eigen::Vector3d(1, -1, -1).asDiagonal();
    sim_->place_free("eye", places.eye * Pose{.R = flip});
    for (std::size_t i = 0; i < places.bodies.size(); ++i) {
      const Pose hidden{.p = {5 + static_cast<double>(i), 5, 0}};
      sim_->place_free(kBodies[i + 1], places.bodies[i].value_or(hidden));
    }
    return *camera_->look(sim_->snapshot(), noise);
  }

 private:
  support::TempFolder folder_;
  std::unique_ptr<Model> model_;
  std::unique_ptr<Sim> sim_;
  std::unique_ptr<render::RgbdCamera> camera_;
};

/// A camera so far from a point of the world, at it, from the side `azimuth` and so high.
inline Pose eye_at(const Eigen::Vector3d& target_W, double distance, double azimuth,
                   double elevation) {
  const Eigen::Vector3d back(std::cos(elevation) * std::cos(azimuth),
                             std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  const Eigen::Vector3d x(-std::sin(azimuth), std::cos(azimuth), 0);
  Pose X_WC{.p = target_W + distance * back};
  X_WC.R << x, x.cross(back), -back;
  return X_WC;
}

inline Pose standing(double x, double y, double z, double yaw) {
  return {.p = {x, y, z}, .R = from_euler({0, 0, yaw})};
}

/// [rad] between two orientations of one of the bodies, up to its symmetry where it has no tag: the
/// box looks the same after half a turn about each axis, the can from either end and turned at
/// will.
inline double turn_between(std::size_t body, bool with_tag, const Eigen::Matrix3d& A,
                           const Eigen::Matrix3d& B) {
  constexpr std::size_t kBox = 0, kCan = 1;
  if (body == kCan) return std::acos(std::min(1.0, std::abs(A.col(2).dot(B.col(2)))));
  double least = angle_between(A, B);
  for (int axis = 0; body == kBox && !with_tag && axis < 3; ++axis) {
    const Eigen::AngleAxisd half(std::numbers::pi, Eigen::Vector3d::Unit(axis));
    least = std::min(least, angle_between(A * half.toRotationMatrix(), B));
  }
  return least;
}

/// The three objects beside each other, standing or lying, seen from somewhere 0.5 to 0.8 m away;
/// where the camera is so low that they would hide each other, `alone` by itself, 0.4 to 0.8 m
/// away.
inline Places random_places(Rng& rng, std::size_t alone) {
  const auto yaw = [&] { return rng.uniform(-std::numbers::pi, std::numbers::pi); };
  const auto near = [&](double x) { return x + rng.uniform(-0.02, 0.02); };
  const Pose on_side{.R = from_euler({std::numbers::pi / 2, 0, 0})};
  const double elevation = rng.uniform(0.6, 1.48);
  const bool low = elevation < 1;
  Places out{.eye = eye_at({0, 0, 0.03}, rng.uniform(low ? 0.4 : 0.5, 0.8), yaw(), elevation)};
  out.bodies[0] = standing(near(-0.08), near(0), 0.03, yaw());
  const bool can_lies = rng.below(3) == 0;
  out.bodies[1] = standing(near(0.06), near(0.07), can_lies ? 0.033 : 0.05, yaw());
  if (can_lies) *out.bodies[1] = *out.bodies[1] * on_side;
  const bool step_lies = rng.below(3) == 0;
  out.bodies[2] = standing(near(0.07), near(-0.07), step_lies ? 0.025 : 0, yaw());
  if (step_lies) *out.bodies[2] = *out.bodies[2] * on_side;
  for (std::size_t k = 0; low && k < 3; ++k) {
    if (k != alone) out.bodies[k].reset();
  }
  return out;
}

/// Box, can and step as objects, the box with its tag where that is asked for.
inline std::vector<KnownObject> objects_of(const Model& model, bool with_tag) {
  std::vector<KnownObject> out;
  for (const char* name : {"box", "can", "step"}) out.push_back(*known_object(model, name));
  if (with_tag) out[0].tag = ObjectTag{.id = kTag, .size = kTagSize, .X_OT = kTagOnBox};
  return out;
}

}  // namespace mjarm::perception::testing
