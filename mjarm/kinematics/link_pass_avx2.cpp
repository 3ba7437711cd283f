#include "mjarm/kinematics/link_pass_internal.hpp"

namespace mjarm::detail {

FkPasses fk_passes_avx2() noexcept { return fk_passes_here(); }

}  // namespace mjarm::detail
