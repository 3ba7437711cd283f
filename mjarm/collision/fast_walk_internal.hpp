#pragma once

#include "mjarm/collision/fast_block_internal.hpp"

/// Walks through trees of boxes with a ball in every lane. Included by one file for each width of
/// the registers.
///
/// Lanes that are near each other go together, a child at a time; few lanes go one by one, as many
/// children at a time as a register holds. So nodes cost the lesser of both.
namespace mjarm::detail {
inline namespace MJARM_LANES {

/// As many lanes are looked at one by one.
inline constexpr int kFewLanes = kFloats / 2;

/// A lane's point in all lanes.
inline Point lane_of(const Point& p, int lane) {
  return {splat(p.x[lane]), splat(p.y[lane]), splat(p.z[lane])};
}

inline Point point_of(const FastPoints& points, int i) {
  return {splat(points.center[0][i]), splat(points.center[1][i]), splat(points.center[2][i])};
}

/// Cells of `side` along one axis; NaN gives one as well.
inline Ints cell_along(const Floats& x, float low, float per_unit, int side) {
  const Floats at = (x - low) * per_unit;
  const Floats last = splat(static_cast<float>(side - 1));
  return __builtin_convertvector(smaller(larger(at, Floats{}), last), Ints);
}
inline Ints cell_along(const Floats& x, float low, const FastGrid& grid) {
  return cell_along(x, low, grid.per_meter, grid.side);
}

/// Lower bound of how far two groups keep apart [m]; negative where they overlap.
/// @param q  (dof, kFloats), joint by joint.
inline Floats apart_bound(const FastApart& table, const float* q) {
  Ints cell[2];
  for (int k = 0; k < 2; ++k) {
    const Floats value = load(q + table.joint[k] * kFloats);
    cell[k] = cell_along(value, table.low[k], table.per_unit[k], table.side);
  }
  const Ints counts = gather(table.cells, cell[1] * table.side + cell[0]);
  return __builtin_convertvector(counts - 1, Floats) * table.unit;
}

/// Lower bound of the distance from a point to all that the grid knows [m].
inline Floats distance_bound(const FastGrid& grid, const Point& p) {
  const Ints x = cell_along(p.x, grid.low[0], grid);
  const Ints y = cell_along(p.y, grid.low[1], grid);
  const Ints z = cell_along(p.z, grid.low[2], grid);
  const Ints counts = gather(grid.cells, (z * grid.side + y) * grid.side + x);
  return __builtin_convertvector(counts, Floats) * grid.unit - grid.slack;
}

/// Distance along one axis from an interval.
inline Floats beyond(const Floats& x, const Floats& low, const Floats& high) {
  return x - smaller(larger(x, low), high);
}

/// Squared distances of the boxes of children `from` to `from` + kFloats.
inline Floats squared_gaps(const FastNode& node, int from, const Point& p) {
  return squared(Point{beyond(p.x, load(node.low[0] + from), load(node.high[0] + from)),
                       beyond(p.y, load(node.low[1] + from), load(node.high[1] + from)),
                       beyond(p.z, load(node.low[2] + from), load(node.high[2] + from))});
}

/// Squared distances of points `from` to `from` + kFloats.
inline Floats squared_gaps(const FastPoints& points, int from, const Point& p) {
  return squared(Point{p.x - load(points.center[0] + from), p.y - load(points.center[1] + from),
                       p.z - load(points.center[2] + from)});
}

/// Whether a point comes as near as its radius and `radius` together; all lanes of p are the same.
inline bool any_point_within(const FastPoints& points, const Point& p, float radius) {
  LaneBits near = 0;
  for (int from = 0; from < kFan; from += kFloats) {
    const Floats reach = load(points.radius + from) + radius;
    near |= less(squared_gaps(points, from, p), reach * reach);
  }
  return near != 0;
}

/// Which children of a node the balls of some lanes touch.
struct Touched {
  std::uint32_t children = 0;
  LaneBits child[kFan];  ///< lanes that touch it

  Touched(const FastNode& node, const Point& ball, const Floats& reach2, LaneBits lanes) {
    if (__builtin_popcount(lanes) > kFewLanes) {
      together(node, ball, reach2, lanes);
    } else {
      one_by_one(node, ball, reach2, lanes);
    }
  }

 private:
  void together(const FastNode& node, const Point& ball, const Floats& reach2, LaneBits lanes) {
    for (int c = 0; c < kFan; ++c) {
      const Point out = {beyond(ball.x, splat(node.low[0][c]), splat(node.high[0][c])),
                         beyond(ball.y, splat(node.low[1][c]), splat(node.high[1][c])),
                         beyond(ball.z, splat(node.low[2][c]), splat(node.high[2][c]))};
      child[c] = less(squared(out), reach2) & lanes;
      children |= static_cast<std::uint32_t>(child[c] != 0) << c;
    }
  }

  void one_by_one(const FastNode& node, const Point& ball, const Floats& reach2, LaneBits lanes) {
    for (LaneBits& bits : child) bits = 0;
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = __builtin_ctz(lanes);
      const Point p = lane_of(ball, lane);
      std::uint32_t near = 0;
      for (int from = 0; from < kFan; from += kFloats) {
        near |= less(squared_gaps(node, from, p), splat(reach2[lane])) << from;
      }
      children |= near;
      for (; near != 0; near &= near - 1) child[__builtin_ctz(near)] |= LaneBits{1} << lane;
    }
  }
};

/// Visits every leaf that a ball touches: visit(leaf, lanes) returns whether the walk is over.
/// @param lanes   that take part.
/// @param active  those that still do; may shrink on the way.
/// @param reach2  reach2(): squared radii of the balls, which may shrink as well.
template <class Reach, class Visit>
void walk(const FastTree& tree, const Point& ball, LaneBits lanes, const LaneBits& active,
          const Reach& reach2, const Visit& visit) {
  struct Open {
    int level, node;
    LaneBits lanes;
  };
  Open open[kFan * kFastLevels];
  open[0] = {tree.levels - 1, 0, lanes};
  for (int count = 1; count > 0;) {
    const Open now = open[--count];
    if ((now.lanes & active) == 0) continue;
    const Touched touched(tree.nodes[now.level][now.node], ball, reach2(), now.lanes & active);
    for (std::uint32_t left = touched.children; left != 0; left &= left - 1) {
      const int c = __builtin_ctz(left);
      const int child = now.node * kFan + c;
      if (now.level > 0) {
        open[count++] = {now.level - 1, child, touched.child[c]};
      } else if (visit(child, touched.child[c])) {
        return;
      }
    }
  }
}

/// Visits the leaves that are nearer to a point than a limit, the nearer ones of a node first.
/// @param p       the same in all lanes.
/// @param limit2  limit2(): squared limit, which may shrink on the way.
template <class Limit, class Visit>
void walk_nearest(const FastTree& tree, const Point& p, const Limit& limit2, const Visit& visit) {
  struct Open {
    int level, node;  // level -1: a leaf
    float gap2;
  };
  Open open[kFan * (kFastLevels + 1)];
  open[0] = {tree.levels - 1, 0, 0};
  for (int count = 1; count > 0;) {
    const Open now = open[--count];
    if (now.gap2 >= limit2()) continue;
    if (now.level < 0) {
      visit(now.node);
      continue;
    }
    float gaps2[kFan];
    for (int from = 0; from < kFan; from += kFloats) {
      store(gaps2 + from, squared_gaps(tree.nodes[now.level][now.node], from, p));
    }
    const float max = limit2();
    const int first = count;
    for (int c = 0; c < kFan; ++c) {
      if (gaps2[c] >= max) continue;
      int at = count++;
      for (; at > first && open[at - 1].gap2 < gaps2[c]; --at) open[at] = open[at - 1];
      open[at] = {now.level - 1, now.node * kFan + c, gaps2[c]};
    }
  }
}

}  // namespace MJARM_LANES
}  // namespace mjarm::detail
