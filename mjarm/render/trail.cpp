#include "mjarm/render/trail.hpp"

#include <algorithm>

namespace mjarm::render {

Trail::Trail(const TrailOptions& options) : options_(options) {
  options_.max_points = std::max<std::size_t>(options_.max_points, 2);
}

void Trail::add(const Eigen::Vector3d& p_W) {
  if (!p_W.allFinite()) return;
  newest_ = p_W;
  if (!ring_.empty()) {
    const std::size_t last = (begin_ + ring_.size() - 1) % ring_.size();
    if ((ring_[last] - p_W).norm() < options_.spacing) return;
  }
  if (ring_.size() < options_.max_points) {
    ring_.push_back(p_W);
    return;
  }
  ring_[begin_] = p_W;
  begin_ = (begin_ + 1) % ring_.size();
}

void Trail::clear() {
  ring_.clear();
  begin_ = 0;
}

std::vector<Eigen::Vector3d> Trail::points() const {
  std::vector<Eigen::Vector3d> points;
  points.reserve(ring_.size() + 1);
  const auto middle = ring_.begin() + static_cast<std::ptrdiff_t>(begin_);
  points.insert(points.end(), middle, ring_.end());
  points.insert(points.end(), ring_.begin(), middle);
  if (!points.empty() && points.back() != newest_) points.push_back(newest_);
  return points;
}

void Trail::draw(Overlay& overlay) const {
  if (ring_.empty()) return;
  std::vector<Eigen::Vector3d> way = points();
  if (!options_.balls) {
    overlay.lines.push_back({.points_W = std::move(way),
                             .width = options_.width,
                             .color = options_.color,
                             .look = options_.look});
    return;
  }
  double since = options_.ball_spacing;  // the first point has a ball
  for (std::size_t i = 0; i < way.size(); ++i) {
    if (i > 0) since += (way[i] - way[i - 1]).norm();
    if (since < options_.ball_spacing) continue;
    overlay.spheres.push_back({way[i], options_.ball_radius, options_.ball_color});
    since = 0;
  }
}

}  // namespace mjarm::render
