#pragma once

#include <cstdint>

#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/episode/record.hpp"
#include "mjarm/episode/task_world.hpp"
#include "mjarm/rl/mixture_policy.hpp"

namespace mjarm::clone {

/// Lets a policy do what was demonstrated, from the beginning of episode `number`, until it stands
/// still for a second, for 20 s at the most.
/// @param policy  of the size of observations and answers.
/// @return as TaskWorld::verdict() has it, but "off_goal" also where the object is not at the very
///         place the policy was told; an error where the simulation broke down or it was stopped.
[[nodiscard]] Result<episode::Verdict> try_policy(episode::TaskWorld& world, std::uint64_t number,
                                                  const rl::MixturePolicy& policy,
                                                  const StopCheck& stop = {});

}  // namespace mjarm::clone
