#pragma once

#include <string>
#include <vector>

#include "mjarm/model/robot.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::detail {

/// Tells by contacts and the gripper's force what is between the fingers, and what is touched.
class GraspWatch {
 public:
  explicit GraspWatch(const Robot& robot);

  /// @param closing  the gripper is told to close more than it is open.
  /// @param before   what was held until now.
  /// @return number of the body; -1: none.
  [[nodiscard]] int held(const Sim& sim, bool closing, int before) const;
  /// Whether the arm, or what it holds, touches anything else.
  [[nodiscard]] bool touches(const Sim& sim, int held) const;
  [[nodiscard]] std::string name(int body) const;

 private:
  std::vector<GripperDrive> drives_;
  std::vector<bool> hand_;    ///< per body
  std::vector<bool> arm_;     ///< likewise: links and hand
  std::vector<int> carried_;  ///< per body: the one with the free joint it is of, or -1
  std::vector<std::string> names_;
};

}  // namespace mjarm::detail
