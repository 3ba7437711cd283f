#pragma once

#include "mjarm/collision/fast_state_internal.hpp"
#include "mjarm/collision/fast_walk_internal.hpp"

/// Two groups of spheres against each other. Included by one file for each width of the registers.
namespace mjarm::detail {
inline namespace MJARM_LANES {

template <bool kCover>
class SelfSearch {
 public:
  explicit SelfSearch(BlockState<kCover>& state) : now_(state) {}

  /// Pair `k` of the robot.
  [[gnu::always_inline]] void meet(int k) {
    const FastPair& pair = now_.robot.pairs[k];
    const Point& ball = now_.block.balls[pair.b];
    const Floats balls = squared(now_.block.balls[pair.a] - ball);
    // The bounds that cost nothing first: most pairs are far apart.
    if constexpr (kCover) now_.grow = now_.half * now_.motion->pair_rate[k];
    LaneBits lanes = less(balls, now_.squared_reach(pair.reach)) & now_.active;
    if (lanes == 0) return;
    if (pair.apart >= 0) {
      const Floats apart = apart_bound(now_.robot.apart[pair.apart], now_.q);
      const LaneBits overlapping = less(apart, Floats{}) & lanes;
      now_.note(overlapping, overlapping);
      lanes &= now_.active & ~less(now_.grow, apart);
      if (lanes == 0 || now_.done) return;
    }
    if constexpr (kCover) {
      now_.grow = smaller(now_.grow, now_.pair_growth(k));
      lanes &= less(balls, now_.squared_reach(pair.reach));
      if (lanes == 0) return;
    }
    now_.block.place_part_balls(now_.robot, pair.a);
    for (int i = pair.first; i < pair.first + pair.count; ++i) {
      const FastRow& row = now_.robot.rows[i];
      const Floats gap2 = squared(now_.block.part_balls[row.part] - ball);
      if ((less(gap2, now_.squared_reach(row.reach)) & lanes) != 0) meet_row(k, row, lanes);
    }
  }

 private:
  using Overlaps = typename BlockState<kCover>::Overlaps;

  void meet_row(int k, const FastRow& row, LaneBits lanes) {
    now_.block.place_part_balls(now_.robot, now_.robot.pairs[k].b);
    const Point ball = now_.block.part_balls[row.part];
    for (int i = row.first; i < row.first + row.count; ++i) {
      const FastPartPair& parts = now_.robot.part_pairs[i];
      const Floats gap2 = squared(ball - now_.block.part_balls[parts.b]);
      if ((less(gap2, now_.squared_reach(parts.reach)) & lanes) != 0) meet_parts(k, parts);
    }
  }

  [[gnu::always_inline]] void meet_parts(int k, const FastPartPair& parts) {
    const FastPair& pair = now_.robot.pairs[k];
    now_.block.place_spheres(now_.robot, now_.robot.groups[pair.a].body, parts.a);
    now_.block.place_spheres(now_.robot, now_.robot.groups[pair.b].body, parts.b);
    Overlaps overlaps;
    for (int i = parts.first; i < parts.first + parts.count; ++i) {
      const FastPartners& both = now_.robot.partners[i];
      now_.look(squared(now_.block.centers[both.a] - now_.block.centers[both.b]), both.reach,
                both.minus_reach2, overlaps);
    }
    now_.note(overlaps, [&](LaneBits near) { return approaching(k, parts, near); });
  }

  /// The same of a pair of links: how the farther one moves as seen from the other.
  LaneBits approaching(int k, const FastPartPair& parts, LaneBits near) const {
    const FastPair& pair = now_.robot.pairs[k];
    const int body_a = now_.robot.groups[pair.a].body, body_b = now_.robot.groups[pair.b].body;
    LaneBits left = 0;
    for (int i = parts.first; i < parts.first + parts.count && left != near; ++i) {
      const FastPartners& both = now_.robot.partners[i];
      const Point& center = now_.block.centers[both.b];
      const Point gap = center - now_.block.centers[both.a];
      if ((less(squared(gap), now_.squared_reach(both.reach)) & near) == 0) continue;
      const Point v = now_.block.velocity(center, body_b) - now_.block.velocity(center, body_a);
      left |= near &
              ~now_.cleared(gap, v, both.reach, 2 * now_.slack(pair.b), now_.motion->pair_bend[k]);
    }
    return left;
  }

  BlockState<kCover>& now_;
};

}  // namespace MJARM_LANES
}  // namespace mjarm::detail
