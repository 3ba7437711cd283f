#pragma once

#include "mjarm/collision/fast_state_internal.hpp"
#include "mjarm/collision/fast_walk_internal.hpp"

/// A group of spheres against what stands round the robot. Included by one file for each width of
/// the registers.
namespace mjarm::detail {
inline namespace MJARM_LANES {

template <bool kCover>
class WorldSearch {
 public:
  explicit WorldSearch(BlockState<kCover>& state) : now_(state) {}

  /// What is in lists: few solids.
  void meet_lists(int g) {
    const FastRun& lists = now_.world.lists_of_group[g];
    for (int k = lists.first; k < lists.first + lists.count; ++k) {
      const FastList& list = now_.world.lists[k];
      Point turned;
      const Point& ball = into_frame(now_.world, list.frame, now_.block.balls[g], turned);
      meet_boxes(g, list, ball);
      meet_run(g, list.frame, ball, now_.world.boxes, list.rounds, now_.world.box_ids);
      meet_run(g, list.frame, ball, now_.world.cylinders, list.cylinders, now_.world.cylinder_ids);
      if (now_.done) return;
    }
  }

  /// What stands in trees: the grid says which spheres have to look there.
  void meet_crowd(int g) {
    const FastGroup& group = now_.robot.groups[g];
    if (group.body == 0) return;
    const Floats bound = distance_bound(now_.world.grid, now_.block.balls[g]);
    if ((less(bound, now_.grow + group.ball.radius) & now_.active) == 0) return;
    now_.block.place_spheres(now_.robot, g);
    LaneBits together = 0;
    for (int k = group.first; k < group.first + group.count; ++k) {
      const Floats reach = now_.grow + now_.robot.spheres[k].radius;
      now_.near_crowd[k] =
          less(distance_bound(now_.world.grid, now_.block.centers[k]), reach) & now_.active;
      together |= now_.near_crowd[k];
    }
    if (together == 0) return;
    if (now_.world.crowd.levels > 0) meet_items(g, together);
    if (now_.world.clouds.levels > 0 && !now_.done) meet_clouds(g);
  }

 private:
  using Overlaps = typename BlockState<kCover>::Overlaps;

  /// As meet_run(), the radius being the same for all.
  void meet_boxes(int g, const FastList& list, const Point& ball) {
    const Floats reach = now_.squared_reach(now_.robot.groups[g].ball.radius);
    const FastBox* const boxes = now_.world.boxes + list.boxes.first;
    std::uint64_t near = 0;
    for (int i = 0; i < list.boxes.count; ++i) {
      const bool any = (less(squared_gap(boxes[i], ball), reach) & now_.active) != 0;
      near |= static_cast<std::uint64_t>(any) << i;
    }
    for (; near != 0; near &= near - 1) {
      const int i = __builtin_ctzll(near);
      meet_solid(g, list.frame, boxes[i], now_.world.box_ids[list.boxes.first + i]);
      if (now_.done) return;
    }
  }

  template <class Solid>
  void meet_run(int g, int frame, const Point& ball, const Solid* solids, const FastRun& run,
                const int* ids) {
    const float radius = now_.robot.groups[g].ball.radius;
    for (int i = run.first; i < run.first + run.count; ++i) {
      const Solid& solid = solids[i];
      const Floats reach = now_.squared_reach(radius + rounding_of(solid));
      if ((less(squared_gap(solid, ball), reach) & now_.active) == 0) continue;
      meet_solid(g, frame, solid, ids[i]);
    }
  }

  /// A solid that the ball of a group touches.
  template <class Solid>
  void meet_solid(int g, int frame, const Solid& solid, int id) {
    const FastGroup& group = now_.robot.groups[g];
    if (group.parts.count == 1) return meet_part(g, group.parts.first, frame, solid, id);
    now_.block.place_part_balls(now_.robot, g);
    for (int p = group.parts.first; p < group.parts.first + group.parts.count; ++p) {
      Point turned;
      const Point& ball = into_frame(now_.world, frame, now_.block.part_balls[p], turned);
      const Floats reach = now_.squared_reach(now_.robot.parts[p].ball.radius + rounding_of(solid));
      if ((less(squared_gap(solid, ball), reach) & now_.active) == 0) continue;
      meet_part(g, p, frame, solid, id);
    }
  }

  template <class Solid>
  void meet_part(int g, int p, int frame, const Solid& solid, int id) {
    const FastPart& part = now_.robot.parts[p];
    now_.block.place_spheres(now_.robot, now_.robot.groups[g].body, p);
    Overlaps overlaps;
    for (int k = part.first; k < part.first + part.count; ++k) {
      if (is_ignored(now_.robot, now_.world, k, id)) continue;
      Point turned;
      const Point& center = into_frame(now_.world, frame, now_.block.centers[k], turned);
      const float radius = now_.robot.spheres[k].radius + rounding_of(solid);
      now_.look(squared_gap(solid, center), radius, -radius * radius, overlaps);
    }
    const FastRun spheres{part.first, part.count};
    now_.note(overlaps,
              [&](LaneBits near) { return approaching(g, spheres, frame, solid, id, near); });
  }

  /// Which of the lanes `near` stay blocked when only motion towards the solid counts.
  template <class Solid>
  LaneBits approaching(int g, const FastRun& spheres, int frame, const Solid& solid, int id,
                       LaneBits near) const {
    const FastGroup& group = now_.robot.groups[g];
    LaneBits left = 0;
    for (int k = spheres.first; k < spheres.first + spheres.count && left != near; ++k) {
      if (is_ignored(now_.robot, now_.world, k, id)) continue;
      Point turned;
      const Point& center = into_frame(now_.world, frame, now_.block.centers[k], turned);
      const Point velocity = now_.block.velocity(now_.block.centers[k], group.body);
      Point turned_velocity;
      const Point& v = into_frame(now_.world, frame, velocity, turned_velocity);
      const float radius = now_.robot.spheres[k].radius + rounding_of(solid);
      left |= near & ~now_.cleared(gap_vector(solid, center), v, radius, now_.slack(g),
                                   now_.motion->bend[g]);
    }
    return left;
  }

  void meet_items(int g, LaneBits lanes) {
    const float radius = now_.robot.groups[g].ball.radius;
    const Point& ball = now_.block.balls[g];
    const auto reach2 = [&] { return now_.squared_reach(radius); };
    walk(now_.world.crowd, ball, lanes, now_.active, reach2, [&](int leaf, LaneBits touching) {
      const FastItem& item = now_.world.items[leaf];
      visit_solid(now_.world, item,
                  [&](const auto& solid) { meet_item(g, item.frame, touching, solid, item.id); });
      return now_.done;
    });
  }

  template <class Solid>
  void meet_item(int g, int frame, LaneBits lanes, const Solid& solid, int id) {
    const FastGroup& group = now_.robot.groups[g];
    const float round = rounding_of(solid);
    Point turned_ball;
    const Point& ball = into_frame(now_.world, frame, now_.block.balls[g], turned_ball);
    lanes &= less(squared_gap(solid, ball), now_.squared_reach(group.ball.radius + round));
    if (lanes == 0) return;
    Overlaps overlaps;
    for (int k = group.first; k < group.first + group.count; ++k) {
      if ((now_.near_crowd[k] & lanes) == 0 || is_ignored(now_.robot, now_.world, k, id)) continue;
      Point turned;
      const Point& center = into_frame(now_.world, frame, now_.block.centers[k], turned);
      const float radius = now_.robot.spheres[k].radius + round;
      now_.look(squared_gap(solid, center), radius, -radius * radius, overlaps);
    }
    const FastRun spheres{group.first, group.count};
    now_.note(overlaps,
              [&](LaneBits near) { return approaching(g, spheres, frame, solid, id, near); });
  }

  void meet_clouds(int g) {
    const FastGroup& group = now_.robot.groups[g];
    for (int k = group.first; k < group.first + group.count; ++k) {
      if ((now_.near_crowd[k] & now_.active) == 0) continue;
      const float radius = now_.robot.spheres[k].radius;
      const Point& center = now_.block.centers[k];
      const auto reach2 = [&] { return now_.squared_reach(radius); };
      walk(now_.world.clouds, center, now_.near_crowd[k], now_.active, reach2,
           [&](int leaf, LaneBits touching) {
             meet_points(now_.world.points[leaf], center, radius, touching);
             return now_.done;
           });
      if (now_.done) return;
    }
  }

  void meet_points(const FastPoints& points, const Point& center, float radius, LaneBits lanes) {
    if (__builtin_popcount(lanes) > kFewLanes) {
      Overlaps overlaps;
      for (int i = 0; i < kFan; ++i) {
        const float reach = radius + points.radius[i];
        now_.look(squared(center - point_of(points, i)), reach, -reach * reach, overlaps);
      }
      return now_.note(overlaps);
    }
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = __builtin_ctz(lanes);
      const LaneBits bit = LaneBits{1} << lane;
      const Point at = lane_of(center, lane);
      const float grow = kCover ? now_.grow[lane] : 0;
      if (any_point_within(points, at, radius + grow)) {
        now_.note(bit & now_.active, any_point_within(points, at, radius) ? bit & now_.active : 0);
      }
    }
  }

  BlockState<kCover>& now_;
};

}  // namespace MJARM_LANES
}  // namespace mjarm::detail
