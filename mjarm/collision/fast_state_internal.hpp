#pragma once

#include "mjarm/collision/fast_block_internal.hpp"

/// What a search for collisions knows of a block of configurations, and how overlaps are noted.
/// Included by one file for each width of the registers.
namespace mjarm::detail {
inline namespace MJARM_LANES {

/// With kCover every radius grows by what its sphere can move within the lane's interval, so that
/// lanes without overlap prove their whole interval.
template <bool kCover>
struct BlockState {
  BlockState(const FastRobotTables& robot_tables, const FastWorldTables& world_tables,
             LaneBits lanes, bool any_will_do)
      : robot(robot_tables), world(world_tables), active(lanes), any(any_will_do) {}

  float slack(int g) const { return kHiddenSpeed * motion->rate[g]; }

  /// By how much a sphere of a group moves at most within the half interval: speed now, and what
  /// the speed can become.
  Floats growth(int g) const {
    const int body = robot.groups[g].body;
    return growth(block.velocity(block.balls[g], body), block.twists[body].w,
                  robot.groups[g].spread, slack(g), motion->bend[g]);
  }

  /// The same of a pair: how the farther link moves as seen from the other.
  Floats pair_growth(int k) const {
    const FastPair& pair = robot.pairs[k];
    const Point& ball = block.balls[pair.b];
    const int body_a = robot.groups[pair.a].body, body_b = robot.groups[pair.b].body;
    const Point v = block.velocity(ball, body_b) - block.velocity(ball, body_a);
    return growth(v, block.twists[body_b].w - block.twists[body_a].w, robot.groups[pair.b].spread,
                  2 * slack(pair.b), motion->pair_bend[k]);
  }

  Floats growth(const Point& v, const Point& w, float spread, float slack, float bend) const {
    const Floats speed =
        multiply_add(square_root(squared(w)), splat(spread), square_root(squared(v))) + slack;
    return half * multiply_add(half, splat(bend), speed) * 1.0001F;
  }

  /// (radius + growth)^2.
  Floats squared_reach(float radius) const {
    if constexpr (kCover) {
      const Floats reach = grow + radius;
      return reach * reach;
    }
    return splat(radius * radius);
  }

  /// The deepest overlap of several solids, noted all at once: branches cost more than the tests.
  /// Squared gaps less the squares of what they must be; negative: an overlap.
  struct Overlaps {
    Floats grown = splat(1.0F);  ///< with growth
    Floats bare = splat(1.0F);   ///< without
  };

  void look(const Floats& gap2, float radius, float minus_radius2, Overlaps& overlaps) const {
    const Floats bare = gap2 + minus_radius2;
    overlaps.bare = smaller(overlaps.bare, bare);
    if constexpr (kCover) {
      overlaps.grown = smaller(overlaps.grown, gap2 - squared_reach(radius));
    }
  }

  void note(const Overlaps& overlaps) {
    note(overlaps, [](LaneBits near) { return near; });
  }

  /// @param refine  which lanes stay blocked when looked at more closely; it costs more, so it is
  ///                asked only about lanes that do not overlap yet.
  template <class Refine>
  void note(const Overlaps& overlaps, const Refine& refine) {
    LaneBits lanes = less(kCover ? overlaps.grown : overlaps.bare, Floats{}) & active;
    if (lanes == 0) return;
    if constexpr (kCover) {
      const LaneBits bare = less(overlaps.bare, Floats{}) & lanes;
      if (bare == 0) lanes = refine(lanes);
      note(lanes, bare);
    } else {
      note(lanes, lanes);
    }
  }

  /// Lanes that overlap, and those of them that do without growth.
  void note(LaneBits lanes, LaneBits bare) {
    if (lanes == 0) return;
    if constexpr (kCover) {
      verdict.blocked |= lanes;
      verdict.hit |= bare;
      done = any ? verdict.hit != 0 : verdict.hit == active;
      half = zero_where(lanes, half);  // such a lane goes on as a single configuration
      grow = zero_where(lanes, grow);
    } else {
      verdict.hit |= lanes;
      active &= ~lanes;
      done = any || active == 0;
    }
  }

  /// Lanes in which a sphere, whose centre is at `gap` from the nearest point of a convex solid and
  /// moves by `v`, stays farther from it than `radius`. The distance from a convex solid is a
  /// convex function of the place, so along its gradient n it changes by n.v and by what the motion
  /// bends; what goes along the surface does not count.
  LaneBits cleared(const Point& gap, const Point& v, float radius, float slack, float bend) const {
    const Floats distance = square_root(squared(gap));
    const Floats along_gap = multiply_add(gap.x, v.x, multiply_add(gap.y, v.y, gap.z * v.z));
    const Floats speed = larger(along_gap, -along_gap) / distance + slack;
    const Floats way = half * multiply_add(half, splat(bend), speed) * 1.0001F;
    return less(way + radius * 1.000001F, distance);
  }

  const FastRobotTables& robot;
  const FastWorldTables& world;
  LaneBits active;
  bool any;           ///< the first lane found ends the search
  bool done = false;  ///< nothing is left to look at
  FastVerdict verdict;
  const float* q = nullptr;            ///< (dof, kFloats)
  const FastMotion* motion = nullptr;  ///< with kCover
  Floats half{};                       ///< of the lane's interval
  Floats grow{};                       ///< [m] of what is looked at now
  LaneBits near_crowd[kFastSpheres];   ///< lanes of a sphere that may be near what stands in trees
  Block block;
};

}  // namespace MJARM_LANES
}  // namespace mjarm::detail
