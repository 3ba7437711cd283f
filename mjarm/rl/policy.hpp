#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/rl/tensor_set.hpp"

namespace mjarm::rl {

/// What stands between two layers.
enum class Activation { tanh, relu };

/// Sizes of an actor and a critic that share nothing.
struct PolicyShape {
  int observations = 0;                   ///< > 0
  int actions = 0;                        ///< > 0
  std::vector<int> actor = {256, 256};   ///< hidden layers
  std::vector<int> critic = {256, 256};  ///< hidden layers
  Activation activation = Activation::tanh;

  [[nodiscard]] bool operator==(const PolicyShape&) const = default;
};

/// Where one matrix or vector lies in the flat parameters: (rows, cols), row-major; a bias has one
/// column. Layers are y = W x + b with W of (outputs, inputs), as torch stores them.
struct ParameterBlock {
  std::string name;  ///< "actor.0.weight", "actor.0.bias", ..., "critic.2.bias", "log_std"
  int rows = 0;
  int cols = 0;
  std::size_t offset = 0;
};

/// Shifts and scales observations to about N(0, 1), by what was seen so far. With `count` 0 it does
/// nothing, not even clip.
struct Normaliser {
  Eigen::VectorXd mean;
  Eigen::VectorXd variance;
  double count = 0;
  double clip = 10;  ///< > 0, of the normalised values

  [[nodiscard]] bool operator==(const Normaliser&) const = default;
};

/// A Gaussian policy and its value function as plain numbers: float32 parameters of two multilayer
/// perceptrons and the logarithms of the standard deviations, and the normaliser before both.
class Policy {
 public:
  /// All parameters 0.
  explicit Policy(PolicyShape shape);

  [[nodiscard]] const PolicyShape& shape() const noexcept { return shape_; }
  [[nodiscard]] const std::vector<ParameterBlock>& blocks() const noexcept { return blocks_; }
  [[nodiscard]] std::span<float> parameters() noexcept { return parameters_; }
  [[nodiscard]] std::span<const float> parameters() const noexcept { return parameters_; }

  /// The mean action, not clamped.
  /// @param observation (observations,), not normalised.  @return (actions,)
  [[nodiscard]] Eigen::VectorXf act(std::span<const float> observation) const;
  /// The estimate of the return from here on.
  [[nodiscard]] float value(std::span<const float> observation) const;

  /// As tensors named like the blocks, with "normaliser.mean", ".variance", ".count", ".clip"; the
  /// metadata names the activation.
  [[nodiscard]] TensorSet tensors() const;
  /// The opposite: sizes follow from the tensors; others than a policy's are left out.
  /// @return an error that names the tensor that is missing, or has a wrong shape, or a value that
  ///         is not finite.
  [[nodiscard]] static Result<Policy> from(const TensorSet& set);

  Normaliser normaliser;

 private:
  PolicyShape shape_;
  std::vector<ParameterBlock> blocks_;
  std::vector<float> parameters_;
};

}  // namespace mjarm::rl
