#pragma once

#include <initializer_list>
#include <span>
#include <vector>

#include "mjarm/core/joint_vec.hpp"

namespace mjarm::testing {

inline std::vector<JointVec> goal_at(std::span<const double> q) { return {joint_vec(q)}; }

inline std::vector<JointVec> goals_at(std::initializer_list<std::initializer_list<double>> rows) {
  std::vector<JointVec> out;
  for (const auto& row : rows) out.push_back(joint_vec({row.begin(), row.size()}));
  return out;
}

}  // namespace mjarm::testing
