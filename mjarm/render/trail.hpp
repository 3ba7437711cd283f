#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "mjarm/render/overlay.hpp"

namespace mjarm::render {

/// Whether a trail is drawn where the point goes.
enum class Pen {
  up,      ///< it is not, nor kept
  travel,  ///< thin and pale: on the way between what counts
  down,
};

/// How a trail is kept and drawn. Every default is usable as is.
struct TrailOptions {
  std::size_t max_points = 2000;   ///< then the oldest go, >= 2
  double spacing = 0.002;          ///< [m] nearer points are left out, >= 0
  double width = 0.008;            ///< [m] diameter of the line, > 0
  LineLook look = LineLook::thin;  ///< the same however long it grows
  Rgba color = {0.20F, 0.52F, 0.95F, 1};
  double travel_width = 0.0015;  ///< [m] > 0
  Rgba travel_color = {0.62F, 0.66F, 0.72F, 1};
  Pen pen = Pen::down;         ///< at first
  bool balls = false;          ///< red balls along the trail instead of a line
  double ball_radius = 0.005;  ///< [m] > 0
  double ball_spacing = 0.01;  ///< [m] way along the trail from ball to ball, > 0
  Rgba ball_color = {0.85F, 0.15F, 0.15F, 1};
};

/// Where a point has been of late: a ring of bounded memory.
class Trail {
 public:
  explicit Trail(const TrailOptions& options = {});

  /// From now on the trail goes on so; where the pen was up there is a gap.
  void set_pen(Pen pen);
  /// The point is now at `p_W` [m]. The trail always reaches there; what is not finite is ignored.
  /// @param time  [s] what its line is told of it (`OverlayLine::times`): all points or none.
  void add(const Eigen::Vector3d& p_W, std::optional<double> time = {});
  void clear();
  /// From now on as balls, or as a line again.
  void set_balls(bool balls) { options_.balls = balls; }

  [[nodiscard]] std::size_t size() const noexcept { return ring_.size(); }
  /// The points kept, the oldest first, and the newest one given [m].
  [[nodiscard]] std::vector<Eigen::Vector3d> points() const;
  /// Appends the trail: a line from each change of the pen to the next, or balls.
  void draw(Overlay& overlay) const;

 private:
  struct Spot {
    Eigen::Vector3d p_W;
    Pen pen;      ///< that drew what leads here
    bool begins;  ///< nothing leads here
    std::optional<double> time;
  };
  void keep(const Spot& spot);
  /// What is kept, the oldest first, and the newest point given.
  [[nodiscard]] std::vector<Spot> spots() const;

  TrailOptions options_;
  std::vector<Spot> ring_;
  std::size_t begin_ = 0;  ///< the oldest, once the ring is full
  std::optional<Spot> newest_;
  bool lifted_ = false;  ///< since the newest one
};

}  // namespace mjarm::render
