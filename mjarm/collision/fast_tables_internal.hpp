#pragma once

#include <cstddef>
#include <cstdint>

/// What the kernels of the fast checker read: a robot and its world as flat arrays of floats.
/// Radii carry the padding that makes up for single precision (see fast_bounds.cpp), so that what
/// is called free is free. Plain memory only: this is compiled for several widths of registers, and
/// no inline function of a library may come from the wrong one.
namespace mjarm::detail {

inline constexpr int kFastJoints = 16;  ///< most joints (kMaxDof)
inline constexpr int kFastGroups = kFastJoints + 1;
inline constexpr int kFastSpheres = 512;  ///< most spheres (kMaxSpheres)
/// Most pairs of groups, each with itself included.
inline constexpr int kFastPairs = kFastGroups * (kFastGroups + 1) / 2;

/// How the frame of a joint is tilted about x against the one before, by 0 to pi. A quarter turn
/// only swaps axes.
enum class Tilt { none, quarter, any };

/// T(t) Rx(tilt) Rz(offset + q), or T(t) Rx(tilt) Rz(offset) Tz(q) for a slide.
struct FastJoint {
  float t[3] = {0, 0, 0};
  Tilt tilt = Tilt::none;
  float tilt_cos = 1, tilt_sin = 0;
  float offset = 0;
  bool slide = false;
  float lower = 0, upper = 0;  ///< open bounds, a little outside of the limits
};

struct FastSphere {
  float x = 0, y = 0, z = 0;  ///< in the frame of its body
  float radius = 0;
};

/// A run of entries of one kind: [first, first + count).
struct FastRun {
  int first = 0, count = 0;
};

/// Some spheres of a group that are near each other.
struct FastPart {
  int first = 0, count = 0;  ///< of the spheres
  FastSphere ball;           ///< contains them
};

/// The spheres of all links that one joint moves. Bodies are counted from 1; body 0 is what stands
/// still.
struct FastGroup {
  int body = 0;
  int first = 0, count = 0;  ///< of the spheres
  FastRun parts;             ///< that the spheres are in, in the same order
  FastSphere ball;           ///< contains them all
  float spread = 0;          ///< [m] farthest centre of a sphere from that of the ball
};

/// Two spheres that must not overlap.
struct FastPartners {
  int a = 0, b = 0;
  float reach = 0;         ///< [m] sum of both radii
  float minus_reach2 = 0;  ///< [m^2] minus its square
};

/// A part of a group against one of another.
struct FastPartPair {
  int a = 0, b = 0;
  float reach = 0;           ///< [m] sum of the radii of both balls
  int first = 0, count = 0;  ///< of the partners
};

/// A part of a group against all of another.
struct FastRow {
  int part = 0;
  float reach = 0;           ///< [m] sum of the radii of both balls
  int first = 0, count = 0;  ///< of the pairs of parts
};

/// How far two groups keep apart at least, or that they overlap, by the values of the one or two
/// joints between them.
struct FastApart {
  int side = 0;           ///< cells along a joint
  int joint[2] = {0, 0};  ///< the second varies slowest; twice the same where there is only one
  float low[2] = {0, 0};  ///< [rad or m] the least value
  float per_unit[2] = {0, 0};           ///< cells a rad or m; 0: that joint is not looked at
  float unit = 0;                       ///< [m] of the numbers in the cells
  int first = 0;                        ///< of the cells among those of all tables
  const std::uint8_t* cells = nullptr;  ///< 0: they overlap everywhere in it; else units + 1
};

/// Two groups with links that must not overlap; `b` is farther from the base.
struct FastPair {
  int a = 0, b = 0;          ///< groups
  int first = 0, count = 0;  ///< of the rows
  float reach = 0;           ///< [m] sum of the radii of both balls
  int apart = -1;            ///< table of how far they keep apart, -1: none
};

/// A robot, whatever stands round it.
struct FastRobotTables {
  int dof = 0;
  FastJoint joints[kFastJoints];
  int group_count = 0;
  int part_count = 0;
  int pair_count = 0;
  int every_pair_count = 0;
  const FastGroup* groups = nullptr;  ///< farthest body first
  const FastPart* parts = nullptr;
  const FastSphere* spheres = nullptr;
  const int* link_of_sphere = nullptr;   ///< index into the sphere set
  const FastPair* pairs = nullptr;       ///< without spheres that are proved never to meet
  const FastPair* every_pair = nullptr;  ///< with all spheres, for distances
  const FastApart* apart = nullptr;
  const FastRow* rows = nullptr;
  const FastPartPair* part_pairs = nullptr;
  const FastPartners* partners = nullptr;
};

/// A box, or what a radius put round it makes: a ball has no extent, a capsule one. Bounds in the
/// frame it belongs to.
struct FastBox {
  float low[3], high[3];
  float round = 0;  ///< [m] radius round it
};

/// A finite cylinder along axis `axis` of its frame.
struct FastCylinder {
  float center[3];
  float radius = 0, half = 0;
  int axis = 2;
};

/// What a group can meet, of one orientation.
struct FastList {
  int frame = 0;
  FastRun boxes, rounds, cylinders;  ///< boxes (at most 64) and rounds are in `boxes` of the world
};

/// How many children a node of a tree has, and how many levels of nodes there are at most.
inline constexpr int kFan = 16;
inline constexpr int kFastLevels = 5;

/// Boxes round the children of a node, in frame 0; those that are not there are far away.
struct FastNode {
  float low[3][kFan], high[3][kFan];
};

/// Boxes round boxes: child c of node i of a level is node kFan * i + c of the level below it, or,
/// at level 0, that leaf.
struct FastTree {
  int levels = 0;  ///< of nodes, the highest of which has one; 0: nothing is there
  const FastNode* nodes[kFastLevels] = {};
};

/// A triangle without thickness, in frame 0.
struct FastTriangle {
  float corner[3][3];
  float edge[3][3];      ///< from a corner to the next
  float per_length2[3];  ///< [1/m^2] one over the squared length of an edge; 0: it has none
  float side[3][3];      ///< across an edge, outwards, in the plane; length 1
  float normal[3];       ///< length 1
  float slack = 0;       ///< [m] as far beyond its sides a place still counts as above it
  float round = 0;       ///< [m] radius round it
};

/// n . p <= d.
struct FastPlane {
  float n[3];
  float d;
};

/// What is below all of its planes, in frame 0.
struct FastPolytope {
  int first = 0, count = 0;  ///< of the planes
  const FastPlane* planes = nullptr;
};

enum class FastKind { box, cylinder, triangle, polytope };

/// A solid as a leaf of a tree.
struct FastItem {
  FastKind kind = FastKind::box;
  int frame = 0;
  int index = 0;  ///< among those of its kind
  int id = 0;     ///< which obstacle it is
};

/// Balls round points, in frame 0, as a leaf of a tree; those that are not there are far away.
struct FastPoints {
  float center[3][kFan];
  float radius[kFan];
};

/// A coarse grid of lower bounds of the distance to whatever stands in trees, in frame 0.
struct FastGrid {
  const std::uint8_t* cells = nullptr;  ///< (side, side, side), z slowest; none: nothing is there
  int side = 0;
  float low[3] = {0, 0, 0};  ///< [m] its corner
  float per_meter = 0;       ///< cells
  float unit = 0;            ///< [m] of the numbers in the cells
  float slack = 0;           ///< [m] by which they may be too large
};

/// What stands round the robot. Everything is seen from frame 0, the orientation most solids share:
/// the base is turned into it, so that these solids need no turning at all.
struct FastWorldTables {
  float base[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< columns: axes before the first joint
  const float* frames = nullptr;                ///< 9 a frame, by rows: into that frame
  const FastList* lists = nullptr;
  const FastRun* lists_of_group = nullptr;
  FastRun every_list;  ///< for distances: what is within 1 m of the reach of any group
  /// Obstacles that a link is not held against: a bit for each, link by link. No words: none is.
  const std::uint64_t* ignored = nullptr;
  int ignored_words = 0;  ///< of a link
  const FastBox* boxes = nullptr;
  const FastCylinder* cylinders = nullptr;
  const int* box_ids = nullptr;  ///< which obstacle each of them is
  const int* cylinder_ids = nullptr;
  FastGrid grid;
  FastTree crowd;  ///< of the solids, where they are too many for lists
  const FastItem* items = nullptr;
  const FastTriangle* triangles = nullptr;
  const FastPolytope* polytopes = nullptr;
  FastTree clouds;  ///< of all points
  const FastPoints* points = nullptr;
  const int* point_ids = nullptr;  ///< which obstacle each point is, kFan a leaf
};

/// How the configurations of one edge move: q(t) = q0 + t dq, with what bounds the second
/// derivative, for each group.
struct FastMotion {
  const double *start, *way;  ///< (dof,) q0 and dq
  const float* dq;            ///< (dof,)
  const float* rate;          ///< (groups,) [m] fastest motion, wherever they are
  const float* bend;          ///< (groups,) [m] half of the largest second derivative
  const float* pair_rate;     ///< (pairs,) [m] fastest approach of the two links, wherever they are
  const float* pair_bend;     ///< (pairs,) bend of the farther link as seen from the other
};

/// [m] what rounding may hide of a speed, by the fastest motion of the group; two twists are each
/// rounded.
inline constexpr float kHiddenSpeed = 1e-5F;

/// How fast the joints of an edge move: |dq|, and how much each bends what it moves.
struct FastRates {
  int dof;
  const float *rate, *turn;  ///< (dof,)
  const float* before;       ///< (dof + 1,) rates of all joints before, summed
};

/// How far groups, or of pairs the farther group, are from the axes of joints.
struct FastLevers {
  int stride;           ///< whole registers
  const float* levers;  ///< (dof, stride) [m], 0 for joints that do not count
  const int* from;      ///< (stride,) the first joint that counts
};

struct FastVerdict {
  std::uint32_t hit = 0;      ///< lanes that may be in collision
  std::uint32_t blocked = 0;  ///< lanes whose interval is not proved (cover() only)
};

/// What clearances() found for a lane: sphere -1 where nothing is nearer than the bound.
struct FastNearest {
  float distance = 0;
  int sphere = -1;    ///< index into the spheres
  int obstacle = -1;  ///< index of the obstacle, -1: another sphere
  int other = -1;     ///< that sphere
};

/// Configurations row by row; lanes without one repeat the last.
struct FastRows {
  const double* q;  ///< (count, dof)
  int count;        ///< 1 to width
};

/// The kernels of one level of SIMD.
struct FastKernels {
  int width;
  /// Lanes with a row that may be in collision or are outside of the limits; with `any` the first
  /// found end the search.
  std::uint32_t (*collide)(const FastRobotTables&, const FastWorldTables&, const FastRows& rows,
                           bool any);
  /// Looks at intervals t[lane] +- half[lane] of an edge. With `any` it ends with the first hit.
  FastVerdict (*cover)(const FastRobotTables&, const FastWorldTables&, std::uint32_t active,
                       const FastMotion& motion, const float* t, const float* half, bool any);
  /// Bounds of speeds and of half of the second derivatives along the edge, (stride,) each. A point
  /// moves by at most (lever * rate), summed over the joints; each joint also turns what those
  /// after it do. What the joints before the first that counts do moves both links of a pair alike.
  void (*bound_motion)(const FastRates&, const FastLevers&, float* speed, float* bend);
  /// Lower bounds of the distance, up to `max`; with `together` only of the lane where it is
  /// least.
  void (*clearances)(const FastRobotTables&, const FastWorldTables&, const float* q, float max,
                     bool together, FastNearest* out);
};
extern const FastKernels kFastBaseline;
#if defined(__x86_64__)
extern const FastKernels kFastAvx2;
extern const FastKernels kFastAvx512;
#endif

}  // namespace mjarm::detail
