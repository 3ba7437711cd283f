#include "mjarm/path/curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/core/rotation.hpp"
#include "mjarm/path/curve_make_internal.hpp"

namespace mjarm {

bool detail::smooth_joint(const CurvePiece& before, const CurvePiece& after) {
  constexpr double kTangent = 1e-7, kRate = 1e-6;
  if (before.length == 0 || after.length == 0) return false;
  return (before.direction(before.span) - after.direction(0)).norm() < kTangent &&
         (before.turn_rate(before.span) - after.turn_rate(0)).norm() <= kRate * (1 + before.rate);
}

Curve::Curve(std::vector<CurvePiece> pieces, std::vector<CurveBlend> blends,
             std::vector<double> joints)
    : pieces_(std::move(pieces)), blends_(std::move(blends)), breaks_(std::move(joints)) {
  double s = 0;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    pieces_[i].start = s;
    if (i == 0 || !detail::smooth_joint(pieces_[i - 1], pieces_[i])) corners_.push_back(s);
    s += pieces_[i].span;
  }
  corners_.push_back(s);
}

double Curve::length() const noexcept {
  double sum = 0;
  for (const CurvePiece& piece : pieces_) sum += piece.length;
  return sum;
}

double Curve::turn() const noexcept {
  double sum = 0;
  for (const CurvePiece& piece : pieces_) sum += piece.turn;
  return sum;
}

double Curve::end() const noexcept { return corners_.back(); }

bool Curve::closed() const noexcept {
  constexpr double kSame = 1e-9;  // [m], [rad]
  const Pose first = pieces_.front().at(0), last = pieces_.back().at(pieces_.back().span);
  return (first.p - last.p).norm() <= kSame && angle_between(first.R, last.R) <= kSame;
}

Pose Curve::at(double s) const {
  const auto after = std::upper_bound(pieces_.begin() + 1, pieces_.end(), s,
                                      [](double value, const auto& p) { return value < p.start; });
  const CurvePiece& piece = *(after - 1);
  return piece.at(std::clamp(s - piece.start, 0.0, piece.span));
}

std::vector<Pose> Curve::poses(std::span<const double> s) const {
  std::vector<Pose> poses;
  poses.reserve(s.size());
  for (const double x : s) poses.push_back(at(x));
  return poses;
}

const std::vector<double>& Curve::corners() const noexcept { return corners_; }

const std::vector<CurveBlend>& Curve::blends() const noexcept { return blends_; }

const std::vector<double>& Curve::breaks() const noexcept { return breaks_; }

std::vector<double> Curve::stations(double step, double angle) const {
  std::vector<double> s{0.0};
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const CurvePiece& piece = pieces_[i];
    const double cells =
        std::max({1.0, std::ceil(piece.length / step), std::ceil(piece.rate * piece.span / angle)});
    for (double k = 1; k < cells; ++k) s.push_back(piece.start + piece.span * (k / cells));
    s.push_back(i + 1 < pieces_.size() ? pieces_[i + 1].start : end());
  }
  return s;
}

Curve::Nearest Curve::nearest(const Eigen::Vector3d& p) const {
  Nearest best{0, std::numeric_limits<double>::infinity()};
  for (const CurvePiece& piece : pieces_) {
    // No point of a piece is farther from its first one than its length.
    if ((piece.p0 - p).norm() - piece.length > best.distance) continue;
    const double x = piece.nearest(p, best.distance);
    const double distance = (piece.at(x).p - p).norm();
    if (distance < best.distance) best = {piece.start + x, distance};
  }
  return best;
}

}  // namespace mjarm
