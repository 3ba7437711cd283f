#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mjarm/collision/fast_check.hpp"
#include "mjarm/collision/link_balls.hpp"
#include "mjarm/core/joint_vec.hpp"
#include "mjarm/planning/joint_barrier.hpp"

namespace mjarm {

/// A place that a ball inside of a link cannot leave.
struct Pocket {
  int link = -1;         ///< that the ball is in, by index into the sphere set
  double radius = 0;     ///< [m] of the ball
  bool at_goal = false;  ///< it is round a goal, else round the start
  double volume = 0;     ///< [m^3] where the centre of the ball can be, at most
  double cell = 0;       ///< [m] width of the smallest cells that prove it
  int goals = 0;         ///< to so many different goals there is no path
};

/// Proof that no path leads from a start to any of its goals, where a joint cannot get past a value
/// (find_barrier()), or where a ball in one link is shut in. Along a path the ball moves from one
/// place to the other and touches nothing on its way. What its centre can reach is covered with
/// cells, which count as shut only where the ball would hit something wherever in the cell it is
/// (R. A. Brooks and T. Lozano-Perez, A subdivision algorithm in configuration space for findpath
/// with rotation, IJCAI 1983). Where a start or a goal has nothing but shut cells round what it is
/// connected with, that is a proof, for all margins and limits of the tilt. Where nothing is
/// proved, there may be no path all the same.
class EnclosureTest {
 public:
  /// Cheap; the work is done by find().
  /// @param checker    of the robot and `obstacles`; one that looks closer, where it is a model's.
  /// @param goals      all that a path may lead to, each of shape (dof,), as is `start`.
  /// All of these must live as long.
  EnclosureTest(const FastChecker& checker, const Obstacles& obstacles,
                std::span<const double> start, std::span<const JointVec> goals)
      : checker_(checker), obstacles_(obstacles), start_(start), goals_(goals) {}

  /// Looks for a proof when it is asked first, with bounded work.
  /// @return what shuts in the start, or else the first of the goals; none: nothing is proved.
  [[nodiscard]] const std::optional<Pocket>& find();
  /// Likewise, what a joint cannot pass.
  [[nodiscard]] const std::optional<JointBarrier>& barrier();

 private:
  const BallScene& scene();

  const FastChecker& checker_;
  const Obstacles& obstacles_;
  std::span<const double> start_;
  std::span<const JointVec> goals_;
  std::optional<BallScene> scene_;  // once it is asked for
  std::optional<std::optional<Pocket>> found_;
  std::optional<std::optional<JointBarrier>> barrier_;
};

}  // namespace mjarm
