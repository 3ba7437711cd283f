#pragma once

#include <map>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/rl/tensor_set.hpp"

namespace mjarm::rl {

/// The state_dict of an actor-critic policy of stable-baselines3 in the names of `Policy`:
/// "mlp_extractor.shared_net.N" (1.x), "mlp_extractor.policy_net.N" and "action_net" become the
/// layers "actor.0", "actor.1", ..., the same with "value_net" "critic.0", ...
/// @param state  float32 tensors of one or two dimensions.
/// @return bad_input that names the tensor that is missing, unknown, not finite or of a shape that
///         fits no chain of layers.
[[nodiscard]] Result<TensorSet> policy_of_sb3(const std::map<std::string, Tensor>& state,
                                              const std::string& source);

}  // namespace mjarm::rl
