#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "mjarm/render/overlay.hpp"

namespace mjarm::render {

/// How a trail is kept and drawn. Every default is usable as is.
struct TrailOptions {
  std::size_t max_points = 2000;   ///< then the oldest go, >= 2
  double spacing = 0.002;          ///< [m] nearer points are left out, >= 0
  double width = 0.005;            ///< [m] diameter of the line, > 0
  LineLook look = LineLook::thin;  ///< the same however long it grows
  Rgba color = {0.10F, 0.45F, 0.85F, 1};
  bool balls = false;          ///< red balls along the trail instead of a line
  double ball_radius = 0.005;  ///< [m] > 0
  double ball_spacing = 0.01;  ///< [m] way along the trail from ball to ball, > 0
  Rgba ball_color = {0.85F, 0.15F, 0.15F, 1};
};

/// Where a point has been of late: a ring of bounded memory.
class Trail {
 public:
  explicit Trail(const TrailOptions& options = {});

  /// The point is now at `p_W` [m]. The trail always reaches there; what is not finite is ignored.
  void add(const Eigen::Vector3d& p_W);
  void clear();
  /// From now on as balls, or as a line again.
  void set_balls(bool balls) { options_.balls = balls; }

  [[nodiscard]] std::size_t size() const noexcept { return ring_.size(); }
  /// The points kept, the oldest first, and the newest one given [m].
  [[nodiscard]] std::vector<Eigen::Vector3d> points() const;
  /// Appends the trail: one line, or balls.
  void draw(Overlay& overlay) const;

 private:
  TrailOptions options_;
  std::vector<Eigen::Vector3d> ring_;
  std::size_t begin_ = 0;  ///< the oldest, once the ring is full
  Eigen::Vector3d newest_ = Eigen::Vector3d::Zero();
};

}  // namespace mjarm::render
