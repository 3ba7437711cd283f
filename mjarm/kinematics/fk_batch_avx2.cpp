#include "mjarm/kinematics/fk_kernel_internal.hpp"

namespace mjarm::detail {

const FkKernels kFkAvx2 = {fk_rows<Lanes, double>, fk_rows<FloatLanes, float>};

}  // namespace mjarm::detail
