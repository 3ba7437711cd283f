#include "mjarm/kinematics/general_six_kernel_internal.hpp"

namespace mjarm::detail {

const GeneralKernel& general_kernel_avx2() noexcept { return kGeneralKernel; }

}  // namespace mjarm::detail
