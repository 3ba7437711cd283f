#include "mjarm/rl/net_loops_internal.hpp"

namespace mjarm::rl::detail {

const NetKernels kNetAvx2 = kLoops;

}  // namespace mjarm::rl::detail
