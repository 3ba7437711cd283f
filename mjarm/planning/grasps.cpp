#include "mjarm/planning/grasps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace mjarm {
namespace {

using Eigen::Vector3d;
using Kind = ShapePart::Kind;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Two opposite points of a body that fingers may press on.
struct Pinch {
  Vector3d center_B;                    ///< [m] midway
  Vector3d close_B;                     ///< unit
  Vector3d first_B;                     ///< unit, square to close_B: an approach that suits it
  double width = 0;                     ///< [m]
  Vector3d along_B = Vector3d::Zero();  ///< it was moved along that; zero: it was not
};

/// [m] how far the part reaches along `way_G` (unit) from its origin.
double reach(const ShapePart& part, const Vector3d& way_G) {
  const Vector3d& s = part.size;
  const double round = way_G.head<2>().norm();
  switch (part.kind) {
    case Kind::box:
      return s.dot(way_G.cwiseAbs());
    case Kind::ellipsoid:
      return s.cwiseProduct(way_G).norm();
    case Kind::ball:
      return s[0];
    case Kind::cylinder:
      return s[0] * round + s[1] * std::abs(way_G.z());
    case Kind::capsule:
      return s[0] + s[1] * std::abs(way_G.z());
    case Kind::hull:
      break;
  }
  double far = -kInfinite;
  for (const Vector3d& vertex : part.vertices) far = std::max(far, vertex.dot(way_G));
  return far;
}

/// [m] how far the body reaches along `way_B` from `p_B`.
double reach(const ObjectShape& shape, const Vector3d& p_B, const Vector3d& way_B) {
  double far = -kInfinite;
  for (const ShapePart& part : shape.parts) {
    const Vector3d way_G = part.X_BG.R.transpose() * way_B;
    far = std::max(far, reach(part, way_G) + (part.X_BG.p - p_B).dot(way_B));
  }
  return far;
}

/// Finds the pinches of one part, in the frame of the body.
class PinchFinder {
 public:
  PinchFinder(const ShapePart& part, const Jaws& jaws, const GraspOptions& options,
              std::vector<Pinch>& out)
      : part_(part), jaws_(jaws), options_(options), out_(out) {}

  void find() {
    const Vector3d& s = part_.size;
    switch (part_.kind) {
      case Kind::box:
        for (int i = 0; i < 3; ++i) {
          add(Vector3d::Unit(i), 2 * s[i]);
          for (const int j : {(i + 1) % 3, (i + 2) % 3})
            beside(Vector3d::Unit(i), 2 * s[i], j, s[j]);
        }
        break;
      case Kind::ellipsoid:
        for (int i = 0; i < 3; ++i) add(Vector3d::Unit(i), 2 * s[i]);
        break;
      case Kind::cylinder:
      case Kind::capsule:
        round(2 * s[0], s[1]);
        add(Vector3d::UnitZ(), 2 * (part_.kind == Kind::capsule ? s[0] + s[1] : s[1]));
        break;
      case Kind::ball:
        for (int i = 0; i < 3; ++i) add(Vector3d::Unit(i), 2 * s[0]);
        round(2 * s[0], 0);
        break;
      case Kind::hull:
        through_hull();
        break;
    }
  }

 private:
  void add(const Vector3d& close_G, double width, const Vector3d& center_G = Vector3d::Zero(),
           const Vector3d& along_G = Vector3d::Zero()) {
    const Vector3d first =
        along_G.isZero() ? Vector3d(close_G.unitOrthogonal()) : Vector3d(close_G.cross(along_G));
    const Eigen::Matrix3d& R_BG = part_.X_BG.R;
    out_.push_back({part_.X_BG * center_G, R_BG * close_G, R_BG * first, width, R_BG * along_G});
  }

  /// The same on both sides of the middle, where the part is longer than the fingers are wide.
  void beside(const Vector3d& close_G, double width, int axis, double half) {
    if (half < 2 * jaws_.half_width) return;
    for (const double share : {-0.5, 0.5}) {
      add(close_G, width, share * half * Vector3d::Unit(axis), Vector3d::Unit(axis));
    }
  }

  void round(double width, double half) {
    for (int k = 0; k < options_.turns; ++k) {
      const double angle = std::numbers::pi * k / options_.turns;
      const Vector3d close(std::cos(angle), std::sin(angle), 0);
      add(close, width);
      beside(close, width, 2, half);
    }
  }

  /// Where a ray from inside along `way_G` leaves the hull, and the normal there.
  [[nodiscard]] std::pair<double, Vector3d> leaves(const Vector3d& p_G,
                                                   const Vector3d& way_G) const {
    double nearest = kInfinite;
    Vector3d normal = Vector3d::Zero();
    for (std::size_t f = 0; f < part_.faces.size(); ++f) {
      const Vector3d n = normal_of(f);
      const double rate = n.dot(way_G);
      if (rate < 1e-9) continue;
      const double far = n.dot(corner(f, 0) - p_G) / rate;
      if (far >= nearest) continue;
      nearest = far;
      normal = n;
    }
    return {nearest, normal};
  }

  void through_hull() {
    for (const Flat& flat : flats()) through(flat.center(), flat.normal);
    for (std::size_t f = 0; f < part_.faces.size(); ++f) {
      if (const Vector3d n = normal_of(f); !n.isZero()) through(middle(f), n);
    }
  }

  /// Pressed on at `p` of a face with that normal, and opposite.
  void through(const Vector3d& p, const Vector3d& normal) {
    const auto [width, there] = leaves(p, -normal);
    if (width == kInfinite || -there.dot(normal) < std::cos(options_.slope)) return;
    // Both faces share what they are off parallel.
    const Vector3d close = (normal - there).normalized();
    const Vector3d center = p - normal * width / 2;
    if (is_known(center, close)) return;
    add(close, reach(part_, close) + reach(part_, -close), center);
    found_.push_back({center, close});
  }

  /// Triangles that are one flat face of the hull.
  struct Flat {
    Vector3d normal, moment = Vector3d::Zero();
    double area = 0;
    [[nodiscard]] Vector3d center() const { return moment / area; }
  };

  [[nodiscard]] std::vector<Flat> flats() const {
    constexpr double kSame = 0.9999;  // cosine of two normals: 0.8 deg
    std::vector<Flat> out;
    for (std::size_t f = 0; f < part_.faces.size(); ++f) {
      const Vector3d n = normal_of(f);
      if (n.isZero()) continue;
      auto flat =
          std::ranges::find_if(out, [&](const Flat& one) { return one.normal.dot(n) > kSame; });
      if (flat == out.end()) flat = out.insert(flat, {.normal = n});
      const double area =
          (corner(f, 1) - corner(f, 0)).cross(corner(f, 2) - corner(f, 0)).norm() / 2;
      flat->area += area;
      flat->moment += area * middle(f);
    }
    return out;
  }

  /// Faces that are parts of one flat face say the same.
  [[nodiscard]] bool is_known(const Vector3d& center, const Vector3d& close) const {
    return std::ranges::any_of(found_, [&](const auto& one) {
      return std::abs(one.second.dot(close)) > 0.985 &&
             (one.first - center).norm() < jaws_.half_width;
    });
  }

  [[nodiscard]] const Vector3d& corner(std::size_t face, std::size_t k) const {
    return part_.vertices[static_cast<std::size_t>(part_.faces[face][k])];
  }
  [[nodiscard]] Vector3d middle(std::size_t face) const {
    return (corner(face, 0) + corner(face, 1) + corner(face, 2)) / 3;
  }
  [[nodiscard]] Vector3d normal_of(std::size_t face) const {
    const Vector3d n = (corner(face, 1) - corner(face, 0)).cross(corner(face, 2) - corner(face, 0));
    return n.norm() > 0 ? n.normalized() : Vector3d::Zero();
  }

  const ShapePart& part_;
  const Jaws& jaws_;
  const GraspOptions& options_;
  std::vector<Pinch>& out_;
  std::vector<std::pair<Vector3d, Vector3d>> found_;
};

/// The tool at a pinch, coming up along `approach_B`; none where the fingers cannot reach over it.
std::optional<Pose> tool_at(const ObjectShape& shape, const Pinch& pinch,
                            const Vector3d& approach_B, const Jaws& jaws,
                            const GraspOptions& options) {
  const double front = reach(shape, pinch.center_B, approach_B);
  const double back = reach(shape, pinch.center_B, -approach_B);
  const double depth =
      std::min({0.0, front - jaws.tips - options.keep_off, jaws.palm - back - options.keep_off});
  if (depth + jaws.tips < options.contact - back) return std::nullopt;
  Eigen::Matrix3d of_B, of_T;
  of_B << pinch.close_B, approach_B, approach_B.cross(pinch.close_B);
  of_T << jaws.close_T, jaws.approach_T, jaws.side_T();
  const Eigen::Matrix3d R_BT = of_B * of_T.transpose();
  return Pose{pinch.center_B + depth * approach_B - R_BT * jaws.center_T, R_BT};
}

/// The approach that others are turned from.
Vector3d first_approach(const Pinch& pinch, const GraspOptions& options) {
  const Vector3d& wanted = options.approach_B;
  const Vector3d square = wanted - wanted.dot(pinch.close_B) * pinch.close_B;
  return square.norm() > 0.1 ? square.normalized() : pinch.first_B;
}

}  // namespace

Grasps find_grasps(const ObjectShape& shape, const Jaws& jaws, const GraspOptions& options) {
  std::vector<Pinch> pinches;
  for (const ShapePart& part : shape.parts) PinchFinder(part, jaws, options, pinches).find();
  Grasps out{.all = {}, .narrowest = kInfinite};
  for (Pinch& pinch : pinches) {
    out.narrowest = std::min(out.narrowest, pinch.width);
    if (pinch.width + options.spare > jaws.opening) continue;
    const Vector3d arm = shape.center_B - pinch.center_B;
    const double off = (arm - arm.dot(pinch.close_B) * pinch.close_B).norm();
    const Vector3d first = first_approach(pinch, options);
    for (int k = 0; k < options.turns; ++k) {
      const double angle = 2 * std::numbers::pi * k / options.turns;
      const Vector3d approach =
          std::cos(angle) * first + std::sin(angle) * pinch.close_B.cross(first);
      if (std::abs(approach.dot(pinch.along_B)) > 0.8) continue;
      for (const double way : {1.0, -1.0}) {
        Pinch turned = pinch;
        turned.close_B = way * pinch.close_B;
        const auto X_BT = tool_at(shape, turned, approach, jaws, options);
        if (X_BT) out.all.push_back({*X_BT, pinch.width, off});
      }
    }
  }
  std::ranges::stable_sort(out.all, {}, &Grasp::off_center);
  return out;
}

}  // namespace mjarm
