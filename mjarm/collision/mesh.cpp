#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "mjarm/collision/mesh_internal.hpp"

namespace mjarm {
namespace detail {
namespace {

/// A turn that no mesh has its edges along.
const Eigen::Matrix3d& odd_turn() {
  static const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.7236067, Eigen::Vector3d(0.2653, 0.5897, 0.9323).normalized())
          .toRotationMatrix();
  return R;
}

double cross2(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& p) {
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

}  // namespace

double distance_to_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                            const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const auto to_edge = [&p](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const Eigen::Vector3d way = to - from;
    const double length2 = way.squaredNorm();
    const double t = length2 > 0 ? std::clamp(way.dot(p - from) / length2, 0.0, 1.0) : 0;
    return (from + t * way - p).norm();
  };
  const double edges = std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
  const Eigen::Vector3d n = (b - a).cross(c - a);
  const double area = n.norm();
  if (area == 0) return edges;
  const bool above = n.dot((b - a).cross(p - a)) >= 0 && n.dot((c - b).cross(p - b)) >= 0 &&
                     n.dot((a - c).cross(p - c)) >= 0;
  return above ? std::min(edges, std::abs(n.dot(p - a)) / area) : edges;
}

InsideTest::InsideTest(std::span<const Eigen::Vector3d> vertices,
                       std::span<const std::array<int, 3>> faces)
    : faces_(faces) {
  for (const Eigen::Vector3d& vertex : vertices) vertices_.push_back(odd_turn() * vertex);
  low_ = high_ = vertices_.front();
  for (const Eigen::Vector3d& vertex : vertices_) {
    low_ = low_.cwiseMin(vertex);
    high_ = high_.cwiseMax(vertex);
  }
  // Large faces are in many bins: there are fewer where that would be too much.
  bins_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(faces.size()))), 1, 64);
  while (bins_ > 1 && count_in_bins() > 8 * faces.size() + 10'000) bins_ /= 2;
  faces_of_bin_.resize(static_cast<std::size_t>(bins_ * bins_));
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Bins in = bins_of(faces[f]);
    for (int y = in.first[1]; y <= in.last[1]; ++y) {
      for (int x = in.first[0]; x <= in.last[0]; ++x) {
        faces_of_bin_[static_cast<std::size_t>(y * bins_ + x)].push_back(static_cast<int>(f));
      }
    }
  }
}

InsideTest::Bins InsideTest::bins_of(const std::array<int, 3>& face) const {
  Bins out;
  for (int k = 0; k < 2; ++k) {
    const auto bin = [&](int vertex) {
      const double x = vertices_[static_cast<std::size_t>(vertex)][k];
      const double at = (x - low_[k]) / std::max(high_[k] - low_[k], 1e-300) * bins_;
      return static_cast<int>(std::clamp(at, 0.0, bins_ - 1.0));
    };
    std::tie(out.first[k], out.last[k]) = std::minmax({bin(face[0]), bin(face[1]), bin(face[2])});
  }
  return out;
}

std::size_t InsideTest::count_in_bins() const {
  std::size_t count = 0;
  for (const std::array<int, 3>& face : faces_) {
    const Bins in = bins_of(face);
    count += static_cast<std::size_t>(in.last[0] - in.first[0] + 1) *
             static_cast<std::size_t>(in.last[1] - in.first[1] + 1);
  }
  return count;
}

const std::vector<int>* InsideTest::faces_above(const Eigen::Vector3d& p) const {
  if ((p.array() < low_.array()).any() || (p.array() > high_.array()).any()) return nullptr;
  const Eigen::Array3d at = (p - low_).array() / (high_ - low_).array().max(1e-300) * bins_;
  const int x = std::min(static_cast<int>(at.x()), bins_ - 1);
  const int y = std::min(static_cast<int>(at.y()), bins_ - 1);
  return &faces_of_bin_[static_cast<std::size_t>(y * bins_ + x)];
}

/// Of the ray from p along z.
InsideTest::Crossing InsideTest::crossing(const std::array<int, 3>& face,
                                          const Eigen::Vector3d& p) const {
  const Eigen::Vector3d& a = vertices_[static_cast<std::size_t>(face[0])];
  const Eigen::Vector3d& b = vertices_[static_cast<std::size_t>(face[1])];
  const Eigen::Vector3d& c = vertices_[static_cast<std::size_t>(face[2])];
  const double u = cross2(b, c, p), v = cross2(c, a, p), w = cross2(a, b, p);
  const double sum = u + v + w;
  const double size = (high_ - low_).squaredNorm();
  if ((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0)) {
    const double height = (u * a.z() + v * b.z() + w * c.z()) / sum;
    return height > p.z() ? Crossing::one : Crossing::none;
  }
  const double least = std::min({u, v, w}), max = std::max({u, v, w});
  const bool near_edge = least >= -1e-14 * size || max <= 1e-14 * size;
  return near_edge && std::max({a.z(), b.z(), c.z()}) > p.z() ? Crossing::unclear : Crossing::none;
}

bool InsideTest::is_inside(const Eigen::Vector3d& p) const {
  const double size = (high_ - low_).norm();
  bool inside = false;
  // Where the ray meets an edge it is tried again a little beside.
  for (int attempt = 0; attempt < 8; ++attempt) {
    const Eigen::Vector3d beside(0.31 * attempt, 0.57 * attempt, 0.11 * attempt);
    const Eigen::Vector3d from = odd_turn() * p + 1e-9 * size * beside;
    const std::vector<int>* const faces = faces_above(from);
    if (faces == nullptr) return false;
    bool clear = true;
    inside = false;
    for (const int f : *faces) {
      const Crossing found = crossing(faces_[static_cast<std::size_t>(f)], from);
      clear = clear && found != Crossing::unclear;
      if (found == Crossing::one) inside = !inside;
    }
    if (clear) return inside;
  }
  return inside;
}

}  // namespace detail

bool is_closed(const MeshShape& mesh) {
  // Corners in one place count as one.
  std::vector<std::size_t> order(mesh.vertices.size()), place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto less = [&](std::size_t a, std::size_t b) {
    const Eigen::Vector3d &p = mesh.vertices[a], &q = mesh.vertices[b];
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  };
  std::sort(order.begin(), order.end(), less);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && !less(order[i - 1], order[i]);
    place[order[i]] = same ? place[order[i - 1]] : order[i];
  }
  std::vector<std::array<std::size_t, 2>> edges;
  for (const std::array<int, 3>& face : mesh.faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t a = place[static_cast<std::size_t>(face[i])];
      const std::size_t b = place[static_cast<std::size_t>(face[(i + 1) % 3])];
      if (a != b) edges.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    if (i + 1 == edges.size() || edges[i] != edges[i + 1]) return false;
  }
  return !edges.empty();
}

}  // namespace mjarm
