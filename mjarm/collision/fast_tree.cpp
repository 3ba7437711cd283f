#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>

#include "mjarm/collision/fast_tree_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr int kCurveBits = 10;  // of each coordinate, and sorted at once
constexpr float kNowhere = 1e18F;

struct PlaceKey {
  std::uint32_t key;
  int index;
};

/// The 10 bits of `x`, each followed by two zeros.
std::uint32_t spread_bits(std::uint32_t x) {
  x = (x | (x << 16)) & 0x30000ffU;
  x = (x | (x << 8)) & 0x300f00fU;
  x = (x | (x << 4)) & 0x30c30c3U;
  return (x | (x << 2)) & 0x9249249U;
}

void sort_keys(std::vector<PlaceKey>& keys) {
  constexpr std::size_t kDigits = std::size_t{1} << kCurveBits;
  if (keys.size() < kDigits) {
    std::sort(keys.begin(), keys.end(), [](const PlaceKey& a, const PlaceKey& b) {
      return a.key < b.key || (a.key == b.key && a.index < b.index);
    });
    return;
  }
  std::vector<PlaceKey> sorted(keys.size());
  for (int shift = 0; shift < 3 * kCurveBits; shift += kCurveBits) {
    std::array<std::uint32_t, kDigits + 1> first{};
    const auto digit = [&](const PlaceKey& key) { return (key.key >> shift) & (kDigits - 1); };
    for (const PlaceKey& key : keys) ++first[digit(key) + 1];
    for (std::size_t d = 1; d <= kDigits; ++d) first[d] += first[d - 1];
    for (const PlaceKey& key : keys) sorted[first[digit(key)]++] = key;
    keys.swap(sorted);
  }
}

FastNode empty_node() {
  FastNode out;
  for (int k = 0; k < 3; ++k) {
    std::fill_n(out.low[k], kFan, kNowhere);
    std::fill_n(out.high[k], kFan, -kNowhere);
  }
  return out;
}

void set_child(FastNode& node, std::size_t child, const FastBounds& bounds) {
  for (int k = 0; k < 3; ++k) {
    node.low[k][child] = bounds.low[k];
    node.high[k][child] = bounds.high[k];
  }
}

FastBounds bounds_of(const FastNode& node) {
  FastBounds out;
  for (int k = 0; k < 3; ++k) {
    out.low[k] = *std::min_element(node.low[k], node.low[k] + kFan);
    out.high[k] = *std::max_element(node.high[k], node.high[k] + kFan);
  }
  return out;
}

}  // namespace

std::vector<int> curve_order(std::span<const Eigen::Vector3f> places) {
  std::vector<int> out(places.size());
  if (places.empty()) return out;
  Eigen::Vector3f low = places.front(), high = low;
  for (const Eigen::Vector3f& place : places) {
    low = low.cwiseMin(place);
    high = high.cwiseMax(place);
  }
  const float max = (1 << kCurveBits) - 1;
  const float scale = max / std::max((high - low).maxCoeff(), 1e-30F);
  std::vector<PlaceKey> keys(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    // Rounding may take the highest place a little too far.
    const Eigen::Array3f at = ((places[i] - low) * scale).array().min(max);
    const auto bits = [&](int k) { return spread_bits(static_cast<std::uint32_t>(at[k])) << k; };
    keys[i] = {bits(0) | bits(1) | bits(2), static_cast<int>(i)};
  }
  sort_keys(keys);
  for (std::size_t i = 0; i < keys.size(); ++i) out[i] = keys[i].index;
  return out;
}

void FastTreeNodes::build(std::span<const FastBounds> leaves) {
  if (leaves.empty()) return;
  std::size_t below = leaves.size();
  for (std::size_t level = 0; level == 0 || below > 1; ++level) {
    assert(level < kFastLevels);
    levels[level].assign((below + kFan - 1) / kFan, empty_node());
    for (std::size_t i = 0; i < below; ++i) {
      set_child(levels[level][i / kFan], i % kFan,
                level == 0 ? leaves[i] : bounds_of(levels[level - 1][i]));
    }
    below = levels[level].size();
  }
}

FastTree FastTreeNodes::tables() const {
  FastTree out;
  for (; out.levels < kFastLevels && !levels[out.levels].empty(); ++out.levels) {
    out.nodes[out.levels] = levels[out.levels].data();
  }
  return out;
}

}  // namespace mjarm::detail
