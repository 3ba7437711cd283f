#include <algorithm>
#include <limits>

#include "mjarm/planning/cell_channel_internal.hpp"

namespace mjarm::detail {
namespace {

using Kind = CellTree::Kind;

}  // namespace

/// In order of the depth, no deeper than `to`.
void CellChannel::flood(int from, int most, int to, Depths& out) {
  out.assign(tree_.size(), kNever);
  const auto depth_at = [&](int cell) -> int& { return out[static_cast<std::size_t>(cell)]; };
  std::vector<int> now, next;
  const auto enter = [&](int cell, int depth) {
    if (depth_at(cell) != kNever) return;
    const bool is_mixed = tree_.kind(cell) == Kind::mixed;
    depth_at(cell) = depth + (is_mixed ? 1 : 0);
    (is_mixed ? next : now).push_back(cell);
    if (cell == to) most = depth_at(cell);
  };
  enter(from, 0);
  for (int depth = 0; depth <= most; ++depth) {
    while (!now.empty()) {
      const int cell = now.back();
      now.pop_back();
      tree_.each_beside(cell, [&](int other) { enter(other, depth); });
    }
    if (next.empty()) return;
    std::swap(now, next);
  }
}

/// Cuts the mixed cells of all shortest channels. Those beside a channel make a detour of at least
/// one cell more. @return false where all are as small as they get.
bool CellChannel::cut_shortest(int from, int to) {
  const int least = depths_[0][static_cast<std::size_t>(to)];
  flood(to, least, from, depths_[1]);
  bool any = false;
  for (std::size_t k = 0; k < depths_[0].size(); ++k) {
    const auto cell = static_cast<int>(k);
    const int a = depths_[0][k], b = depths_[1][k];
    if (a == kNever || b == kNever || tree_.kind(cell) != Kind::mixed) continue;
    if (a + b - 1 == least) any = tree_.cut(cell) || any;
  }
  return any;
}

CellChannel::Outcome CellChannel::run(std::int64_t work) {
  const std::int64_t end = tree_.work() + work;
  while (tree_.work() < end) {
    const int from = tree_.find(ends_[0]), to = tree_.find(ends_[1]);
    if (tree_.kind(from) == Kind::blocked) return Outcome::unclear;  // not as it was said to be
    flood(from, std::numeric_limits<int>::max() - 1, to, depths_[0]);
    const int depth = depths_[0][static_cast<std::size_t>(to)];
    if (depth == kNever || tree_.kind(to) == Kind::blocked) {
      flood(to, std::numeric_limits<int>::max() - 1, kNever, depths_[1]);
      return Outcome::shut;
    }
    if (depth == 0) return Outcome::open;
    if (!cut_shortest(from, to)) return Outcome::unclear;
  }
  return Outcome::spent;
}

CellChannel::Room CellChannel::room(int end) const {
  Room out{0, std::numeric_limits<double>::infinity()};
  const Depths& depths = depths_[static_cast<std::size_t>(end)];
  for (std::size_t k = 0; k < depths.size(); ++k) {
    if (depths[k] == kNever) continue;
    const double width = tree_.width(static_cast<int>(k));
    out.volume += width * width * width;
    out.smallest = std::min(out.smallest, width);
  }
  return out;
}

}  // namespace mjarm::detail
