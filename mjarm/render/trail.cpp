#include "mjarm/render/trail.hpp"

#include <algorithm>
#include <cstddef>

namespace mjarm::render {

Trail::Trail(const TrailOptions& options) : options_(options) {
  options_.max_points = std::max<std::size_t>(options_.max_points, 2);
}

void Trail::set_pen(Pen pen) {
  if (pen == options_.pen) return;
  // What one pen drew ends where the next one begins.
  if (newest_ && !ring_.empty() && options_.pen != Pen::up) keep(*newest_);
  lifted_ = lifted_ || options_.pen == Pen::up || pen == Pen::up;
  options_.pen = pen;
}

void Trail::keep(const Spot& spot) {
  if (ring_.size() < options_.max_points) {
    ring_.push_back(spot);
    return;
  }
  ring_[begin_] = spot;
  begin_ = (begin_ + 1) % ring_.size();
}

void Trail::add(const Eigen::Vector3d& p_W, std::optional<double> time) {
  if (!p_W.allFinite() || options_.pen == Pen::up) return;
  const bool begins = ring_.empty() || lifted_;
  lifted_ = false;
  newest_ = {p_W, options_.pen, begins, time};
  if (!begins) {
    const Spot& last = ring_[(begin_ + ring_.size() - 1) % ring_.size()];
    if ((last.p_W - p_W).norm() < options_.spacing) return;
  }
  keep(*newest_);
}

void Trail::clear() {
  ring_.clear();
  begin_ = 0;
  newest_.reset();
  lifted_ = false;
}

std::vector<Trail::Spot> Trail::spots() const {
  std::vector<Spot> all;
  all.reserve(ring_.size() + 1);
  const auto middle = ring_.begin() + static_cast<std::ptrdiff_t>(begin_);
  all.insert(all.end(), middle, ring_.end());
  all.insert(all.end(), ring_.begin(), middle);
  if (newest_ && !all.empty() && all.back().p_W != newest_->p_W) {
    all.push_back({newest_->p_W, newest_->pen, false, newest_->time});
  }
  return all;
}

std::vector<Eigen::Vector3d> Trail::points() const {
  std::vector<Eigen::Vector3d> points;
  for (const Spot& spot : spots()) points.push_back(spot.p_W);
  return points;
}

void Trail::draw(Overlay& overlay) const {
  const auto lead_to = [&overlay](const Spot& spot) {
    OverlayLine& line = overlay.lines.back();
    line.points_W.push_back(spot.p_W);
    if (spot.time) line.times.push_back(*spot.time);
  };
  const std::vector<Spot> way = spots();
  double since = options_.ball_spacing;  // the first point has a ball
  for (std::size_t i = 0; i < way.size(); ++i) {
    const Spot& spot = way[i];
    const bool begins = i == 0 || spot.begins;
    if (options_.balls) {
      if (i > 0) since += (spot.p_W - way[i - 1].p_W).norm();
      if (since < options_.ball_spacing || spot.pen != Pen::down) continue;
      overlay.spheres.push_back({spot.p_W, options_.ball_radius, options_.ball_color});
      since = 0;
      continue;
    }
    if (begins || spot.pen != way[i - 1].pen) {
      const bool down = spot.pen == Pen::down;
      OverlayLine& line = overlay.lines.emplace_back();
      line.width = down ? options_.width : options_.travel_width;
      line.color = down ? options_.color : options_.travel_color;
      line.look = options_.look;
      if (!begins) lead_to(way[i - 1]);
    }
    lead_to(spot);
  }
}

}  // namespace mjarm::render
