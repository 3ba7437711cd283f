#pragma once

#include "mjarm/core/pose.hpp"
#include "mjarm/kinematics/block_internal.hpp"
#include "mjarm/kinematics/general_six.hpp"

namespace mjarm::detail {

/// The equations of one pose: entries as those of GeneralRows, at the factors 1, cos, sin of joint
/// 6.
struct GeneralEquations {
  double at[3][GeneralRows::kSize];
};

/// Configurations at kBlock values of joint 4.
struct GeneralBlock {
  double cosine[6][kBlock];
  double sine[6][kBlock];
  double error[kBlock];  ///< distance to the pose, lengths in units of GeneralGeometry::length
};

/// The arithmetic of GeneralSix for one width of the registers.
struct GeneralKernel {
  /// The equations of the pose where axis 1 has the flag `flag[kFlag]`, seen from the last link.
  void (*equations)(const GeneralRows& rows, const double* flag, GeneralEquations& out);
  /// Determinants `out[kBlock]` at the values `q4[kBlock]` [rad].
  /// @param change  how the equations change with the arm; read where rank is lacking.
  /// @param order   of the columns, 0 or 1.
  void (*determinants)(const GeneralGeometry& geometry, const GeneralEquations& equations,
                       const GeneralEquations& change, int order, const double* q4, double* out);
  /// The configurations whose joint 4 is near `q4[kBlock]` [rad], by Newton's steps to X_WT.
  /// @param pairs  true: lanes 2 k and 2 k + 1 have the same value, near which there are two.
  void (*configurations)(const GeneralGeometry& geometry, const GeneralEquations& equations,
                         const Pose& X_WT, const double* q4, bool pairs, GeneralBlock& out);
};
const GeneralKernel& general_kernel_baseline() noexcept;
#if defined(__x86_64__)
const GeneralKernel& general_kernel_avx2() noexcept;
const GeneralKernel& general_kernel_avx512() noexcept;
#endif

/// The widest one that this machine runs.
[[nodiscard]] const GeneralKernel& general_kernel() noexcept;

}  // namespace mjarm::detail
