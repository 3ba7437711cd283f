#include <algorithm>
#include <array>
#include <limits>

#include "mjarm/collision/near_boxes_internal.hpp"
#include "mjarm/core/simd/lanes.hpp"

namespace mjarm::detail {
namespace {

constexpr std::size_t kBoxLanes = simd::kFloats;  // boxes of a row
constexpr std::size_t kBoxRow = 6 * kBoxLanes;    // numbers of it
static_assert(NearBoxes::kWord % kBoxLanes == 0);

}  // namespace

void NearBoxes::add(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  const std::size_t lane = size_++ % kBoxLanes;
  // Lanes without a box are far from everything.
  if (lane == 0) rows_.resize(rows_.size() + kBoxRow, std::numeric_limits<float>::infinity());
  float* const row = rows_.data() + rows_.size() - kBoxRow;
  for (std::size_t k = 0; k < 3; ++k) {
    row[2 * k * kBoxLanes + lane] = static_cast<float>(low[static_cast<Eigen::Index>(k)]);
    row[(2 * k + 1) * kBoxLanes + lane] = static_cast<float>(high[static_cast<Eigen::Index>(k)]);
  }
}

std::uint64_t NearBoxes::near(std::size_t word, const Eigen::Vector3d& p,
                              double within) const noexcept {
  // Far more than what rounding hides of numbers of this size.
  const double spare = 1e-5 * (1 + p.cwiseAbs().maxCoeff() + within);
  const float reach = static_cast<float>(within + spare);
  const simd::Floats max = simd::splat(reach * reach), none{};
  std::array<simd::Floats, 3> at;
  for (std::size_t k = 0; k < 3; ++k) {
    at[k] = simd::splat(static_cast<float>(p[static_cast<Eigen::Index>(k)]));
  }
  std::uint64_t out = 0;
  const std::size_t first = word * kWord / kBoxLanes * kBoxRow;
  const std::size_t end = std::min(first + kWord / kBoxLanes * kBoxRow, rows_.size());
  int shift = 0;
  for (std::size_t row = first; row < end; row += kBoxRow, shift += kBoxLanes) {
    simd::Floats apart2{};
    for (std::size_t k = 0; k < 3; ++k) {
      const float* const low = rows_.data() + row + 2 * k * kBoxLanes;
      const simd::Floats below = simd::load(low) - at[k],
                         above = at[k] - simd::load(low + kBoxLanes);
      const simd::Floats apart = simd::larger(simd::larger(below, above), none);
      apart2 += apart * apart;
    }
    out |= static_cast<std::uint64_t>(simd::less(apart2, max)) << shift;
  }
  return out;
}

}  // namespace mjarm::detail
