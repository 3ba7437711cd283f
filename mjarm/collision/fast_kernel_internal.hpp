#pragma once

#include "mjarm/collision/fast_meet_itself_internal.hpp"
#include "mjarm/collision/fast_meet_world_internal.hpp"

/// The search for collisions of a block of configurations. Included by one file for each width of
/// the registers.
namespace mjarm::detail {
inline namespace MJARM_LANES {

template <bool kCover>
class BlockSearch {
 public:
  BlockSearch(const FastRobotTables& robot, const FastWorldTables& world, LaneBits active, bool any)
      : now_(robot, world, active, any) {}

  FastVerdict collide(const FastRows& rows) {
    float q[kFastJoints * kFloats];
    read(rows, now_.robot.dof, q);
    const LaneBits outside = outside_limits(now_.robot, q) & now_.active;
    now_.verdict.hit = outside;
    now_.active &= ~outside;
    if (now_.active == 0 || (now_.any && outside != 0)) return now_.verdict;
    now_.block.place(now_.robot, now_.world, q);
    now_.q = q;
    search();
    return now_.verdict;
  }

  FastVerdict cover(const FastMotion& motion, const float* t, const float* half) {
    float q[kFastJoints * kFloats];
    for (int i = 0; i < now_.robot.dof; ++i) {
      for (int k = 0; k < kFloats; ++k) {
        const double value = motion.start[i] + static_cast<double>(t[k]) * motion.way[i];
        q[i * kFloats + k] = static_cast<float>(value);
      }
    }
    now_.block.place(now_.robot, now_.world, q);
    now_.block.move(now_.robot, motion.dq);
    now_.q = q;
    now_.motion = &motion;
    now_.half = load(half);
    search();
    return now_.verdict;
  }

 private:
  void search() {
    WorldSearch<kCover> world(now_);
    for (int g = 0; g < now_.robot.group_count; ++g) {
      if (kCover) now_.grow = now_.growth(g);
      world.meet_lists(g);
      if (now_.done) return;
      if (now_.world.grid.cells != nullptr) world.meet_crowd(g);
      if (now_.done) return;
    }
    SelfSearch<kCover> itself(now_);
    for (int k = 0; k < now_.robot.pair_count; ++k) {
      itself.meet(k);
      if (now_.done) return;
    }
  }

  BlockState<kCover> now_;
};

inline std::uint32_t collide_block(const FastRobotTables& robot, const FastWorldTables& world,
                                   const FastRows& rows, bool any) {
  const LaneBits lanes = (LaneBits{1} << rows.count) - 1;
  return BlockSearch<false>(robot, world, lanes, any).collide(rows).hit;
}

inline FastVerdict cover_block(const FastRobotTables& robot, const FastWorldTables& world,
                               std::uint32_t active, const FastMotion& motion, const float* t,
                               const float* half, bool any) {
  return BlockSearch<true>(robot, world, active, any).cover(motion, t, half);
}

inline void bound_motion(const FastRates& rates, const FastLevers& levers, float* speed,
                         float* bend) {
  for (int i = 0; i < levers.stride; i += kFloats) {
    Floats v{}, a{};
    for (int k = 0; k < rates.dof; ++k) {
      const Floats lever = load(levers.levers + k * levers.stride + i);
      v = multiply_add(lever, splat(rates.rate[k]), v);
      a = multiply_add(lever, splat(rates.turn[k]), a);
    }
    Floats alike{};
    for (int k = 0; k < kFloats; ++k) alike[k] = rates.before[levers.from[i + k]];
    store(speed + i, v * 1.0001F);
    store(bend + i, 0.5001F * multiply_add(alike * v, splat(-2 * 0.9999F), a));
  }
}

}  // namespace MJARM_LANES
}  // namespace mjarm::detail
