#pragma once

#include <span>

#include "mjarm/collision/edge_check.hpp"

namespace mjarm {

/// certify_edge() without what is nearest, which costs about as much as the proof: for edges of
/// which that will be measured later.
[[nodiscard]] Result<EdgeCertificate, EdgeResult> prove_edge(const FastChecker& checker,
                                                             std::span<const double> q0,
                                                             std::span<const double> q1,
                                                             const EdgeOptions& options = {});

}  // namespace mjarm
