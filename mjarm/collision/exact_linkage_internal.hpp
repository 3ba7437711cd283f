#pragma once

#include <mujoco/mujoco.h>

#include <vector>

#include "mjarm/model/arm.hpp"

namespace mjarm::detail {

/// A gripper whose joints form closed loops, such as four-bar linkages: where it goes from the
/// values of its driven joints alone cannot be told, so MuJoCo moves it, in a simulation without
/// contacts and gravity, while all else stands.
class Linkage {
 public:
  /// @param m  must outlive this.
  Linkage(const mjModel& m, const Arm& arm);

  /// A connect or weld constraint holds parts of the hand together.
  [[nodiscard]] bool has_loops() const { return has_loops_; }
  /// A joint of the hand moves this body against its parent.
  [[nodiscard]] bool moves(int body) const;
  /// Finds the way of the hand from where it stands in `from` (nq,) to where a command brings it.
  /// @param grip_from  how far closed it is in `from`, about, 0 open to 1 closed.
  void find_way(const std::vector<double>& from, double grip_from, double grip);
  /// Writes the joints of the hand at `share` (0 to 1) of the way that was found.
  void set(double share, std::vector<double>& qpos) const;

 private:
  void note(const mjData& d);
  void hold(mjData& d, const std::vector<double>& from) const;

  const mjModel& m_;
  Gripper gripper_;
  bool has_loops_ = false;
  std::vector<int> joints_;               ///< hinges and slides of the hand
  std::vector<std::vector<double>> way_;  ///< values of `joints_`, from the first to the last
  std::vector<double> length_;            ///< [rad or m] of the way up to each
};

}  // namespace mjarm::detail
