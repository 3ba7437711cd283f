#include "mjarm/kinematics/fk_kernel_internal.hpp"

namespace mjarm::detail {

const FkKernels kFkAvx512 = {fk_rows<Doubles, double>, fk_rows<Floats, float>};

}  // namespace mjarm::detail
