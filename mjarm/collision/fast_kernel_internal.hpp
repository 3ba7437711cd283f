#pragma once

#include "mjarm/collision/fast_block_internal.hpp"
#include "mjarm/collision/fast_walk_internal.hpp"

/// The search for collisions of a block of configurations. Included by one file for each width of
/// the registers.
namespace mjarm::detail {
inline namespace MJARM_FLOAT_LANES {

/// With kCover every radius grows by what its sphere can move within the lane's interval, so that
/// lanes without overlap prove their whole interval.
template <bool kCover>
class BlockSearch {
 public:
  BlockSearch(const FastRobotTables& robot, const FastWorldTables& world, LaneBits active, bool any)
      : robot_(robot), world_(world), active_(active), any_(any) {}

  FastVerdict collide(const FastRows& rows) {
    float q[kFastJoints * kWidth];
    read(rows, robot_.dof, q);
    const LaneBits outside = outside_limits(robot_, q) & active_;
    verdict_.hit = outside;
    active_ &= ~outside;
    if (active_ == 0 || (any_ && outside != 0)) return verdict_;
    block_.place(robot_, world_, q);
    q_ = q;
    search();
    return verdict_;
  }

  FastVerdict cover(const FastMotion& motion, const float* t, const float* half) {
    float q[kFastJoints * kWidth];
    for (int i = 0; i < robot_.dof; ++i) {
      for (int k = 0; k < kWidth; ++k) {
        const double value = motion.start[i] + static_cast<double>(t[k]) * motion.way[i];
        q[i * kWidth + k] = static_cast<float>(value);
      }
    }
    block_.place(robot_, world_, q);
    block_.move(robot_, motion.dq);
    q_ = q;
    motion_ = &motion;
    half_ = load(half);
    search();
    return verdict_;
  }

 private:
  /// Nothing is left to look at.
  bool is_done() const { return done_; }

  void search() {
    for (int g = 0; g < robot_.group_count; ++g) {
      if (kCover) grow_ = growth(g);
      meet_world(g);
      if (is_done()) return;
      if (world_.grid.cells != nullptr) meet_crowd(g);
      if (is_done()) return;
    }
    for (int k = 0; k < robot_.pair_count; ++k) {
      meet_itself(k);
      if (is_done()) return;
    }
  }

  float slack(int g) const { return kHiddenSpeed * motion_->rate[g]; }

  /// By how much a sphere of a group moves at most within the half interval: speed now, and what
  /// the speed can become.
  Floats growth(int g) const {
    const int body = robot_.groups[g].body;
    return growth(block_.velocity(block_.balls[g], body), block_.twists[body].w,
                  robot_.groups[g].spread, slack(g), motion_->bend[g]);
  }

  /// The same of a pair: how the farther link moves as seen from the other.
  Floats pair_growth(int k) const {
    const FastPair& pair = robot_.pairs[k];
    const Point& ball = block_.balls[pair.b];
    const int body_a = robot_.groups[pair.a].body, body_b = robot_.groups[pair.b].body;
    const Point v = block_.velocity(ball, body_b) - block_.velocity(ball, body_a);
    return growth(v, block_.twists[body_b].w - block_.twists[body_a].w,
                  robot_.groups[pair.b].spread, 2 * slack(pair.b), motion_->pair_bend[k]);
  }

  Floats growth(const Point& v, const Point& w, float spread, float slack, float bend) const {
    const Floats speed =
        multiply_add(square_root(squared(w)), splat(spread), square_root(squared(v))) + slack;
    return half_ * multiply_add(half_, splat(bend), speed) * 1.0001F;
  }

  /// (radius + growth)^2.
  Floats squared_reach(float radius) const {
    if constexpr (kCover) {
      const Floats reach = grow_ + radius;
      return reach * reach;
    }
    return splat(radius * radius);
  }

  /// The deepest overlap of several solids, noted all at once: branches cost more than the tests.
  /// Squared gaps less the squares of what they must be; negative: an overlap.
  struct Overlaps {
    Floats grown = splat(1);  ///< with growth
    Floats bare = splat(1);   ///< without
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

  /// @param refine  which lanes stay blocked when looked at more closely; costs more, so it is
  /// asked
  ///                only about lanes that do not overlap yet.
  template <class Refine>
  void note(const Overlaps& overlaps, const Refine& refine) {
    LaneBits lanes = less(kCover ? overlaps.grown : overlaps.bare, Floats{}) & active_;
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
      verdict_.blocked |= lanes;
      verdict_.hit |= bare;
      done_ = verdict_.hit != 0;
      half_ = zero_where(lanes, half_);  // such a lane goes on as a single configuration
      grow_ = zero_where(lanes, grow_);
    } else {
      verdict_.hit |= lanes;
      active_ &= ~lanes;
      done_ = any_ || active_ == 0;
    }
  }

  void meet_world(int g) {
    const FastRun& lists = world_.lists_of_group[g];
    for (int k = lists.first; k < lists.first + lists.count; ++k) {
      const FastList& list = world_.lists[k];
      Point turned;
      const Point& ball = into_frame(world_, list.frame, block_.balls[g], turned);
      meet_boxes(g, list, ball);
      meet_run(g, list.frame, ball, world_.boxes, list.rounds, world_.box_ids);
      meet_run(g, list.frame, ball, world_.cylinders, list.cylinders, world_.cylinder_ids);
      if (is_done()) return;
    }
  }

  /// As meet_run(), the radius being the same for all.
  void meet_boxes(int g, const FastList& list, const Point& ball) {
    const Floats reach = squared_reach(robot_.groups[g].ball.radius);
    const FastBox* const boxes = world_.boxes + list.boxes.first;
    std::uint64_t near = 0;
    for (int i = 0; i < list.boxes.count; ++i) {
      const bool any = (less(squared_gap(boxes[i], ball), reach) & active_) != 0;
      near |= static_cast<std::uint64_t>(any) << i;
    }
    for (; near != 0; near &= near - 1) {
      const int i = __builtin_ctzll(near);
      meet_solid(g, list.frame, boxes[i], world_.box_ids[list.boxes.first + i]);
      if (is_done()) return;
    }
  }

  template <class Solid>
  void meet_run(int g, int frame, const Point& ball, const Solid* solids, const FastRun& run,
                const int* ids) {
    const float radius = robot_.groups[g].ball.radius;
    for (int i = run.first; i < run.first + run.count; ++i) {
      const Solid& solid = solids[i];
      const Floats reach = squared_reach(radius + rounding_of(solid));
      if ((less(squared_gap(solid, ball), reach) & active_) == 0) continue;
      meet_solid(g, frame, solid, ids[i]);
    }
  }

  /// A solid that the ball of a group touches.
  template <class Solid>
  void meet_solid(int g, int frame, const Solid& solid, int id) {
    const FastGroup& group = robot_.groups[g];
    if (group.parts.count == 1) return meet_part(g, group.parts.first, frame, solid, id);
    block_.place_part_balls(robot_, g);
    for (int p = group.parts.first; p < group.parts.first + group.parts.count; ++p) {
      Point turned;
      const Point& ball = into_frame(world_, frame, block_.part_balls[p], turned);
      const Floats reach = squared_reach(robot_.parts[p].ball.radius + rounding_of(solid));
      if ((less(squared_gap(solid, ball), reach) & active_) != 0) meet_part(g, p, frame, solid, id);
    }
  }

  template <class Solid>
  void meet_part(int g, int p, int frame, const Solid& solid, int id) {
    const FastPart& part = robot_.parts[p];
    block_.place_spheres(robot_, robot_.groups[g].body, p);
    Overlaps overlaps;
    for (int k = part.first; k < part.first + part.count; ++k) {
      if (is_ignored(robot_, world_, k, id)) continue;
      Point turned;
      const Point& center = into_frame(world_, frame, block_.centers[k], turned);
      const float radius = robot_.spheres[k].radius + rounding_of(solid);
      look(squared_gap(solid, center), radius, -radius * radius, overlaps);
    }
    const FastRun spheres{part.first, part.count};
    note(overlaps, [&](LaneBits near) { return approaching(g, spheres, frame, solid, id, near); });
  }

  /// Which of the lanes `near` stay blocked when only motion towards the solid counts.
  template <class Solid>
  LaneBits approaching(int g, const FastRun& spheres, int frame, const Solid& solid, int id,
                       LaneBits near) const {
    const FastGroup& group = robot_.groups[g];
    LaneBits left = 0;
    for (int k = spheres.first; k < spheres.first + spheres.count && left != near; ++k) {
      if (is_ignored(robot_, world_, k, id)) continue;
      Point turned;
      const Point& center = into_frame(world_, frame, block_.centers[k], turned);
      const Point velocity = block_.velocity(block_.centers[k], group.body);
      Point turned_velocity;
      const Point& v = into_frame(world_, frame, velocity, turned_velocity);
      const float radius = robot_.spheres[k].radius + rounding_of(solid);
      left |= near & ~cleared(gap_vector(solid, center), v, radius, slack(g), motion_->bend[g]);
    }
    return left;
  }

  /// Lanes in which a sphere, whose centre is at `gap` from the nearest point of a convex solid and
  /// moves by `v`, stays farther from it than `radius`. The distance from a convex solid is a
  /// convex function of the place, so along its gradient n it changes by n.v and by what the motion
  /// bends; what goes along the surface does not count.
  LaneBits cleared(const Point& gap, const Point& v, float radius, float slack, float bend) const {
    const Floats distance = square_root(squared(gap));
    const Floats along_gap = multiply_add(gap.x, v.x, multiply_add(gap.y, v.y, gap.z * v.z));
    const Floats speed = larger(along_gap, -along_gap) / distance + slack;
    const Floats way = half_ * multiply_add(half_, splat(bend), speed) * 1.0001F;
    return less(way + radius * 1.000001F, distance);
  }

  /// What stands in trees: the grid says which spheres have to look there.
  void meet_crowd(int g) {
    const FastGroup& group = robot_.groups[g];
    if (group.body == 0) return;
    const Floats bound = distance_bound(world_.grid, block_.balls[g]);
    if ((less(bound, grow_ + group.ball.radius) & active_) == 0) return;
    block_.place_spheres(robot_, g);
    LaneBits together = 0;
    for (int k = group.first; k < group.first + group.count; ++k) {
      const Floats reach = grow_ + robot_.spheres[k].radius;
      near_[k] = less(distance_bound(world_.grid, block_.centers[k]), reach) & active_;
      together |= near_[k];
    }
    if (together == 0) return;
    if (world_.crowd.levels > 0) meet_items(g, together);
    if (world_.clouds.levels > 0 && !is_done()) meet_clouds(g);
  }

  void meet_items(int g, LaneBits lanes) {
    const float radius = robot_.groups[g].ball.radius;
    const Point& ball = block_.balls[g];
    const auto reach2 = [&] { return squared_reach(radius); };
    walk(world_.crowd, ball, lanes, active_, reach2, [&](int leaf, LaneBits touching) {
      const FastItem& item = world_.items[leaf];
      visit_solid(world_, item,
                  [&](const auto& solid) { meet_item(g, item.frame, touching, solid, item.id); });
      return is_done();
    });
  }

  template <class Solid>
  void meet_item(int g, int frame, LaneBits lanes, const Solid& solid, int id) {
    const FastGroup& group = robot_.groups[g];
    const float round = rounding_of(solid);
    Point turned_ball;
    const Point& ball = into_frame(world_, frame, block_.balls[g], turned_ball);
    lanes &= less(squared_gap(solid, ball), squared_reach(group.ball.radius + round));
    if (lanes == 0) return;
    Overlaps overlaps;
    for (int k = group.first; k < group.first + group.count; ++k) {
      if ((near_[k] & lanes) == 0 || is_ignored(robot_, world_, k, id)) continue;
      Point turned;
      const Point& center = into_frame(world_, frame, block_.centers[k], turned);
      const float radius = robot_.spheres[k].radius + round;
      look(squared_gap(solid, center), radius, -radius * radius, overlaps);
    }
    const FastRun spheres{group.first, group.count};
    note(overlaps, [&](LaneBits near) { return approaching(g, spheres, frame, solid, id, near); });
  }

  void meet_clouds(int g) {
    const FastGroup& group = robot_.groups[g];
    for (int k = group.first; k < group.first + group.count; ++k) {
      if ((near_[k] & active_) == 0) continue;
      const float radius = robot_.spheres[k].radius;
      const Point& center = block_.centers[k];
      const auto reach2 = [&] { return squared_reach(radius); };
      walk(world_.clouds, center, near_[k], active_, reach2, [&](int leaf, LaneBits touching) {
        meet_points(world_.points[leaf], center, radius, touching);
        return is_done();
      });
      if (is_done()) return;
    }
  }

  void meet_points(const FastPoints& points, const Point& center, float radius, LaneBits lanes) {
    if (__builtin_popcount(lanes) > kFewLanes) {
      Overlaps overlaps;
      for (int i = 0; i < kFan; ++i) {
        const float reach = radius + points.radius[i];
        look(squared(center - point_of(points, i)), reach, -reach * reach, overlaps);
      }
      return note(overlaps);
    }
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = __builtin_ctz(lanes);
      const LaneBits bit = LaneBits{1} << lane;
      const Point at = lane_of(center, lane);
      const float grow = kCover ? grow_[lane] : 0;
      if (any_point_within(points, at, radius + grow)) {
        note(bit & active_, any_point_within(points, at, radius) ? bit & active_ : 0);
      }
    }
  }

  [[gnu::always_inline]] void meet_itself(int k) {
    const FastPair& pair = robot_.pairs[k];
    const Point& ball = block_.balls[pair.b];
    const Floats balls = squared(block_.balls[pair.a] - ball);
    // The bounds that cost nothing first: most pairs are far apart.
    if constexpr (kCover) grow_ = half_ * motion_->pair_rate[k];
    LaneBits lanes = less(balls, squared_reach(pair.reach)) & active_;
    if (lanes == 0) return;
    if (pair.apart >= 0) {
      lanes &= ~less(grow_, apart_bound(robot_.apart[pair.apart], q_));
      if (lanes == 0) return;
    }
    if constexpr (kCover) {
      grow_ = smaller(grow_, pair_growth(k));
      lanes &= less(balls, squared_reach(pair.reach));
      if (lanes == 0) return;
    }
    block_.place_part_balls(robot_, pair.a);
    for (int i = pair.first; i < pair.first + pair.count; ++i) {
      const FastRow& row = robot_.rows[i];
      const Floats gap2 = squared(block_.part_balls[row.part] - ball);
      if ((less(gap2, squared_reach(row.reach)) & lanes) != 0) meet_row(k, row, lanes);
    }
  }

  void meet_row(int k, const FastRow& row, LaneBits lanes) {
    block_.place_part_balls(robot_, robot_.pairs[k].b);
    const Point ball = block_.part_balls[row.part];
    for (int i = row.first; i < row.first + row.count; ++i) {
      const FastPartPair& parts = robot_.part_pairs[i];
      const Floats gap2 = squared(ball - block_.part_balls[parts.b]);
      if ((less(gap2, squared_reach(parts.reach)) & lanes) != 0) meet_parts(k, parts);
    }
  }

  [[gnu::always_inline]] void meet_parts(int k, const FastPartPair& parts) {
    const FastPair& pair = robot_.pairs[k];
    block_.place_spheres(robot_, robot_.groups[pair.a].body, parts.a);
    block_.place_spheres(robot_, robot_.groups[pair.b].body, parts.b);
    Overlaps overlaps;
    for (int i = parts.first; i < parts.first + parts.count; ++i) {
      const FastPartners& both = robot_.partners[i];
      look(squared(block_.centers[both.a] - block_.centers[both.b]), both.reach, both.minus_reach2,
           overlaps);
    }
    note(overlaps, [&](LaneBits near) { return approaching(k, parts, near); });
  }

  /// The same of a pair of links: how the farther one moves as seen from the other.
  LaneBits approaching(int k, const FastPartPair& parts, LaneBits near) const {
    const FastPair& pair = robot_.pairs[k];
    const int body_a = robot_.groups[pair.a].body, body_b = robot_.groups[pair.b].body;
    LaneBits left = 0;
    for (int i = parts.first; i < parts.first + parts.count && left != near; ++i) {
      const FastPartners& both = robot_.partners[i];
      const Point& center = block_.centers[both.b];
      const Point gap = center - block_.centers[both.a];
      if ((less(squared(gap), squared_reach(both.reach)) & near) == 0) continue;
      const Point v = block_.velocity(center, body_b) - block_.velocity(center, body_a);
      left |= near & ~cleared(gap, v, both.reach, 2 * slack(pair.b), motion_->pair_bend[k]);
    }
    return left;
  }

  const FastRobotTables& robot_;
  const FastWorldTables& world_;
  LaneBits active_;
  bool any_;
  bool done_ = false;
  FastVerdict verdict_;
  const float* q_ = nullptr;
  const FastMotion* motion_ = nullptr;
  Floats half_{};
  Floats grow_{};
  LaneBits near_[kFastSpheres];  // lanes of a sphere that may be near what stands in trees
  Block block_;
};

inline std::uint32_t collide_block(const FastRobotTables& robot, const FastWorldTables& world,
                                   const FastRows& rows, bool any) {
  const LaneBits lanes = (LaneBits{1} << rows.count) - 1;
  return BlockSearch<false>(robot, world, lanes, any).collide(rows).hit;
}

inline FastVerdict cover_block(const FastRobotTables& robot, const FastWorldTables& world,
                               std::uint32_t active, const FastMotion& motion, const float* t,
                               const float* half) {
  return BlockSearch<true>(robot, world, active, true).cover(motion, t, half);
}

inline void bound_motion(const FastRates& rates, const FastLevers& levers, float* speed,
                         float* bend) {
  for (int i = 0; i < levers.stride; i += kWidth) {
    Floats v{}, a{};
    for (int k = 0; k < rates.dof; ++k) {
      const Floats lever = load(levers.levers + k * levers.stride + i);
      v = multiply_add(lever, splat(rates.rate[k]), v);
      a = multiply_add(lever, splat(rates.turn[k]), a);
    }
    Floats alike{};
    for (int k = 0; k < kWidth; ++k) alike[k] = rates.before[levers.from[i + k]];
    store(speed + i, v * 1.0001F);
    store(bend + i, 0.5001F * multiply_add(alike * v, splat(-2 * 0.9999F), a));
  }
}

}  // namespace MJARM_FLOAT_LANES
}  // namespace mjarm::detail
