#pragma once

#include "mjarm/collision/fast_block_internal.hpp"
#include "mjarm/collision/fast_walk_internal.hpp"

/// The search for the nearest pair of a block of configurations. Included by one file for each
/// width of the registers.
namespace mjarm::detail {
inline namespace MJARM_LANES {

class NearestSearch {
 public:
  NearestSearch(const FastRobotTables& robot, const FastWorldTables& world, const float* q,
                float max, bool together)
      : robot_(robot), world_(world), together_(together), best_(splat(max)) {
    block_.place(robot, world, q);
  }

  void run(FastNearest* out) {
    for (int k = 0; k < kFloats; ++k) out[k] = {best_[k], -1, -1, -1};
    found_ = out;
    for (int g = 0; g < robot_.group_count; ++g) meet_world(g);
    for (int g = 0; g < robot_.group_count; ++g) meet_crowd(g);
    for (int k = 0; k < robot_.every_pair_count; ++k) meet_itself(robot_.every_pair[k]);
    for (int k = 0; k < kFloats; ++k) {
      if (!together_ || out[k].sphere >= 0) out[k].distance = best_[k];
    }
  }

 private:
  /// Rounding of the root and of the radii that are taken off: less than 1e-6 of the distance.
  static Floats gap(const Floats& gap2, float radius) {
    return square_root(gap2) * (1 - 1e-6F) - radius;
  }

  void note(const Floats& distance, const FastNearest& pair) {
    const LaneBits lanes = less(distance, best_);
    if (lanes == 0) return;
    if (together_) return note_least(distance, pair);
    best_ = smaller(distance, best_);
    for (int k = 0; k < kFloats; ++k) {
      if (((lanes >> k) & 1) != 0) found_[k] = pair;
    }
  }

  /// The nearest of all lanes so far, which bounds them all.
  void note_least(const Floats& distance, const FastNearest& pair) {
    int lane = 0;
    for (int k = 1; k < kFloats; ++k) {
      if (distance[k] < distance[lane]) lane = k;
    }
    best_ = splat(distance[lane]);
    for (int k = 0; k < kFloats; ++k) found_[k].sphere = -1;
    found_[lane] = pair;
  }

  void meet_world(int g) {
    if (robot_.groups[g].body == 0) return;
    const FastRun& lists = world_.every_list;
    for (int k = lists.first; k < lists.first + lists.count; ++k) {
      const FastList& list = world_.lists[k];
      meet_run(g, list.frame, world_.boxes, list.boxes, world_.box_ids);
      meet_run(g, list.frame, world_.boxes, list.rounds, world_.box_ids);
      meet_run(g, list.frame, world_.cylinders, list.cylinders, world_.cylinder_ids);
    }
  }

  template <class Solid>
  void meet_run(int g, int frame, const Solid* solids, const FastRun& run, const int* ids) {
    const FastGroup& group = robot_.groups[g];
    Point turned_ball;
    const Point& ball = into_frame(world_, frame, block_.balls[g], turned_ball);
    for (int i = run.first; i < run.first + run.count; ++i) {
      const Solid& solid = solids[i];
      const float round = rounding_of(solid);
      if (less(gap(squared_gap(solid, ball), group.ball.radius + round), best_) == 0) continue;
      block_.place_part_balls(robot_, g);
      for (int p = group.parts.first; p < group.parts.first + group.parts.count; ++p) {
        Point turned;
        const Point& part = into_frame(world_, frame, block_.part_balls[p], turned);
        const float radius = robot_.parts[p].ball.radius + round;
        if (less(gap(squared_gap(solid, part), radius), best_) == 0) continue;
        block_.place_spheres(robot_, group.body, p);
        meet_part(robot_.parts[p], frame, solid, ids[i]);
      }
    }
  }

  template <class Solid>
  void meet_part(const FastPart& part, int frame, const Solid& solid, int id) {
    for (int k = part.first; k < part.first + part.count; ++k) {
      if (is_ignored(robot_, world_, k, id)) continue;
      Point turned;
      const Point& center = into_frame(world_, frame, block_.centers[k], turned);
      const float radius = robot_.spheres[k].radius + rounding_of(solid);
      note(gap(squared_gap(solid, center), radius), {0, k, id, -1});
    }
  }

  /// What stands in trees, lane by lane; what is found counts for all lanes.
  void meet_crowd(int g) {
    if (robot_.groups[g].body == 0) return;
    if (world_.crowd.levels > 0) meet_tree(g, world_.crowd);
    if (world_.clouds.levels > 0) meet_tree(g, world_.clouds);
  }

  void meet_tree(int g, const FastTree& tree) {
    const FastGroup& group = robot_.groups[g];
    const Floats far = best_ + group.ball.radius * (1 + 1e-5F);
    const FastNode& root = tree.nodes[tree.levels - 1][0];
    if (Touched(root, block_.balls[g], far * far, kAllLanes).children == 0) return;
    block_.place_spheres(robot_, g);
    for (int k = group.first; k < group.first + group.count; ++k) {
      for (int lane = 0; lane < kFloats; ++lane) meet_leaves(tree, k, lane);
    }
  }

  void meet_leaves(const FastTree& tree, int sphere, int lane) {
    const float radius = robot_.spheres[sphere].radius;
    const Point at = lane_of(block_.centers[sphere], lane);
    const auto limit2 = [&] {
      const float far = (best_[lane] + radius) * (1 + 1e-5F);
      return far > 0 ? far * far : 0.0F;
    };
    walk_nearest(tree, at, limit2, [&](int leaf) {
      if (&tree == &world_.crowd) {
        const FastItem& item = world_.items[leaf];
        if (!is_ignored(robot_, world_, sphere, item.id)) meet_item(sphere, item);
      } else {
        meet_points(sphere, leaf, at);
      }
    });
  }

  void meet_item(int sphere, const FastItem& item) {
    Point turned;
    const Point& center = into_frame(world_, item.frame, block_.centers[sphere], turned);
    const float radius = robot_.spheres[sphere].radius;
    visit_solid(world_, item, [&](const auto& solid) {
      const float round = rounding_of(solid);
      note(gap(squared_gap(solid, center), radius + round), {0, sphere, item.id, -1});
    });
  }

  /// The nearest point of a leaf to where a lane's sphere is.
  void meet_points(int sphere, int leaf, const Point& at) {
    const FastPoints& points = world_.points[leaf];
    const float radius = robot_.spheres[sphere].radius;
    float distances[kFan];
    for (int from = 0; from < kFan; from += kFloats) {
      const Floats distance = square_root(squared_gaps(points, from, at));
      store(distances + from, distance - load(points.radius + from));
    }
    int least = 0;
    for (int i = 1; i < kFan; ++i) least = distances[i] < distances[least] ? i : least;
    note(gap(squared(block_.centers[sphere] - point_of(points, least)),
             radius + points.radius[least]),
         {0, sphere, world_.point_ids[leaf * kFan + least], -1});
  }

  void meet_itself(const FastPair& pair) {
    const FastGroup& a = robot_.groups[pair.a];
    const FastGroup& b = robot_.groups[pair.b];
    const Floats balls = squared(block_.balls[pair.a] - block_.balls[pair.b]);
    if (less(gap(balls, pair.reach), best_) == 0) return;
    block_.place_part_balls(robot_, pair.a);
    block_.place_part_balls(robot_, pair.b);
    for (int k = pair.first; k < pair.first + pair.count; ++k) {
      const FastRow& row = robot_.rows[k];
      const Floats to_ball = squared(block_.part_balls[row.part] - block_.balls[pair.b]);
      if (less(gap(to_ball, row.reach), best_) != 0) meet_row(a.body, b.body, row);
    }
  }

  void meet_row(int body_a, int body_b, const FastRow& row) {
    for (int k = row.first; k < row.first + row.count; ++k) {
      const FastPartPair& parts = robot_.part_pairs[k];
      const Floats apart = squared(block_.part_balls[parts.a] - block_.part_balls[parts.b]);
      if (less(gap(apart, parts.reach), best_) == 0) continue;
      block_.place_spheres(robot_, body_a, parts.a);
      block_.place_spheres(robot_, body_b, parts.b);
      for (int j = parts.first; j < parts.first + parts.count; ++j) {
        const FastPartners& both = robot_.partners[j];
        note(gap(squared(block_.centers[both.a] - block_.centers[both.b]), both.reach),
             {0, both.a, -1, both.b});
      }
    }
  }

  const FastRobotTables& robot_;
  const FastWorldTables& world_;
  FastNearest* found_ = nullptr;
  bool together_;
  Floats best_;
  Block block_;
};

inline void clearances_of_block(const FastRobotTables& robot, const FastWorldTables& world,
                                const float* q, float max, bool together, FastNearest* out) {
  NearestSearch(robot, world, q, max, together).run(out);
}

}  // namespace MJARM_LANES
}  // namespace mjarm::detail
