#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "mjarm/rl/first_weights_internal.hpp"

namespace mjarm::rl::detail {
namespace {

/// A matrix whose rows (or columns, whatever are fewer) are orthonormal, all such alike probable.
Eigen::MatrixXd random_orthogonal(Eigen::Index rows, Eigen::Index cols, Rng& rng) {
  Eigen::MatrixXd drawn(std::max(rows, cols), std::min(rows, cols));
  for (double& value : drawn.reshaped()) value = rng.normal();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(drawn);
  Eigen::MatrixXd Q = qr.householderQ() * Eigen::MatrixXd::Identity(drawn.rows(), drawn.cols());
  // Without the signs of R the distribution would depend on how the factors are computed.
  for (Eigen::Index i = 0; i < Q.cols(); ++i) {
    if (qr.matrixQR()(i, i) < 0) Q.col(i) = -Q.col(i);
  }
  if (rows < cols) Q.transposeInPlace();
  return Q;
}

double gain_of(const std::string& name, const PolicyShape& shape) {
  if (name == "actor." + std::to_string(shape.actor.size()) + ".weight") return 0.01;
  if (name == "critic." + std::to_string(shape.critic.size()) + ".weight") return 1;
  return std::sqrt(2.0);
}

}  // namespace

void draw_first_weights(Policy& policy, double log_std, Rng& rng) {
  for (const ParameterBlock& block : policy.blocks()) {
    float* to = policy.parameters().data() + block.offset;
    if (block.name == "log_std") {
      std::fill_n(to, block.rows, static_cast<float>(log_std));
    } else if (!block.name.ends_with(".weight")) {
      std::fill_n(to, block.rows, 0.0F);
    } else {
      const double gain = gain_of(block.name, policy.shape());
      const Eigen::MatrixXd W = gain * random_orthogonal(block.rows, block.cols, rng);
      for (int row = 0; row < block.rows; ++row) {
        for (int col = 0; col < block.cols; ++col) *to++ = static_cast<float>(W(row, col));
      }
    }
  }
}

}  // namespace mjarm::rl::detail
