#include <gtest/gtest.h>

#include "mjarm/collision/mesh_internal.hpp"
#include "mjarm/collision/random_scene_test.hpp"

namespace mjarm {
namespace {

using detail::distance_to_triangle;
using detail::InsideTest;
using testing::random_vector;

/// The least distance from `p` to many places of a triangle; never less than the true one, and more
/// by at most the spacing.
double sampled_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                        const Eigen::Vector3d& b, const Eigen::Vector3d& c, int steps) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      const Eigen::Vector3d x = a + (b - a) * i / steps + (c - a) * j / steps;
      least = std::min(least, (x - p).norm());
    }
  }
  return least;
}

TEST(Mesh, TriangleDistancesAreThoseOfDenseSamples) {
  Rng rng(61);
  for (int round = 0; round < 400; ++round) {
    const MeshShape mesh = testing::random_triangles(rng, 1, 1);
    const auto &a = mesh.vertices[0], &b = mesh.vertices[1], &c = mesh.vertices[2];
    const Eigen::Vector3d p = random_vector(rng, 2);
    const int steps = 60;
    const double spacing = ((b - a).norm() + (c - a).norm()) / steps;
    const double found = distance_to_triangle(p, a, b, c);
    const double sampled = sampled_distance(p, a, b, c, steps);
    EXPECT_LE(found, sampled + 1e-9);
    EXPECT_GE(found, sampled - spacing);
  }
}

TEST(Mesh, TriangleDistanceIsTheSameFromEveryCornerAndAfterAnyMotion) {
  Rng rng(62);
  for (int round = 0; round < 1000; ++round) {
    const MeshShape mesh = testing::random_triangles(rng, 1, 1);
    const auto &a = mesh.vertices[0], &b = mesh.vertices[1], &c = mesh.vertices[2];
    const Eigen::Vector3d p = random_vector(rng, 1.5);
    const double found = distance_to_triangle(p, a, b, c);
    EXPECT_NEAR(distance_to_triangle(p, b, c, a), found, 1e-7);
    EXPECT_NEAR(distance_to_triangle(p, c, b, a), found, 1e-7);
    const Pose X{random_vector(rng, 1), from_euler(random_vector(rng, 3))};
    EXPECT_NEAR(distance_to_triangle(X * p, X * a, X * b, X * c), found, 1e-7);
    EXPECT_LE(distance_to_triangle(a, a, b, c), 1e-12);
    EXPECT_LE(distance_to_triangle((a + b + c) / 3, a, b, c), 1e-7);
  }
}

/// A box as twelve triangles.
MeshShape box_mesh(const Eigen::Vector3d& half) {
  MeshShape out{{}, {}, true};
  for (int k = 0; k < 8; ++k) {
    out.vertices.push_back(half.cwiseProduct(
        Eigen::Vector3d(k & 1 ? 1.0 : -1.0, k & 2 ? 1.0 : -1.0, k & 4 ? 1.0 : -1.0)));
  }
  for (const std::array<int, 4>& side : {std::array{0, 2, 3, 1},
                                         {4, 5, 7, 6},
                                         {0, 1, 5, 4},
                                         {2, 6, 7, 3},
                                         {0, 4, 6, 2},
                                         {1, 3, 7, 5}}) {
    out.faces.push_back({side[0], side[1], side[2]});
    out.faces.push_back({side[0], side[2], side[3]});
  }
  return out;
}

TEST(Mesh, InsideOfABoxIsWhereTheBoxSaysSo) {
  Rng rng(63);
  for (int round = 0; round < 20; ++round) {
    const Eigen::Vector3d half(rng.uniform(0.05, 1), rng.uniform(0.05, 1), rng.uniform(0.05, 1));
    const MeshShape mesh = box_mesh(half);
    ASSERT_TRUE(is_closed(mesh));
    const InsideTest test(mesh.vertices, mesh.faces);
    const Obstacle as_mesh{"", {}, mesh}, as_box{"", {}, BoxShape{half}};
    int inside = 0;
    for (int k = 0; k < 300; ++k) {
      const Eigen::Vector3d p = 1.5 * half.cwiseProduct(random_vector(rng, 1));
      if (((p.cwiseAbs() - half).cwiseAbs().array() < 1e-6).any()) continue;
      const bool truth = (p.cwiseAbs().array() < half.array()).all();
      inside += truth ? 1 : 0;
      EXPECT_EQ(test.is_inside(p), truth);
      EXPECT_NEAR(distance(as_mesh, p), distance(as_box, p), 1e-12);
    }
    EXPECT_GT(inside, 30);
    // Straight above edges and corners a ray meets two faces, or none, where they join.
    EXPECT_TRUE(test.is_inside({0, 0, 0}));
    EXPECT_FALSE(test.is_inside(2 * half));
    EXPECT_FALSE(test.is_inside({half.x(), half.y(), 2 * half.z()}));
    EXPECT_FALSE(test.is_inside({0, 0, -2 * half.z()}));
  }
}

TEST(Mesh, InsideOfPushedBallsIsWhereTheWindingNumberSaysSo) {
  Rng rng(64);
  int inside = 0;
  for (int round = 0; round < 60; ++round) {
    const MeshShape mesh = testing::random_closed_mesh(rng, 1);
    const InsideTest test(mesh.vertices, mesh.faces);
    MeshShape surface = mesh;
    surface.solid = false;
    for (int k = 0; k < 100; ++k) {
      const Eigen::Vector3d p = random_vector(rng, 0.8);
      if (testing::mesh_distance(surface, p) < 1e-9) continue;
      const bool truth = testing::mesh_distance(mesh, p) == 0;
      EXPECT_EQ(test.is_inside(p), truth);
      inside += truth ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 100);
}

TEST(Mesh, AMeshThatLosesAFaceIsOpen) {
  MeshShape mesh = box_mesh({1, 1, 1});
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    MeshShape open = mesh;
    open.faces.erase(open.faces.begin() + static_cast<std::ptrdiff_t>(f));
    EXPECT_FALSE(is_closed(open)) << f;
  }
  // Corners of their own for every face, in the same places: still closed.
  MeshShape apart{{}, {}, true};
  for (const std::array<int, 3>& face : mesh.faces) {
    const int first = static_cast<int>(apart.vertices.size());
    for (const int corner : face) {
      apart.vertices.push_back(mesh.vertices[static_cast<std::size_t>(corner)]);
    }
    apart.faces.push_back({first, first + 1, first + 2});
  }
  EXPECT_TRUE(is_closed(apart));
}

TEST(Mesh, ColumnsOfAHeightFieldTileItAndReachTheHighestCorner) {
  Rng rng(65);
  for (int round = 0; round < 50; ++round) {
    const HeightFieldShape field = testing::random_field(rng);
    int columns = 0;
    double area = 0, highest = field.bottom;
    detail::for_each_column(field, [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
      ++columns;
      area += (high - low).head<2>().prod();
      highest = std::max(highest, high.z());
      EXPECT_EQ(low.z(), field.bottom);
      EXPECT_LE(high.cwiseAbs().x(), field.half.x() + 1e-12);
      EXPECT_LE(high.cwiseAbs().y(), field.half.y() + 1e-12);
    });
    EXPECT_EQ(columns, (field.rows - 1) * (field.cols - 1));
    EXPECT_NEAR(area, 4 * field.half.prod(), 1e-12);
    EXPECT_EQ(highest, *std::max_element(field.heights.begin(), field.heights.end()));
  }
}

}  // namespace
}  // namespace mjarm
