#include "mjarm/rl/normaliser.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace mjarm::rl {
namespace {

using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

void sum_over(Ranks* ranks, std::span<double> values) {
  if (ranks != nullptr) ranks->sum(values);
}

}  // namespace

void Normaliser::apply(std::span<const float> rows, std::span<float> out) const {
  assert(out.size() == rows.size());
  if (count <= 0) {
    std::copy(rows.begin(), rows.end(), out.begin());
    return;
  }
  const auto size = static_cast<std::size_t>(mean.size());
  const Eigen::VectorXd scale = (variance.array() + 1e-8).sqrt().inverse();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i % size);
    const double value = (static_cast<double>(rows[i]) - mean[k]) * scale[k];
    out[i] = static_cast<float>(std::clamp(value, -clip, clip));
  }
}

void Normaliser::absorb(std::span<const float> rows, Ranks* ranks) {
  const Eigen::Index size = mean.size();
  const auto n = static_cast<Eigen::Index>(rows.size()) / size;
  const Eigen::Map<const Rows> x(rows.data(), n, size);
  // Two passes, so that nothing is lost where the mean is large: first the mean, then the squares.
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(size + 1);
  for (Eigen::Index i = 0; i < n; ++i) sums.head(size) += x.row(i).transpose().cast<double>();
  sums[size] = static_cast<double>(n);
  sum_over(ranks, {sums.data(), static_cast<std::size_t>(sums.size())});
  const double added = sums[size];
  if (added <= 0) return;
  const Eigen::VectorXd new_mean = sums.head(size) / added;
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(size);
  for (Eigen::Index i = 0; i < n; ++i) {
    squares += (x.row(i).transpose().cast<double>() - new_mean).cwiseAbs2();
  }
  sum_over(ranks, {squares.data(), static_cast<std::size_t>(size)});
  const double total = count + added;
  const Eigen::VectorXd delta = new_mean - mean;
  variance = (variance * count + squares + delta.cwiseAbs2() * (count * added / total)) / total;
  mean += delta * (added / total);
  count = total;
}

}  // namespace mjarm::rl
