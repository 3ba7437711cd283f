#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mjarm/collision/fast_check.hpp"
#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/planning/task_region.hpp"
#include "mjarm/planning/tilt_limit.hpp"

namespace mjarm {

/// Which configurations stand for regions. Every default is usable as is.
struct RegionGoalOptions {
  int poses = 16;          ///< drawn in each region at first, besides its middle, >= 0
  int max = 64;            ///< configurations at most at first, those nearest to `q_near`, > 0
  std::uint64_t seed = 1;  ///< same input and seed, same configurations
  /// Configurations that break one of these are left out, where there are others.
  std::optional<TiltLimit> tilt = {};
  std::optional<TaskRegion> within = {};
  StopCheck stop = {};  ///< ends the drawing of poses: what was found so far counts
};

/// Goals for plan_path() that stand for regions of the tool, or starts: all branches of inverse
/// kinematics, in every winding, of the middles of the regions and of poses drawn from them. Those
/// free of collisions; where none is, those in collision, so that the planner can say what is hit.
/// More are drawn as they are asked for, always the same.
class RegionGoals {
 public:
  /// Draws for the first time, and again as long as nothing can be reached.
  /// @param checker  must outlive this.
  /// @param ik       of the arm of `checker`; with `task` position or axis any orientation, or
  /// turn, will do.
  /// @param regions  at least one.
  /// @param q_near   shape (dof,) [rad or m].
  /// @return why the first region's middle has no answer, where no drawn pose of any region has one
  /// either (bad_input: also a region or an option out of range).
  [[nodiscard]] static Result<RegionGoals, IkFailure> create(const FastChecker& checker,
                                                             const IkSolver& ik,
                                                             std::span<const TaskRegion> regions,
                                                             std::span<const double> q_near,
                                                             const RegionGoalOptions& options = {});

  /// Draws as many poses again as were drawn so far, and keeps twice as many configurations.
  /// @return false where no more are drawn: regions are single poses, or enough is enough.
  bool draw_more();
  /// Whether more would be drawn.
  [[nodiscard]] bool may_draw() const;

  /// Nearest to `q_near` first; at least one.
  [[nodiscard]] const std::vector<JointVec>& q() const noexcept { return q_; }
  /// Another configuration that stands for the same region, nearer to `to`, and as good: `q` moved
  /// there in steps, of which each ends at the pose of the region that is nearest; `q` itself where
  /// there is none.
  [[nodiscard]] JointVec pulled(const JointVec& q, int region, const JointVec& to) const;

  /// Index of the region that a configuration stands for.
  [[nodiscard]] int region_of(int goal) const { return region_of_[static_cast<std::size_t>(goal)]; }

 private:
  struct Found {
    JointVec q;
    int region;
    double far;  // [rad or m, L2] from q_near
  };
  enum Worth { good, off, hit };

  RegionGoals(const FastChecker& checker, const IkSolver& ik, std::span<const TaskRegion> regions,
              std::span<const double> q_near, const RegionGoalOptions& options);
  [[nodiscard]] std::optional<IkFailure> add(int region, const Pose& X_WT);
  [[nodiscard]] Worth worth(const JointVec& q) const;
  void draw_each(int poses);
  void choose();

  const FastChecker* checker_;
  IkSolver ik_;
  std::vector<TaskRegion> regions_;
  JointVec near_;
  RegionGoalOptions options_;
  std::vector<Rng> rngs_;  // of each region
  int drawn_ = 0;          // poses of each region
  std::vector<Found> found_[3];
  std::vector<JointVec> q_;
  std::vector<int> region_of_;
};

}  // namespace mjarm
