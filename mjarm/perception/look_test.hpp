#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "mjarm/core/rotation.hpp"
#include "mjarm/perception/look_table.hpp"
#include "mjarm/perception/tag_detector.hpp"
#include "mjarm/render/png.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::perception::testing {

using namespace look_table;

/// The table, where there is OpenGL.
class Look {
 public:
  [[nodiscard]] bool works() const { return table_.has_value(); }
  [[nodiscard]] const Model& model() const { return table_->model(); }
  render::RgbdFrame operator()(const Places& places, Rng& noise) {
    return *table_->look(places, noise);
  }

 private:
  Result<Table> table_ = Table::open();
};

/// [rad] between two orientations of one of the bodies, up to its symmetry where it has no tag: the
/// box looks the same after half a turn about each axis, the can from either end and turned at
/// will.
inline double turn_between(std::size_t body, bool with_tag, const Eigen::Matrix3d& A,
                           const Eigen::Matrix3d& B) {
  if (body == kCan) return std::acos(std::min(1.0, std::abs(A.col(2).dot(B.col(2)))));
  double least = angle_between(A, B);
  for (int axis = 0; body == kBox && !with_tag && axis < 3; ++axis) {
    const Eigen::AngleAxisd half(std::numbers::pi, Eigen::Vector3d::Unit(axis));
    least = std::min(least, angle_between(A * half.toRotationMatrix(), B));
  }
  return least;
}

/// Box, can and step as objects, the box with its tag where that is asked for.
inline std::vector<KnownObject> objects_of(const Model& model, bool with_tag) {
  return *objects(model, with_tag);
}

}  // namespace mjarm::perception::testing
