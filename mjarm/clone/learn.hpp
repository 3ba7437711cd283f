#pragma once

#include <functional>

#include "mjarm/clone/cloned_policy.hpp"
#include "mjarm/clone/demonstrated.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/rl/cloner.hpp"

namespace mjarm::clone {

/// Learns from demonstrations: rows blurred anew in each pass.
/// @param after_epoch  called with the number of the pass, from 1, and Cloner::epoch(); may be
///                     empty.
/// @return an error where it was stopped, and impossible where the learning diverged.
[[nodiscard]] Result<ClonedPolicy> learn(
    const Demonstrated& data, const rl::CloningOptions& options, const StopCheck& stop = {},
    const std::function<void(int epoch, double loss)>& after_epoch = {});

}  // namespace mjarm::clone
