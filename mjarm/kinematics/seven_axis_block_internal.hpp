#pragma once

#include "mjarm/kinematics/block_internal.hpp"
#include "mjarm/kinematics/seven_axis.hpp"

namespace mjarm::detail {

/// Cosine beyond a limit that still counts as within.
inline constexpr double kSevenWithin = 1e-10;

/// A pose as the closed form of seven axes reads it.
struct SevenGoal {
  double p_6S[3];                   ///< [m] S seen from frame 6
  double R_0u6[9];                  ///< frame 6 seen from the unmoved frame 0
  double near_cos[7], near_sin[7];  ///< of the seed
  bool beyond_limits = false;  ///< true: elbows beyond the limits of joint 4 are followed up, too
};

/// The eight branches at kBlock values of the last joint. A branch is 4 e + 2 w + s: which elbow,
/// wrist and shoulder. Cosines and sines stand in for angles.
struct SevenBlock {
  /// How far beyond the limits, in cosine: <= 0 within, continuous; where a triangle does not
  /// close, that counts besides and the nearest configuration stands in.
  double beyond[8][kBlock];
  double open[8][kBlock];         ///< > 0 where the branch does not exist
  double away[8][kBlock];         ///< 1 - cos of the largest joint distance to the seed
  double shoulder[8][6][kBlock];  ///< cos and sin of joints 1, 2, 3
  double elbow[2][2][kBlock];     ///< of joint 4
  double wrist[4][4][kBlock];     ///< of joints 5 and 6, of branch 2 e + w
};

/// Fills `out` for the values `q7[kBlock]` [rad] of the last joint.
using SevenKernel = void (*)(const SevenGeometry& geometry, const SevenGoal& goal, const double* q7,
                             SevenBlock& out);
void seven_block_baseline(const SevenGeometry&, const SevenGoal&, const double*, SevenBlock&);
#if defined(__x86_64__)
void seven_block_avx2(const SevenGeometry&, const SevenGoal&, const double*, SevenBlock&);
void seven_block_avx512(const SevenGeometry&, const SevenGoal&, const double*, SevenBlock&);
#endif

/// The widest one that this machine runs.
[[nodiscard]] SevenKernel seven_kernel() noexcept;

}  // namespace mjarm::detail
