#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/planning/near_nodes_internal.hpp"

namespace mjarm::detail {
namespace {

typedef float Four __attribute__((vector_size(16)));
typedef std::int32_t FourInts __attribute__((vector_size(16)));

constexpr std::size_t kFull = 256;  // nodes of a box that is cut in two
constexpr float kNowhere = 1e9F;    // [rad or m] where lanes without a node are: out of reach
constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr float kRounded = 1e-5F;  // [of a distance, of a place] more than rounding can do

using Place = std::array<float, kMaxDof>;

Place in_floats(std::span<const double> q) {
  Place out;
  for (std::size_t k = 0; k < q.size(); ++k) out[k] = static_cast<float>(q[k]);
  return out;
}

Four load(const float* from) {
  Four out;
  std::memcpy(&out, from, sizeof out);
  return out;
}

}  // namespace

/// A place that is looked at, and each coordinate in all lanes.
struct NearNodes::Wanted {
  Place q;
  std::array<Four, kMaxDof> lanes;

  explicit Wanted(std::span<const double> place) : q(in_floats(place)) {
    for (std::size_t k = 0; k < place.size(); ++k) lanes[k] = Four{} + q[k];
  }
};

/// Squared distances of kLanes nodes from a place.
std::array<Four, 2> NearNodes::squared_distances(const float* places, const Wanted& wanted) const {
  std::array<Four, 2> out{};
  for (std::size_t k = 0; k < dof_; ++k, places += kLanes) {
    const Four d0 = load(places) - wanted.lanes[k], d1 = load(places + 4) - wanted.lanes[k];
    out[0] += d0 * d0;
    out[1] += d1 * d1;
  }
  return out;
}

NearNodes::NearNodes(std::size_t dof) : dof_(dof), cells_(1), boxes_(2 * dof), leaves_(1) {
  cells_.front().leaf = 0;
  std::fill_n(boxes_.begin(), dof, kInfinite);
  std::fill_n(boxes_.begin() + static_cast<std::ptrdiff_t>(dof), dof, -kInfinite);
  leaves_.front().places.reserve(64 * dof);
  leaves_.front().nodes.reserve(64);
}

void NearNodes::add(std::span<const double> q) {
  const Place place = in_floats(q);
  int cell = 0;
  grow(cell, place.data());
  while (cells_[static_cast<std::size_t>(cell)].leaf < 0) {
    const Cell& now = cells_[static_cast<std::size_t>(cell)];
    cell = now.halves[place[now.axis] < now.at ? 0 : 1];
    grow(cell, place.data());
  }
  const int last = cells_[static_cast<std::size_t>(cell)].leaf;
  Leaf& leaf = leaves_[static_cast<std::size_t>(last)];
  put(leaf, place.data(), count_++);
  // One that cannot be cut is tried again when it has grown by as much.
  if (leaf.nodes.size() % kFull == 0) cut(cell);
}

/// Writes a node into the next lane of a leaf.
void NearNodes::put(Leaf& leaf, const float* q, int node) {
  const std::size_t slot = leaf.nodes.size(), lane = slot % kLanes, first = slot - lane;
  if (lane == 0) leaf.places.resize(leaf.places.size() + kLanes * dof_, kNowhere);
  for (std::size_t k = 0; k < dof_; ++k) leaf.places[first * dof_ + k * kLanes + lane] = q[k];
  leaf.nodes.push_back(node);
}

/// Makes the box of a cell hold a place.
void NearNodes::grow(int cell, const float* q) {
  float* low = boxes_.data() + static_cast<std::size_t>(cell) * 2 * dof_;
  float* high = low + dof_;
  for (std::size_t k = 0; k < dof_; ++k) {
    low[k] = std::min(low[k], q[k]);
    high[k] = std::max(high[k], q[k]);
  }
}

/// Cuts a leaf across its widest side, so that the halves hold as many nodes; not where all nodes
/// are in one place.
void NearNodes::cut(int cell) {
  const auto index = static_cast<std::size_t>(cell);
  const float* low = boxes_.data() + index * 2 * dof_;
  std::size_t axis = 0;
  for (std::size_t k = 1; k < dof_; ++k) {
    if (low[dof_ + k] - low[k] > low[dof_ + axis] - low[axis]) axis = k;
  }
  const int first = cells_[index].leaf;
  const Leaf whole = std::move(leaves_[static_cast<std::size_t>(first)]);
  const auto coordinate = [&](std::size_t slot, std::size_t k) {
    return whole.places[slot / kLanes * kLanes * dof_ + k * kLanes + slot % kLanes];
  };
  std::vector<float> along(whole.nodes.size());
  for (std::size_t slot = 0; slot < along.size(); ++slot) along[slot] = coordinate(slot, axis);
  const auto middle = along.begin() + static_cast<std::ptrdiff_t>(along.size() / 2);
  std::nth_element(along.begin(), middle, along.end());
  float at = *middle;
  if (at == low[axis]) {  // the next larger one, so that neither half is empty
    at = kInfinite;
    for (const float x : along) at = x > low[axis] ? std::min(at, x) : at;
  }
  if (at == kInfinite) {
    leaves_[static_cast<std::size_t>(first)] = whole;
    return;
  }
  const int second = static_cast<int>(leaves_.size());
  leaves_[static_cast<std::size_t>(first)] = {};
  leaves_.emplace_back();
  const int half = static_cast<int>(cells_.size());
  cells_[index].leaf = -1;
  cells_[index].axis = axis;
  cells_[index].at = at;
  for (const int h : {0, 1}) {
    cells_[index].halves[h] = half + h;
    cells_.push_back({.leaf = h == 0 ? first : second});
    boxes_.insert(boxes_.end(), dof_, kInfinite);
    boxes_.insert(boxes_.end(), dof_, -kInfinite);
  }
  for (std::size_t slot = 0; slot < whole.nodes.size(); ++slot) {
    Place q;
    for (std::size_t k = 0; k < dof_; ++k) q[k] = coordinate(slot, k);
    const int h = q[axis] < at ? 0 : 1;
    const int leaf = h == 0 ? first : second;
    grow(half + h, q.data());
    put(leaves_[static_cast<std::size_t>(leaf)], q.data(), whole.nodes[slot]);
  }
}

/// Squared distance from what a cell holds at least; of several cells in the order of what comes
/// first.
float NearNodes::gap2(int cell, const float* q) const {
  const float* low = boxes_.data() + static_cast<std::size_t>(cell) * 2 * dof_;
  const float* high = low + dof_;
  float sum = 0;
  for (std::size_t k = 0; k < dof_; ++k) {
    const float out = q[k] - std::min(std::max(q[k], low[k]), high[k]);
    sum += out * out;
  }
  return sum * (1 - kRounded);
}

void NearNodes::compare(const Leaf& leaf, const Wanted& wanted, Best& best) const {
  // The best of every lane, and then the best of these.
  std::array<Four, 2> least{Four{} + kNowhere * kNowhere, Four{} + kNowhere * kNowhere};
  std::array<FourInts, 2> found{};
  const float* places = leaf.places.data();
  for (std::size_t first = 0; first < leaf.nodes.size(); first += kLanes, places += kLanes * dof_) {
    const std::array<Four, 2> squared = squared_distances(places, wanted);
    for (std::size_t h = 0; h < 2; ++h) {
      const FourInts nearer = squared[h] < least[h];
      least[h] = nearer ? squared[h] : least[h];
      found[h] = nearer ? FourInts{} + static_cast<int>(first) : found[h];
    }
  }
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const float distance2 = least[lane / 4][lane % 4];
    if (distance2 > best.distance2) continue;
    const int node = leaf.nodes[static_cast<std::size_t>(found[lane / 4][lane % 4]) + lane];
    if (distance2 < best.distance2 || node < best.node) best = {distance2, node};
  }
}

void NearNodes::search(int cell, const Wanted& wanted, Best& best) const {
  const Cell& now = cells_[static_cast<std::size_t>(cell)];
  if (now.leaf >= 0) return compare(leaves_[static_cast<std::size_t>(now.leaf)], wanted, best);
  const float* const q = wanted.q.data();
  const std::array<float, 2> gaps2{gap2(now.halves[0], q), gap2(now.halves[1], q)};
  const std::size_t nearer = gaps2[1] < gaps2[0] ? 1 : 0;
  for (const std::size_t h : {nearer, 1 - nearer}) {
    if (gaps2[h] <= best.distance2) search(now.halves[h], wanted, best);
  }
}

int NearNodes::nearest(std::span<const double> q) const {
  Best best{kNowhere * kNowhere / 2, std::numeric_limits<int>::max()};
  search(0, Wanted(q), best);
  return best.node;
}

void NearNodes::collect(int cell, const Wanted& wanted, float radius2,
                        std::vector<int>& out) const {
  const Cell& now = cells_[static_cast<std::size_t>(cell)];
  if (now.leaf < 0) {
    for (const int half : now.halves) {
      if (gap2(half, wanted.q.data()) <= radius2) collect(half, wanted, radius2, out);
    }
    return;
  }
  const Leaf& leaf = leaves_[static_cast<std::size_t>(now.leaf)];
  for (std::size_t slot = 0; slot < leaf.nodes.size(); slot += kLanes) {
    const std::array<Four, 2> squared = squared_distances(leaf.places.data() + slot * dof_, wanted);
    for (std::size_t lane = 0; lane < std::min(kLanes, leaf.nodes.size() - slot); ++lane) {
      if (squared[lane / 4][lane % 4] <= radius2) out.push_back(leaf.nodes[slot + lane]);
    }
  }
}

void NearNodes::within(std::span<const double> q, double radius, std::vector<int>& out) const {
  float largest = 1;
  const Wanted wanted(q);
  for (std::size_t k = 0; k < dof_; ++k) largest = std::max(largest, std::abs(wanted.q[k]));
  const float reach =
      static_cast<float>(radius) + kRounded * (largest + static_cast<float>(radius));
  out.clear();
  collect(0, wanted, reach * reach, out);
}

}  // namespace mjarm::detail
