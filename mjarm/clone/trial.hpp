#pragma once

#include <cstdint>

#include "mjarm/clone/observation.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/episode/draw_scene.hpp"
#include "mjarm/episode/record.hpp"
#include "mjarm/model/jaws.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/rl/mixture_policy.hpp"

namespace mjarm::clone {

/// Lets a policy do in simulation what was demonstrated: as often a second as the rows were, the
/// tool is led to what it answers, until it stands still for a second, for 20 s at the most.
/// @param jaws      find_jaws() of the robot.
/// @param scene     with a task of `options`.
/// @return how it went, judged as episode::judge() does, but for the turn about the vertical, which
///         nobody asked the policy for; an error where the simulation broke down or it was stopped.
[[nodiscard]] Result<episode::Verdict> try_policy(const Robot& robot, const Jaws& jaws,
                                                  const rl::MixturePolicy& policy,
                                                  const episode::EpisodeOptions& options,
                                                  const episode::DrawnScene& scene,
                                                  const StopCheck& stop = {});

}  // namespace mjarm::clone
