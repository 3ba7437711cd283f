#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/perception/find_objects.hpp"
#include "mjarm/render/rgbd.hpp"

/// The table on which the errors of poses are measured: the shipped scene `scenes/look_table.xml`,
/// with a box that has a tag, a can, a step that is not convex, a stranger that nobody knows, a
/// twin of the can, and a camera that can be put anywhere.
namespace mjarm::perception::look_table {

inline constexpr int kTag = 7;            ///< that of the box
inline constexpr double kTagSize = 0.06;  ///< [m]
inline const Pose kTagOnBox{.p = {0.005, 0, 0.0302}};

/// Bodies of the table, in the order of Places.
enum Body : std::size_t { kBox, kCan, kStep, kStranger, kTwin, kBodies };

/// Where they stand; those without a place are out of sight.
struct Places {
  Pose eye;                                              ///< X_WC, x right, y down
  std::array<std::optional<Pose>, kBodies> bodies = {};  ///< X_WB
};

/// A camera so far from a point of the world, at it, from the side `azimuth` and so high.
/// @param distance  [m] > 0
/// @param azimuth, elevation  [rad] of the camera as the point sees it
[[nodiscard]] Pose eye_at(const Eigen::Vector3d& target_W, double distance, double azimuth,
                          double elevation);

/// With its origin at (x, y, z) [m], upright, turned by `yaw` [rad].
[[nodiscard]] Pose standing(double x, double y, double z, double yaw);

/// Box, can and step beside each other, standing or lying, seen from somewhere 0.5 to 0.8 m away;
/// where the camera is so low that they would hide each other, `alone` by itself, 0.4 to 0.8 m
/// away.
[[nodiscard]] Places random_places(Rng& rng, Body alone);

/// The table with its camera. Used by one thread at a time.
class Table {
 public:
  /// @return fails as RgbdCamera does, and where the scene is not installed.
  [[nodiscard]] static Result<Table> open(const render::RgbdOptions& options = {});
  ~Table();
  Table(Table&&) noexcept;
  Table& operator=(Table&&) noexcept;

  [[nodiscard]] const Model& model() const;
  /// @param noise  as RgbdCamera::look() has it.
  [[nodiscard]] Result<render::RgbdFrame> look(const Places& places, Rng& noise);

 private:
  struct Impl;
  explicit Table(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Box, can and step as objects, the box with its tag where that is asked for.
/// @return fails as known_object().
[[nodiscard]] Result<std::vector<KnownObject>> objects(const Model& model, bool with_tag);

}  // namespace mjarm::perception::look_table
