#pragma once

#include <optional>

#include "mjarm/core/rng.hpp"
#include "mjarm/kinematics/descent_block_internal.hpp"
#include "mjarm/kinematics/ik_search_internal.hpp"

namespace mjarm::detail {

/// A descent of LaneSearch that has ended.
struct LaneDescentEnd {
  Descent descent;  ///< pos_err and rot_err are set only where it converged
  int start = 0;    ///< 0: the seed; else the how many-th random start
};

/// Descents from a seed and from random starts, kBlock of them at a time; a lane whose descent has
/// ended goes on with the next start. Coarse steps run in lanes; what comes near is finished by
/// descend(). Which ends come out, and in which order, depends on the inputs alone. Never
/// allocates.
class LaneSearch {
 public:
  /// Makes a random start.
  using Draw = JointVec (*)(const Chain& chain, const JointVec& seed, Rng& rng) noexcept;

  /// `starts`: the seed and so many random ones less one.
  LaneSearch(const Chain& chain, const Pose& X_WT, const DescentOptions& options,
             const JointVec& seed, int starts, Rng& rng, Draw draw = random_start) noexcept;

  /// The next descent that ends; none when all have. Where several end with one step, the seed
  /// comes first; a seed that is about to converge is waited for.
  std::optional<LaneDescentEnd> next() noexcept;

  /// Steps taken so far, of all lanes.
  [[nodiscard]] int steps() const noexcept { return steps_; }

 private:
  struct Lane {
    bool active = false;
    bool ended = false;  ///< near the goal, or given up: to be handed out
    bool near = false;
    int start = 0;
    int steps = 0;
    int since_mark = 0;
    double mark = 0;
    double error = 0;
    double best_error = 0;
    JointVec best;
  };
  void fill(int lane) noexcept;
  void step() noexcept;
  void judge(int lane) noexcept;
  [[nodiscard]] int pick() noexcept;
  [[nodiscard]] LaneDescentEnd take(int lane) noexcept;

  const Chain& chain_;
  const Pose& goal_;
  const DescentOptions& options_;
  const JointVec& seed_;
  const int starts_;
  Rng& rng_;
  const Draw draw_;
  const DescentKernel kernel_;
  DescentBlock block_;
  Lane lanes_[kBlock];
  int started_ = 0;
  int steps_ = 0;
  int patience_ = 0;  ///< steps that the seed is waited for yet
};

}  // namespace mjarm::detail
