#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "mjarm/collision/random_scene_test.hpp"

namespace mjarm::testing {

/// A robot in or before a cage whose only way in is a square hole in one wall.
struct Caged {
  Arm arm;
  SphereSet set;
  Obstacles world;
  std::vector<JointVec> way;  ///< through the hole, from start to goal
  std::size_t inside = 0;     ///< which end of it is in the cage
  double widest = 0;          ///< [m] radius of the ball that has to pass
};

/// One wall of a cage, made of any kind of obstacle.
class WallMaker {
 public:
  WallMaker(const Pose& X_WC, Rng& rng) : X_WC_(X_WC), rng_(rng) {}

  /// @param low, high  corners, in C.
  void add(const Eigen::Vector3d& low, const Eigen::Vector3d& high, Obstacles& out) const {
    const Eigen::Vector3d half = 0.5 * (high - low);
    Obstacle wall{"wall", X_WC_ * Pose{0.5 * (low + high), Eigen::Matrix3d::Identity()}, {}};
    switch (rng_.below(5)) {
      case 0:
        wall.shape = make_polytope(corners(half)).value();
        break;
      case 1:
        wall.shape = mesh(half);
        break;
      case 2:
        wall.shape = HeightFieldShape{.rows = 3,
                                      .cols = 4,
                                      .half = half.head<2>(),
                                      .bottom = -half.z(),
                                      .heights = std::vector<double>(12, half.z())};
        break;
      case 3:
        out.clouds.push_back(cloud(wall.X_WO, half));
        return;
      default:
        wall.shape = BoxShape{half};
    }
    out.solids.push_back(wall);
  }

 private:
  static std::vector<Eigen::Vector3d> corners(const Eigen::Vector3d& half) {
    std::vector<Eigen::Vector3d> out;
    for (int k = 0; k < 8; ++k) {
      out.emplace_back((k & 1) != 0 ? half.x() : -half.x(), (k & 2) != 0 ? half.y() : -half.y(),
                       (k & 4) != 0 ? half.z() : -half.z());
    }
    return out;
  }

  MeshShape mesh(const Eigen::Vector3d& half) const {
    MeshShape out{corners(half), {}, rng_.uniform() < 0.5};
    for (const auto& [a, b, c, d] :
         {std::array{0, 1, 3, 2}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
          std::array{2, 3, 7, 6}, std::array{0, 2, 6, 4}, std::array{1, 3, 7, 5}}) {
      out.faces.push_back({a, b, c});
      out.faces.push_back({a, c, d});
    }
    return out;
  }

  /// Balls in rows, that reach as far as the wall does along its long sides.
  static PointCloud cloud(const Pose& X_WO, const Eigen::Vector3d& half) {
    PointCloud out{"cloud", {}, half.minCoeff()};
    std::array<int, 3> count{};
    for (int k = 0; k < 3; ++k) {
      const double room = std::max(2 * (half[k] - out.radius), 0.0);
      count[static_cast<std::size_t>(k)] = 1 + static_cast<int>(std::ceil(room / out.radius));
    }
    const auto at = [&](int i, int axis) {
      const double room = std::max(half[axis] - out.radius, 0.0);
      const int n = count[static_cast<std::size_t>(axis)];
      return n > 1 ? room * (2.0 * i / (n - 1) - 1) : 0.0;
    };
    for (int i = 0; i < count[0]; ++i) {
      for (int j = 0; j < count[1]; ++j) {
        for (int k = 0; k < count[2]; ++k) {
          out.points_W.push_back(X_WO * Eigen::Vector3d(at(i, 0), at(j, 1), at(k, 2)));
        }
      }
    }
    return out;
  }

  const Pose& X_WC_;
  Rng& rng_;
};

/// A cage round the origin of C.
/// @param inner  [m] half its width inside.
/// @param hole   [m] half the width of the hole in the wall at x > 0.
inline Obstacles cage(const Pose& X_WC, double inner, double hole, Rng& rng) {
  const double thick = rng.uniform(0.012, 0.04), outer = inner + thick;
  const WallMaker walls(X_WC, rng);
  Obstacles out;
  walls.add({-outer, -outer, -outer}, {-inner, outer, outer}, out);
  for (const double side : {-1.0, 1.0}) {
    const auto [a, b] = std::minmax({side * inner, side * outer});
    walls.add({-inner, a, -outer}, {outer, b, outer}, out);
    walls.add({-inner, -inner, a}, {outer, inner, b}, out);
    const auto [c, d] = std::minmax({side * hole, side * inner});
    walls.add({inner, c, -inner}, {outer, d, inner}, out);
    walls.add({inner, -hole, c}, {outer, hole, d}, out);
  }
  return out;
}

/// [m] half the width of a hole that a ball fits through, or not.
inline double hole_for(double radius, bool open, Rng& rng) {
  return open ? radius + rng.uniform(0.002, 0.006) : radius * rng.uniform(0.02, 0.7);
}

/// Half of the ways lead out of the cage, half into it.
inline void turn_round(Rng& rng, Caged& caged) {
  if (rng.uniform() < 0.5) return;
  std::swap(caged.way[0], caged.way[1]);
  caged.inside = 1 - caged.inside;
}

/// Three slides and a wrist carry a ball and a smaller one in it, which start or end in the cage.
inline Caged flying_robot(bool open, Rng& rng) {
  constexpr double kFar = 2;
  Caged out;
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ(), none = Eigen::Vector3d::Zero();
  out.arm = make_arm("flying",
                     {{none, none, x, -kFar, kFar, JointType::slide},
                      {none, none, y, -kFar, kFar, JointType::slide},
                      {none, none, z, -kFar, kFar, JointType::slide},
                      {none, none, x, -3, 3}},
                     Pose());
  out.widest = rng.uniform(0.03, 0.08);
  out.set.links.push_back(
      {"hand", 3, {{0.4 * out.widest * y, 0.5 * out.widest}, {none, out.widest}}});
  Pose X_WC{random_vector(rng, 0.5), from_euler(random_vector(rng, 3))};
  const double inner = out.widest + rng.uniform(0.03, 0.1);
  out.world = cage(X_WC, inner, hole_for(out.widest, open, rng), rng);
  for (const double at : {0.0, inner + 0.3}) {
    JointVec q = JointVec::Zero(4);
    q.head<3>() = X_WC * Eigen::Vector3d(at, 0, 0);
    q[3] = at;
    out.way.push_back(q);
  }
  turn_round(rng, out);
  return out;
}

/// A turning arm with a thin boom that can be drawn out, through the hole, and a hand at its end.
inline Caged reaching_robot(bool open, Rng& rng) {
  Caged out;
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), z = Eigen::Vector3d::UnitZ(),
                        none = Eigen::Vector3d::Zero();
  out.arm = make_arm("reaching",
                     {{none, none, z, -3, 3},
                      {none, none, Eigen::Vector3d::UnitY(), -1.5, 1.5},
                      {none, none, x, 0, 0.8, JointType::slide},
                      {none, none, x, -3, 3}},
                     Pose());
  out.widest = rng.uniform(0.04, 0.08);
  constexpr double kBoom = 0.3;  // length of it, and of what is before its end
  LinkSpheres boom{"boom", 2, {}};
  for (double at = 0; at < kBoom; at += 0.01) boom.spheres.push_back({at * x, 0.006});
  out.set.links = {boom, {"hand", 3, {{kBoom * x, out.widest}, {kBoom * x, 0.02}}}};
  const double inner = out.widest + rng.uniform(0.03, 0.1);
  const double hole = open ? hole_for(out.widest, true, rng) : rng.uniform(0.008, 0.7 * out.widest);
  const double turn = rng.uniform(-2, 2), lean = rng.uniform(-0.8, 0.8);
  const Eigen::Matrix3d R = from_euler({0, 0, turn}) * from_euler({0, lean, 0});
  const double far = kBoom + 0.6;
  // The hole looks at the arm.
  const Pose X_WC{R * (far * x), R * from_euler({0, 0, std::numbers::pi})};
  out.world = cage(X_WC, inner, hole, rng);
  for (const double at : {0.0, 0.6}) {
    JointVec q(4);
    q << turn, lean, at, 0.3;
    out.way.push_back(q);
  }
  out.inside = 1;
  turn_round(rng, out);
  return out;
}

}  // namespace mjarm::testing
