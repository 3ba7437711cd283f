#include "mjarm/render/polyline.hpp"

#include <algorithm>
#include <cmath>

namespace mjarm::render {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kMaxLeftOut = 64;

/// True where all points between two of them are near the straight line that joins those.
bool is_straight(std::span<const Vector3d> points, std::size_t from, std::size_t to,
                 double tolerance) {
  const Vector3d& a = points[from];
  const Vector3d along = points[to] - a;
  const double squared = along.squaredNorm();
  for (std::size_t i = from + 1; i < to; ++i) {
    const Vector3d off = points[i] - a;
    const double share = squared > 0 ? std::clamp(off.dot(along) / squared, 0.0, 1.0) : 0;
    if ((off - share * along).squaredNorm() > tolerance * tolerance) return false;
  }
  return true;
}

}  // namespace

std::vector<Vector3d> dashes(std::span<const Vector3d> points, double dash, double gap,
                             std::size_t max) {
  std::vector<Vector3d> ends;
  double total = 0;
  for (std::size_t i = 1; i < points.size(); ++i) total += (points[i] - points[i - 1]).norm();
  if (!(total > 0) || !std::isfinite(total) || !(dash > 0) || !(gap > 0) || max == 0) return ends;
  const double stretch = std::max(1.0, total / (dash + gap) / static_cast<double>(max));
  const double lengths[2] = {stretch * dash, stretch * gap};
  int phase = 0;  // 0 on a dash, 1 on a gap
  double left = lengths[0];
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vector3d way = points[i] - points[i - 1];
    const double length = way.norm();
    double done = 0;
    while (done < length) {
      const double end = std::min(length, done + left);
      if (phase == 0) {
        ends.emplace_back(points[i - 1] + done / length * way);
        ends.emplace_back(points[i - 1] + end / length * way);
      }
      left -= end - done;
      done = end;
      if (left <= 1e-12 * total) {
        phase = 1 - phase;
        left = lengths[phase];
      }
    }
  }
  return ends;
}

std::vector<Vector3d> simplified(std::span<const Vector3d> points, double tolerance) {
  std::vector<Vector3d> kept;
  if (points.empty()) return kept;
  kept.push_back(points.front());
  std::size_t from = 0;
  while (from + 1 < points.size()) {
    // Twice as far as long as that is straight, then back by halves: few looks at each point.
    std::size_t good = from + 1;
    const std::size_t furthest = std::min(points.size() - 1, from + kMaxLeftOut + 1);
    std::size_t bad = furthest + 1;
    for (std::size_t reach = 2; good < furthest; reach *= 2) {
      const std::size_t to = std::min(from + reach, furthest);
      if (!is_straight(points, from, to, tolerance)) {
        bad = to;
        break;
      }
      good = to;
    }
    while (bad - good > 1) {
      const std::size_t middle = good + (bad - good) / 2;
      (is_straight(points, from, middle, tolerance) ? good : bad) = middle;
    }
    kept.push_back(points[good]);
    from = good;
  }
  return kept;
}

}  // namespace mjarm::render
