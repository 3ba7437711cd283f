#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "mjarm/core/result.hpp"
#include "mjarm/rl/tensor_set.hpp"

namespace mjarm::rl {

/// The actor and the critic of a policy that stable-baselines3 (1.x or 2.x) saved, as the tensors
/// of a `Policy`: "MlpPolicy" of PPO or A2C with tanh or ReLU, hidden layers of any number, shared
/// ones too (both nets then get them). Nothing in the file is run: its pickled weights are read by
/// a reader that knows 26 harmless instructions, its JSON as text, and every other pickle in it is
/// passed over.
///
/// Besides there are, where the file tells finite ones, "action.low" and "action.high" (actions,),
/// to which stable-baselines3 clips the actions; and the metadata "source" names its version. The
/// normaliser does nothing: running means (VecNormalize) are not part of such a file.
/// @param bytes   of the `.zip` file.
/// @param source  name of the file, for messages.
/// @return bad_input with one line that names the file and what in it is damaged, refused or not
///         supported (state-dependent exploration, observations that are no Box, other layers).
[[nodiscard]] Result<TensorSet> parse_sb3_zip(std::string_view bytes, const std::string& source);

/// Like `parse_sb3_zip`, of a file of at most 256 MiB.
[[nodiscard]] Result<TensorSet> load_sb3_zip(const std::filesystem::path& path);

}  // namespace mjarm::rl
