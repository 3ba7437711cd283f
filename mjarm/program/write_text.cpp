#include <algorithm>
#include <optional>

#include "mjarm/path/letters.hpp"
#include "mjarm/program/write_text_internal.hpp"

namespace mjarm::program::detail {
namespace {

/// Legs of a curve that is written one after another.
class Legs {
 public:
  void add(Result<Curve> leg) {
    if (leg) legs_.push_back(std::move(*leg));
    if (!leg && !error_) error_ = std::move(leg.error());
  }

  /// Straight from pose to pose.
  void add_lines(const std::vector<Pose>& poses) {
    constexpr double kSame = 1e-9;  // [m]
    for (std::size_t i = 1; i < poses.size(); ++i) {
      if ((poses[i].p - poses[i - 1].p).norm() > kSame) add(Curve::line(poses[i - 1], poses[i]));
    }
  }

  [[nodiscard]] Result<Curve> joined() const {
    if (error_) return fail(*error_);
    return Curve::joined(legs_, std::vector<double>(legs_.empty() ? 0 : legs_.size() - 1, 0.0));
  }

 private:
  std::vector<Curve> legs_;
  std::optional<Error> error_;
};

/// The poses of a stroke, and those of the lifted pen before and after it.
struct DrawnStroke {
  std::vector<Pose> poses;
  Pose before, after;
  bool smooth = false;
};

Result<WrittenText> straight(const std::vector<DrawnStroke>& strokes) {
  std::vector<Pose> corners;
  for (const DrawnStroke& stroke : strokes) {
    corners.push_back(stroke.before);
    corners.insert(corners.end(), stroke.poses.begin(), stroke.poses.end());
    corners.push_back(stroke.after);
  }
  Result<Curve> curve = Curve::polyline(corners);
  if (!curve) return fail(std::move(curve.error()));
  return WrittenText{std::move(*curve), std::move(corners)};
}

Result<WrittenText> smooth(const std::vector<DrawnStroke>& strokes) {
  Legs legs;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const DrawnStroke& stroke = strokes[i];
    if (i > 0) legs.add_lines({strokes[i - 1].after, stroke.before});
    legs.add_lines({stroke.before, stroke.poses.front()});
    if (stroke.smooth) {
      legs.add(Curve::spline(stroke.poses, kStrokeCorner));
    } else {
      legs.add_lines(stroke.poses);
    }
    legs.add_lines({stroke.poses.back(), stroke.after});
  }
  Result<Curve> curve = legs.joined();
  if (!curve) return fail(std::move(curve.error()));
  return WrittenText{std::move(*curve), {}};
}

/// In the world, as write_text() has them.
Result<std::vector<DrawnStroke>> drawn_strokes(const DrawText& text, const Pose& X_WP,
                                               const Eigen::Matrix3d& R_WT) {
  const auto strokes = letter_strokes(text.text, text.height);
  if (!strokes) return fail(strokes.error());
  const Eigen::Vector3d lift = -text.lift * R_WT.col(2);
  std::vector<DrawnStroke> drawn;
  for (const Stroke& stroke : *strokes) {
    DrawnStroke one{.poses = {}, .before = {}, .after = {}, .smooth = stroke.smooth};
    for (const Eigen::Vector2d& p : stroke.points) {
      one.poses.push_back({X_WP * Eigen::Vector3d(p.x(), p.y(), 0), R_WT});
    }
    one.before = {one.poses.front().p + lift, R_WT};
    one.after = {one.poses.back().p + lift, R_WT};
    drawn.push_back(std::move(one));
  }
  return drawn;
}

}  // namespace

Result<std::vector<Curve>> lifted_strokes(const DrawText& text, const Pose& X_WP,
                                          const Eigen::Matrix3d& R_WT) {
  auto drawn = drawn_strokes(text, X_WP, R_WT);
  if (!drawn) return fail(drawn.error());
  std::vector<Curve> curves;
  for (DrawnStroke& stroke : *drawn) {
    for (Pose& X_WT : stroke.poses) X_WT.p -= text.lift * R_WT.col(2);
    Result<Curve> curve =
        stroke.smooth ? Curve::spline(stroke.poses, kStrokeCorner) : Curve::polyline(stroke.poses);
    if (!curve) return fail(std::move(curve.error()));
    curves.push_back(std::move(*curve));
  }
  return curves;
}

Result<WrittenText> write_text(const DrawText& text, const Pose& X_WP,
                               const Eigen::Matrix3d& R_WT) {
  const auto drawn = drawn_strokes(text, X_WP, R_WT);
  if (!drawn) return fail(drawn.error());
  const bool any_smooth = std::ranges::any_of(*drawn, &DrawnStroke::smooth);
  return any_smooth ? smooth(*drawn) : straight(*drawn);
}

}  // namespace mjarm::program::detail
