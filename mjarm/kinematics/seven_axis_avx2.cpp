#include "mjarm/kinematics/seven_axis_kernel_internal.hpp"

namespace mjarm::detail {

void seven_block_avx2(const SevenGeometry& geometry, const SevenGoal& goal, const double* q7,
                      SevenBlock& out) {
  seven_block(geometry, goal, q7, out);
}

}  // namespace mjarm::detail
