#pragma once

#include <filesystem>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/rl/tensor_set.hpp"

namespace mjarm::rl {

/// The actor of a policy as an ONNX model (opset 17, IR version 8) for other programs: input
/// "observation", float32 (batch, observations), not normalised; output "action", float32 (batch,
/// actions), the mean action, not clamped. It holds the normaliser too, in float32.
/// @param set  tensors and the metadata "activation", as `Policy::tensors` gives them; without
///             tensors "normaliser.*" observations are taken as they are.
/// @return bad_input that names the tensor that is missing or has a wrong shape. Equal sets give
///         equal bytes.
[[nodiscard]] Result<std::string> to_onnx(const TensorSet& set);

/// Writes `to_onnx(set)` in one step.
[[nodiscard]] Result<void> save_onnx(const std::filesystem::path& path, const TensorSet& set);

}  // namespace mjarm::rl
