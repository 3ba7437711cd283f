#pragma once

#include <mujoco/mujoco.h>

#include <vector>

#include "mjarm/collision/exact_linkage_internal.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm::detail {

/// How the joints of a gripper stand, from open to closed.
class GripperWay {
 public:
  /// @param arm  of the model; without a gripper nothing moves.
  GripperWay(const mjModel& m, const Arm& arm);

  /// Every driven joint has an end at which the gripper is closed, or there are closed loops.
  [[nodiscard]] bool has_ends() const { return has_ends_ || linkage_.has_loops(); }
  /// A joint of the gripper moves this body against its parent.
  [[nodiscard]] bool moves(int body) const;
  /// Writes the joints at `share` of their way from where they stand in `from` (nq,) to closed.
  void set(const std::vector<double>& from, double share, std::vector<double>& qpos) const;
  /// Writes the joints at the end at which the gripper is open.
  void set_open(std::vector<double>& qpos);
  /// To be called before `set`: where the fingers go from `from` (nq,).
  void find_way(const std::vector<double>& from);

 private:
  struct Driven {
    int joint = 0;
    double open = 0, closed = 0;  ///< [rad or m]
  };
  /// A joint that an equality constraint couples to another one.
  struct Coupled {
    int joint = 0, to = 0;
    const mjtNum* polynomial = nullptr;
  };
  void find_coupled();
  void add_driven(int joint, const GripperDrive& drive);
  [[nodiscard]] double grip_in(const std::vector<double>& qpos) const;
  void set_coupled(std::vector<double>& qpos) const;

  const mjModel& m_;
  Linkage linkage_;
  std::vector<Driven> driven_;
  std::vector<Coupled> coupled_;  ///< after what they are coupled to
  bool has_ends_ = true;
};

}  // namespace mjarm::detail
