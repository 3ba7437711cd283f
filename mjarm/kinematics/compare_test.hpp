#pragma once

#include <array>
#include <cstring>
#include <nlohmann/json.hpp>

#include "mjarm/core/joint_state.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm::testing {

/// A pose of the cases of other programs: `{"pos": [3], "quat": [w, x, y, z]}`.
inline Pose pose_of(const nlohmann::json& entry) {
  const auto p = entry.at("pos").get<std::array<double, 3>>();
  const auto q = entry.at("quat").get<std::array<double, 4>>();
  return {Eigen::Vector3d(p[0], p[1], p[2]), to_matrix(Quat(q[0], q[1], q[2], q[3]))};
}

/// Whether two vectors are the same to the last bit.
inline bool same_bits(const JointVec& a, const JointVec& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

}  // namespace mjarm::testing
