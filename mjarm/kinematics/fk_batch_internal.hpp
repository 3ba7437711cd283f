#pragma once

#include <cstddef>

#include "mjarm/kinematics/chain.hpp"

namespace mjarm::detail {

/// The loops of fk_batch(): `n` rows of `chain.dof` numbers in, `n` rows of 12 out.
struct FkKernels {
  void (*doubles)(const Chain& chain, const double* q, std::size_t n, double* X);
  void (*floats)(const Chain& chain, const float* q, std::size_t n, float* X);
};
extern const FkKernels kFkBaseline;
#if defined(__x86_64__)
extern const FkKernels kFkAvx2;
extern const FkKernels kFkAvx512;
#endif

/// The widest ones that this machine runs.
[[nodiscard]] const FkKernels& fk_kernels() noexcept;

}  // namespace mjarm::detail
