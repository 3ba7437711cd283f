#include "mjarm/perception/symmetry.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "mjarm/core/rotation.hpp"
#include "mjarm/perception/shape_model_internal.hpp"

namespace mjarm::perception {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLooksSame = 2.5e-4;   // [m] rms; a prism of six sides, 25 mm, is 1 mm off round
constexpr double kSameAxis = 0.02;      // [rad]
constexpr std::size_t kAxes = 16;       // of faces, the largest ones
constexpr std::size_t kMostTurns = 60;  // of an icosahedron
constexpr int kMostFold = 12;           // about one axis

/// [m^2] from a point to a triangle (C. Ericson, Real-Time Collision Detection, 5.1.5).
double squared_distance(const Vector3d& p, const std::array<Vector3d, 3>& corner) {
  const Vector3d u = corner[1] - corner[0];
  const Vector3d v = corner[2] - corner[0];
  const Vector3d n = u.cross(v);
  const Vector3d w = p - corner[0];
  const double area = n.squaredNorm();
  if (area > 0) {
    const double s = w.cross(v).dot(n) / area;
    const double t = u.cross(w).dot(n) / area;
    if (s >= 0 && t >= 0 && s + t <= 1) return std::pow(w.dot(n), 2) / area;
  }
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d edge = corner[(k + 1) % 3] - corner[k];
    const Vector3d from = p - corner[k];
    const double length = edge.squaredNorm();
    const double along = length > 0 ? std::clamp(from.dot(edge) / length, 0.0, 1.0) : 0;
    least = std::min(least, (from - along * edge).squaredNorm());
  }
  return least;
}

/// Directions about which the surface may be symmetrical, without their opposites.
std::vector<Vector3d> likely_axes(const ShapeModel& shape) {
  std::vector<Vector3d> out;
  const auto add = [&](const Vector3d& axis) {
    const auto same = [&](const Vector3d& known) { return known.cross(axis).norm() < kSameAxis; };
    if (std::ranges::none_of(out, same)) out.push_back(axis);
  };
  const Surface& surface = shape.fine.surface;
  std::vector<Vector3d> faces;  // normals, as long as they are large
  for (const auto& t : surface.triangles) {
    const auto at = [&](std::size_t i) { return surface.vertices[static_cast<std::size_t>(t[i])]; };
    const Vector3d normal = (at(1) - at(0)).cross(at(2) - at(0));
    const auto along = std::ranges::find_if(faces, [&](const Vector3d& other) {
      return other.cross(normal).norm() < kSameAxis * other.norm() * normal.norm();
    });
    if (along == faces.end()) {
      faces.push_back(normal);
    } else {
      *along += along->dot(normal) < 0 ? Vector3d(-normal) : normal;
    }
  }
  std::ranges::stable_sort(faces, std::greater(), &Vector3d::squaredNorm);
  for (std::size_t k = 0; k < std::min(faces.size(), kAxes); ++k) {
    if (faces[k].norm() > 0) add(faces[k].normalized());
  }
  for (int k = 0; k < 3; ++k) add(shape.axes.col(k));
  return out;
}

class Group {
 public:
  explicit Group(const Surface& surface) : shape_(surface) {
    for (const auto& t : surface.triangles) {
      const auto at = [&](std::size_t i) {
        return surface.vertices[static_cast<std::size_t>(t[i])];
      };
      corners_.push_back({at(0), at(1), at(2)});
    }
  }

  std::vector<Pose> find() {
    const std::vector<Vector3d> axes = likely_axes(shape_);
    turns_.push_back(Matrix3d::Identity());
    const auto round =
        std::ranges::find_if(axes, [this](const Vector3d& axis) { return is_round(axis); });
    if (round != axes.end()) {
      close(turn(*round, 2 * std::numbers::pi / kRoundTurns));
      const Matrix3d flip = turn(round->unitOrthogonal(), std::numbers::pi);
      if (is_same(flip)) close(flip);
    } else {
      for (const Vector3d& axis : axes) {
        const int fold = fold_of(axis);
        if (fold > 1) close(turn(axis, 2 * std::numbers::pi / fold));
      }
    }
    std::vector<Pose> out;
    for (const Matrix3d& R : turns_) out.push_back(about_centre(R));
    return out;
  }

 private:
  static Matrix3d turn(const Vector3d& axis, double angle) {
    return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  }
  [[nodiscard]] Pose about_centre(const Matrix3d& R) const {
    return {shape_.centre - R * shape_.centre, R};
  }
  /// Whether the points of the surface, turned, lie on it.
  [[nodiscard]] bool is_same(const Matrix3d& R) const {
    const Pose X = about_centre(R);
    double left = kLooksSame * kLooksSame * static_cast<double>(shape_.points.size());
    for (const Vector3d& point : shape_.points) {
      const Vector3d p = X * point;
      double least = std::numeric_limits<double>::infinity();
      for (const auto& corner : corners_) least = std::min(least, squared_distance(p, corner));
      left -= least;
      if (left < 0) return false;
    }
    return true;
  }

  [[nodiscard]] bool is_round(const Vector3d& axis) const {
    constexpr double kOdd = 0.7;  // [rad] no part of a turn
    return is_same(turn(axis, kOdd)) && is_same(turn(axis, 2 * kOdd));
  }
  /// How often it looks the same in one turn about an axis.
  [[nodiscard]] int fold_of(const Vector3d& axis) const {
    for (int fold = kMostFold; fold > 1; --fold) {
      if (is_same(turn(axis, 2 * std::numbers::pi / fold))) return fold;
    }
    return 1;
  }

  /// Adds a rotation and all that follows from it.
  void close(const Matrix3d& R) {
    std::vector<Matrix3d> fresh{R};
    while (!fresh.empty() && turns_.size() < kMostTurns) {
      const Matrix3d next = fresh.back();
      fresh.pop_back();
      const auto known = [&](const Matrix3d& other) { return angle_between(other, next) < 0.05; };
      if (std::ranges::any_of(turns_, known)) continue;
      turns_.push_back(next);
      for (std::size_t k = 0; k < turns_.size(); ++k) {
        fresh.push_back(next * turns_[k]);
        fresh.push_back(turns_[k] * next);
      }
    }
  }

  ShapeModel shape_;
  std::vector<std::array<Vector3d, 3>> corners_;  ///< of the triangles
  std::vector<Matrix3d> turns_;
};

}  // namespace

std::vector<Pose> symmetries(const Surface& surface) { return Group(surface).find(); }

}  // namespace mjarm::perception
