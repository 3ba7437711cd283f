#include "mjarm/kinematics/descent_kernel_internal.hpp"

namespace mjarm::detail {

void descent_step_avx2(const Chain& chain, const Pose& X_WT, const DescentOptions& options,
                       DescentBlock& block) {
  descent_step(chain, X_WT, options, block);
}

}  // namespace mjarm::detail
