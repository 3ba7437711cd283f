#include "mjarm/collision/fast_clearance_internal.hpp"
#include "mjarm/collision/fast_kernel_internal.hpp"

namespace mjarm::detail {

const FastKernels kFastAvx512 = {kFloats, collide_block, cover_block, bound_motion,
                                 clearances_of_block};

}  // namespace mjarm::detail
