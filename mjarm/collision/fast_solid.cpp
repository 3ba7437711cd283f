#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mjarm/collision/fast_crowd_internal.hpp"
#include "mjarm/collision/mesh_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr int kMaxCuts = 7;
constexpr std::int64_t kMaxFillWork = 5'000'000;  // triangles looked at before the last cut
const double kRoot3 = std::sqrt(3.0);

/// A cell and the faces that may meet it.
struct SurfaceCell {
  Eigen::Vector3d center;
  std::vector<int> faces;
};

class Filler {
 public:
  Filler(std::span<const Eigen::Vector3d> vertices, std::span<const std::array<int, 3>> faces,
         const CrowdSpace& space)
      : vertices_(vertices), faces_(faces), space_(space), inside_(vertices, faces) {
    Eigen::Vector3d low = vertices[static_cast<std::size_t>(faces.front()[0])], high = low;
    SurfaceCell all;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      all.faces.push_back(static_cast<int>(f));
      for (const int i : faces[f]) {
        low = low.cwiseMin(vertices[static_cast<std::size_t>(i)]);
        high = high.cwiseMax(vertices[static_cast<std::size_t>(i)]);
      }
    }
    all.center = 0.5 * (low + high);
    half_ = 0.5 * (high - low).maxCoeff() * (1 + 1e-9) + 1e-9;
    cells_.push_back(std::move(all));
  }

  SolidFill run() {
    for (int cut = 0; cut < kMaxCuts && work_ < kMaxFillWork && !cells_.empty() &&
                      out_.cubes.size() + 8 * cells_.size() <= space_.max_cubes &&
                      2 * kRoot3 * half_ > space_.least_radius;
         ++cut) {
      half_ *= 0.5;
      std::vector<SurfaceCell> next;
      for (const SurfaceCell& cell : cells_) cut_in_eight(cell, next);
      cells_ = std::move(next);
    }
    if (!cells_.empty()) {
      out_.thickness = std::max(2 * kRoot3 * half_ - space_.least_radius, 0.0);
    }
    return std::move(out_);
  }

 private:
  void cut_in_eight(const SurfaceCell& cell, std::vector<SurfaceCell>& next) {
    for (int corner = 0; corner < 8; ++corner) {
      const auto side = [&](int bit) { return (corner >> bit) % 2 == 0 ? -half_ : half_; };
      SurfaceCell child;
      child.center = cell.center + Eigen::Vector3d(side(0), side(1), side(2));
      const double radius = kRoot3 * half_ * (1 + 1e-9);
      if ((child.center - space_.middle_F).norm() > space_.reach + radius) continue;
      work_ += std::ssize(cell.faces);
      std::copy_if(cell.faces.begin(), cell.faces.end(), std::back_inserter(child.faces),
                   [&](int f) { return distance_to(f, child.center) <= radius; });
      if (!child.faces.empty()) {
        next.push_back(std::move(child));
      } else if (inside_.is_inside(child.center)) {
        out_.cubes.push_back({child.center, half_});
      }
    }
  }

  double distance_to(int f, const Eigen::Vector3d& p) const {
    const auto& [a, b, c] = faces_[static_cast<std::size_t>(f)];
    const auto corner = [&](int i) { return vertices_[static_cast<std::size_t>(i)]; };
    return distance_to_triangle(p, corner(a), corner(b), corner(c));
  }

  std::span<const Eigen::Vector3d> vertices_;
  std::span<const std::array<int, 3>> faces_;
  const CrowdSpace& space_;
  InsideTest inside_;
  std::vector<SurfaceCell> cells_;  // that the surface may meet; all have the same size
  double half_ = 0;
  std::int64_t work_ = 0;
  SolidFill out_;
};

void set(float* to, const Eigen::Vector3d& from) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(from[k]);
}

}  // namespace

SolidFill fill_solid(std::span<const Eigen::Vector3d> vertices,
                     std::span<const std::array<int, 3>> faces, const CrowdSpace& space) {
  return Filler(vertices, faces, space).run();
}

/// Rounding moves corners by up to half a unit of their size, and adds a few units of the lengths
/// at hand to each distance.
FastTriangle fast_triangle(const std::array<Eigen::Vector3d, 3>& corners, double thickness) {
  double size = 0, longest = 0;
  FastTriangle out;
  const Eigen::Vector3d n = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d edge = corners[(i + 1) % 3] - corners[i];
    size = std::max(size, corners[i].norm());
    longest = std::max(longest, edge.norm());
    set(out.corner[i], corners[i]);
    set(out.edge[i], edge);
    out.per_length2[i] = edge.norm() < 1e-12 ? 0 : static_cast<float>(1 / edge.squaredNorm());
    set(out.side[i], edge.cross(n).normalized());
  }
  const double leak = 0x1p-20 * (size + longest + 1e-3);
  double round = leak + thickness;
  set(out.normal, n.normalized());
  out.slack = round_up(leak);
  const double height = longest > 0 ? n.norm() / longest : 0;
  if (height < leak) {
    // As good as a line: its edges stand for all of it.
    round += height;
    out.slack = -1;
    for (auto& side : out.side) set(side, Eigen::Vector3d::Zero());
  }
  out.round = round_up(round);
  return out;
}

}  // namespace mjarm::detail
