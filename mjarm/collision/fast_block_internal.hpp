#pragma once

#include "mjarm/collision/fast_tables_internal.hpp"
#include "mjarm/core/simd/functions.hpp"

/// Where the spheres of a robot are, for as many configurations as a register holds. Included by
/// one file for each width of the registers.
namespace mjarm::detail {
inline namespace MJARM_LANES {

using namespace simd;

struct Point {
  Floats x, y, z;
};

inline Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

inline Floats squared(const Point& a) {
  return multiply_add(a.x, a.x, multiply_add(a.y, a.y, a.z * a.z));
}

/// p + k * a.
inline Point along(const Point& p, Floats k, const Point& a) {
  return {multiply_add(k, a.x, p.x), multiply_add(k, a.y, p.y), multiply_add(k, a.z, p.z)};
}

/// p + a x b.
inline Point plus_cross(const Point& p, const Point& a, const Point& b) {
  return {multiply_add(a.y, b.z, p.x) - a.z * b.y, multiply_add(a.z, b.x, p.y) - a.x * b.z,
          multiply_add(a.x, b.y, p.z) - a.y * b.x};
}

/// Axes and origin of a body.
struct Frame {
  Point x, y, z, p;
};

/// Its velocity, by the parameter of an edge.
struct Twist {
  Point v, w;
};

inline Point in_world(const Frame& f, const FastSphere& s) {
  return along(along(along(f.p, splat(s.x), f.x), splat(s.y), f.y), splat(s.z), f.z);
}

inline void tilt(const FastJoint& joint, Frame& f) {
  const Point y = f.y, z = f.z;
  switch (joint.tilt) {
    case Tilt::none:
      break;
    case Tilt::quarter:
      f.y = z;
      f.z = {-y.x, -y.y, -y.z};
      break;
    case Tilt::any: {
      const Floats c = splat(joint.tilt_cos), s = splat(joint.tilt_sin);
      f.y = {multiply_add(c, y.x, s * z.x), multiply_add(c, y.y, s * z.y),
             multiply_add(c, y.z, s * z.z)};
      f.z = {multiply_add(c, z.x, -s * y.x), multiply_add(c, z.y, -s * y.y),
             multiply_add(c, z.z, -s * y.z)};
      break;
    }
  }
}

/// Carries a frame over a joint at `q`.
inline void carry(const FastJoint& joint, Floats q, Frame& f) {
  if (joint.t[0] != 0) f.p = along(f.p, splat(joint.t[0]), f.x);
  if (joint.t[1] != 0) f.p = along(f.p, splat(joint.t[1]), f.y);
  if (joint.t[2] != 0) f.p = along(f.p, splat(joint.t[2]), f.z);
  tilt(joint, f);
  if (joint.slide) f.p = along(f.p, q, f.z);
  if (joint.slide && joint.offset == 0) return;
  Floats s, c;
  sine_cosine(joint.slide ? splat(joint.offset) : q + joint.offset, s, c);
  const Point x = f.x, y = f.y;
  f.x = {multiply_add(c, x.x, s * y.x), multiply_add(c, x.y, s * y.y),
         multiply_add(c, x.z, s * y.z)};
  f.y = {multiply_add(c, y.x, -s * x.x), multiply_add(c, y.y, -s * x.y),
         multiply_add(c, y.z, -s * x.z)};
}

/// Four joints from `joint` on, as columns: of as many rows as a register holds.
inline void read_columns(const double* const* row, int joint, float* q) {
  typedef double FourDoubles __attribute__((vector_size(32)));
  Quad columns[4][kFloats / 4];
  for (int lane = 0; lane < kFloats; lane += 4) {
    Quad r[4];
    for (int k = 0; k < 4; ++k) {
      FourDoubles four;
      __builtin_memcpy(&four, row[lane + k] + joint, sizeof four);
      r[k] = __builtin_convertvector(four, Quad);
    }
    const Quad low01 = __builtin_shufflevector(r[0], r[1], 0, 4, 1, 5);
    const Quad low23 = __builtin_shufflevector(r[2], r[3], 0, 4, 1, 5);
    const Quad high01 = __builtin_shufflevector(r[0], r[1], 2, 6, 3, 7);
    const Quad high23 = __builtin_shufflevector(r[2], r[3], 2, 6, 3, 7);
    columns[0][lane / 4] = __builtin_shufflevector(low01, low23, 0, 1, 4, 5);
    columns[1][lane / 4] = __builtin_shufflevector(low01, low23, 2, 3, 6, 7);
    columns[2][lane / 4] = __builtin_shufflevector(high01, high23, 0, 1, 4, 5);
    columns[3][lane / 4] = __builtin_shufflevector(high01, high23, 2, 3, 6, 7);
  }
  for (int i = 0; i < 4; ++i) store(q + (joint + i) * kFloats, joined(columns[i]));
}

/// Configurations joint by joint: q (dof, kFloats).
inline void read(const FastRows& rows, int dof, float* q) {
  const double* row[kFloats];
  for (int k = 0; k < kFloats; ++k) row[k] = rows.q + (k < rows.count ? k : rows.count - 1) * dof;
  if (dof >= 4) {
    for (int i = 0; i + 4 < dof; i += 4) read_columns(row, i, q);
    read_columns(row, dof - 4, q);
    return;
  }
  for (int i = 0; i < dof; ++i) {
    for (int k = 0; k < kFloats; ++k) q[i * kFloats + k] = static_cast<float>(row[k][i]);
  }
}

/// The scratch memory of one check.
struct Block {
  Frame frames[kFastJoints + 1];
  Twist twists[kFastJoints + 1];
  Point balls[kFastGroups];
  Point part_balls[kFastSpheres];
  Point centers[kFastSpheres];
  bool placed_balls[kFastGroups];  // those of the parts
  bool placed[kFastSpheres];       // the spheres of a part

  /// Frames of all bodies and the balls round the links; no sphere yet.
  void place(const FastRobotTables& robot, const FastWorldTables& world, const float* q) {
    const float* b = world.base;
    const Floats none{};
    frames[0] = {{splat(b[0]), splat(b[1]), splat(b[2])},
                 {splat(b[3]), splat(b[4]), splat(b[5])},
                 {splat(b[6]), splat(b[7]), splat(b[8])},
                 {none, none, none}};
    Frame f = frames[0];
    for (int i = 0; i < robot.dof; ++i) {
      carry(robot.joints[i], load(q + i * kFloats), f);
      frames[i + 1] = f;
    }
    for (int g = 0; g < robot.group_count; ++g) {
      balls[g] = in_world(frames[robot.groups[g].body], robot.groups[g].ball);
      placed_balls[g] = false;
    }
    for (int p = 0; p < robot.part_count; ++p) placed[p] = false;
  }

  /// Velocities of all bodies, whose frames are placed.
  void move(const FastRobotTables& robot, const float* dq) {
    Twist now{};
    twists[0] = now;
    for (int i = 0; i < robot.dof; ++i) {
      now.v = plus_cross(now.v, now.w, frames[i + 1].p - frames[i].p);
      Point& moved = robot.joints[i].slide ? now.v : now.w;
      moved = along(moved, splat(dq[i]), frames[i + 1].z);
      twists[i + 1] = now;
    }
  }

  /// How the point of body `body` that is now at `p` moves.
  Point velocity(const Point& p, int body) const {
    return plus_cross(twists[body].v, twists[body].w, p - frames[body].p);
  }

  void place_part_balls(const FastRobotTables& robot, int g) {
    if (placed_balls[g]) return;
    placed_balls[g] = true;
    const FastGroup& group = robot.groups[g];
    for (int p = group.parts.first; p < group.parts.first + group.parts.count; ++p) {
      part_balls[p] = in_world(frames[group.body], robot.parts[p].ball);
    }
  }

  /// The spheres of part `p`, which belongs to body `body`.
  void place_spheres(const FastRobotTables& robot, int body, int p) {
    if (placed[p]) return;
    placed[p] = true;
    const FastPart& part = robot.parts[p];
    for (int k = part.first; k < part.first + part.count; ++k) {
      centers[k] = in_world(frames[body], robot.spheres[k]);
    }
  }
  void place_spheres(const FastRobotTables& robot, int g) {
    const FastGroup& group = robot.groups[g];
    for (int p = group.parts.first; p < group.parts.first + group.parts.count; ++p) {
      place_spheres(robot, group.body, p);
    }
  }
};

/// Lanes whose configuration is outside of the limits, or not a number.
inline LaneBits outside_limits(const FastRobotTables& robot, const float* q) {
  LaneBits inside = kAllLanes;
  for (int i = 0; i < robot.dof; ++i) {
    const Floats value = load(q + i * kFloats);
    inside &= less(splat(robot.joints[i].lower), value) & less(value, splat(robot.joints[i].upper));
  }
  return ~inside & kAllLanes;
}

/// Turns a point from frame 0 into another: into `turned`, where it has to be turned at all.
inline const Point& into_frame(const FastWorldTables& world, int frame, const Point& p,
                               Point& turned) {
  if (frame == 0) return p;
  const float* r = world.frames + 9 * frame;
  turned = {multiply_add(splat(r[0]), p.x, multiply_add(splat(r[1]), p.y, splat(r[2]) * p.z)),
            multiply_add(splat(r[3]), p.x, multiply_add(splat(r[4]), p.y, splat(r[5]) * p.z)),
            multiply_add(splat(r[6]), p.x, multiply_add(splat(r[7]), p.y, splat(r[8]) * p.z))};
  return turned;
}

/// From the nearest point of a box without its rounding, in its frame; its squared length.
inline Point gap_vector(const FastBox& box, const Point& p) {
  return {p.x - smaller(larger(p.x, splat(box.low[0])), splat(box.high[0])),
          p.y - smaller(larger(p.y, splat(box.low[1])), splat(box.high[1])),
          p.z - smaller(larger(p.z, splat(box.low[2])), splat(box.high[2]))};
}
inline Floats squared_gap(const FastBox& box, const Point& p) {
  return squared(gap_vector(box, p));
}

/// The same from a finite cylinder.
inline Floats squared_gap(const FastCylinder& cylinder, const Point& p) {
  const Floats d[3] = {p.x - cylinder.center[0], p.y - cylinder.center[1],
                       p.z - cylinder.center[2]};
  const int a = cylinder.axis;
  const Floats u = d[(a + 1) % 3], v = d[(a + 2) % 3], w = d[a];
  const Floats side = larger(square_root(multiply_add(u, u, v * v)) - cylinder.radius, Floats{});
  const Floats beyond = larger(larger(w, -w) - cylinder.half, Floats{});
  return multiply_add(side, side, beyond * beyond);
}

/// From its nearest point, as of a box.
inline Point gap_vector(const FastCylinder& cylinder, const Point& p) {
  Floats d[3] = {p.x - cylinder.center[0], p.y - cylinder.center[1], p.z - cylinder.center[2]};
  const int a = cylinder.axis;
  Floats &u = d[(a + 1) % 3], &v = d[(a + 2) % 3], &w = d[a];
  const Floats radial = square_root(multiply_add(u, u, v * v));
  const Floats share =
      larger(radial - cylinder.radius, Floats{}) / larger(radial, splat(cylinder.radius));
  u = u * share;
  v = v * share;
  w = w - smaller(larger(w, splat(-cylinder.half)), splat(cylinder.half));
  return {d[0], d[1], d[2]};
}

inline Floats dot(const float* a, const Point& b) {
  return multiply_add(splat(a[0]), b.x, multiply_add(splat(a[1]), b.y, splat(a[2]) * b.z));
}

/// Of a polytope the largest distance from a plane, squared.
inline Floats squared_gap(const FastPolytope& polytope, const Point& p) {
  Floats gap{};
  for (int i = 0; i < polytope.count; ++i) {
    gap = larger(gap, dot(polytope.planes[i].n, p) - polytope.planes[i].d);
  }
  return gap * gap;
}

inline void take_where(const Floats& shorter, const Floats& than, const Point& from, Point& to) {
  to.x = shorter < than ? from.x : to.x;
  to.y = shorter < than ? from.y : to.y;
  to.z = shorter < than ? from.z : to.z;
}

/// From the nearest point of a triangle: above it of its plane, else of an edge.
inline Point gap_vector(const FastTriangle& triangle, const Point& p) {
  Floats beside2 = splat(1e30F), beyond_side = splat(-1e30F);
  Point d, out;
  for (int i = 0; i < 3; ++i) {
    const float *corner = triangle.corner[i], *edge = triangle.edge[i];
    d = {p.x - corner[0], p.y - corner[1], p.z - corner[2]};
    const Floats t = smaller(larger(dot(edge, d) * triangle.per_length2[i], Floats{}), splat(1.0F));
    const Point off = {multiply_add(t, splat(-edge[0]), d.x), multiply_add(t, splat(-edge[1]), d.y),
                       multiply_add(t, splat(-edge[2]), d.z)};
    const Floats off2 = squared(off);
    take_where(off2, beside2, off, out);
    beside2 = smaller(beside2, off2);
    beyond_side = larger(beyond_side, dot(triangle.side[i], d));
  }
  const Floats height = dot(triangle.normal, d);
  const Floats least2 = beyond_side < triangle.slack ? height * height : splat(1e30F);
  take_where(
      least2, beside2,
      {height * triangle.normal[0], height * triangle.normal[1], height * triangle.normal[2]}, out);
  return out;
}

inline Floats squared_gap(const FastTriangle& triangle, const Point& p) {
  return squared(gap_vector(triangle, p));
}

/// From the plane that is farthest away.
inline Point gap_vector(const FastPolytope& polytope, const Point& p) {
  Floats gap{};
  Point n{};
  for (int i = 0; i < polytope.count; ++i) {
    const auto& plane = polytope.planes[i];
    const Floats from_plane = dot(plane.n, p) - plane.d;
    take_where(gap, from_plane, {splat(plane.n[0]), splat(plane.n[1]), splat(plane.n[2])}, n);
    gap = larger(gap, from_plane);
  }
  return {gap * n.x, gap * n.y, gap * n.z};
}

inline float rounding_of(const FastTriangle& triangle) { return triangle.round; }
inline float rounding_of(const FastPolytope&) { return 0; }
inline float rounding_of(const FastBox& box) { return box.round; }
inline float rounding_of(const FastCylinder&) { return 0; }

/// Whether the link of a sphere is not held against an obstacle.
inline bool is_ignored(const FastRobotTables& robot, const FastWorldTables& world, int sphere,
                       int obstacle) {
  if (world.ignored_words == 0) return false;
  const int link = robot.link_of_sphere[sphere];
  const std::uint64_t word = world.ignored[link * world.ignored_words + obstacle / 64];
  return ((word >> (obstacle % 64)) & 1) != 0;
}

/// Calls visit(solid) for a leaf of the tree of solids.
template <class Visit>
void visit_solid(const FastWorldTables& world, const FastItem& item, const Visit& visit) {
  switch (item.kind) {
    case FastKind::box:
      return visit(world.boxes[item.index]);
    case FastKind::cylinder:
      return visit(world.cylinders[item.index]);
    case FastKind::triangle:
      return visit(world.triangles[item.index]);
    case FastKind::polytope:
      return visit(world.polytopes[item.index]);
  }
}

}  // namespace MJARM_LANES
}  // namespace mjarm::detail
