#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/collision/fast_crowd_internal.hpp"
#include "mjarm/collision/mesh_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kSameTurn = 1e-7;          // [rad] two orientations that count as one
constexpr std::size_t kMaxCompared = 64;    // orientations that a new one is compared with
constexpr std::size_t kMaxListed = 64;      // solids; more go into a tree
constexpr int kMaxOfList = 64;              // of a list: bits of a word
constexpr std::size_t kMaxCubes = 400'000;  // that fill solid meshes
constexpr double kFloat = 0x1p-24;          // relative rounding error
constexpr double kEverywhere = 1e9;         // [m]

enum class Kind { box, round, cylinder };

/// A solid in the frame it was sorted into.
struct PlacedSolid {
  int id = 0;
  int frame = 0;
  Kind kind = Kind::box;
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = low;  // box without its rounding
  double round = 0;                                           // of a round; radius of a cylinder
  int axis = 2;                                               // of a cylinder
  bool endless = false;                                       // a half-space
  bool piece = false;                                         // of a solid of many
  double distance = 0;  // from where the robot stands: what is near is looked at first
  FastBox box;  // outwards of low and high; its rounding has what rounding does to its place

  /// From the nearest point, without its rounding; flat ends of a cylinder count as rounded.
  Eigen::Vector3d apart(const Eigen::Vector3d& p) const {
    return p - p.cwiseMax(low).cwiseMin(high);
  }
};

/// What a group can reach, seen from a frame.
struct Near {
  int frame = -1;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double max = 0;  // [m] boxes are cut down to this
};

/// Index of the entry of `v` that is 1 or -1 while the others vanish; -1 where there is none.
int lone_axis(const Eigen::Vector3d& v) {
  Eigen::Index largest = 0;
  v.cwiseAbs().maxCoeff(&largest);
  Eigen::Vector3d rest = v;
  rest[largest] = 0;
  return rest.norm() < kSameTurn ? static_cast<int>(largest) : -1;
}

static_assert(kMaxObstacles + kMaxPieces + kMaxCubes <= 1'000'000, "kFan^kFastLevels leaves");

class WorldBuilder {
 public:
  WorldBuilder(const FastRobotData& robot, const Obstacles& obstacles, FastWorld& out)
      : robot_(robot), ignored_(obstacles.ignored), out_(out) {
    std::sort(ignored_.begin(), ignored_.end());
    place(obstacles);
    move_largest_frame_first();
    std::sort(placed_.begin(), placed_.end(), [](const PlacedSolid& a, const PlacedSolid& b) {
      if (a.frame != b.frame) return a.frame < b.frame;
      if (a.kind != b.kind) return a.kind < b.kind;
      return a.distance < b.distance || (a.distance == b.distance && a.id < b.id);
    });
  }

  void build(const Obstacles& obstacles) {
    write_frames();
    const GroupBounds all = everyone();
    build_crowd(all, obstacles);
    out_.tables.every_list = add_lists(all, kMaxClearance, {});
    for (std::size_t g = 0; g < robot_.bounds.size(); ++g) {
      const bool moves = robot_.groups[g].body > 0;
      out_.lists_of_group.push_back(moves ? add_lists(robot_.bounds[g], 0, links_of(g))
                                          : FastRun{});
    }
    if (!ignored_.empty()) write_ignored(obstacles.solids.size());
  }

 private:
  void place(const Obstacles& obstacles) {
    std::vector<int> balls;
    for (std::size_t i = 0; i < obstacles.solids.size(); ++i) {
      const ObstacleShape& shape = obstacles.solids[i].shape;
      const int id = static_cast<int>(i);
      if (std::holds_alternative<BallShape>(shape)) {
        balls.push_back(id);
      } else if (std::holds_alternative<PolytopeShape>(shape) ||
                 std::holds_alternative<MeshShape>(shape)) {
        loose_.push_back(id);
      } else {
        place_solid(obstacles.solids[i], id);
      }
    }
    if (frames_.empty()) {
      frames_.push_back(Eigen::Matrix3d::Identity());
      used_.push_back(0);
    }
    main_ = static_cast<int>(std::max_element(used_.begin(), used_.end()) - used_.begin());
    for (const int i : balls) add_placed(obstacles.solids[static_cast<std::size_t>(i)], i, main_);
  }

  void place_solid(const Obstacle& solid, int id) {
    const int frame = frame_for(solid);
    if (const auto* field = std::get_if<HeightFieldShape>(&solid.shape)) {
      for_each_column(*field, [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
        const Pose X_WC = solid.X_WO * Pose{0.5 * (low + high), Eigen::Matrix3d::Identity()};
        add_placed({"", X_WC, BoxShape{0.5 * (high - low)}}, id, frame);
        placed_.back().piece = true;
      });
    } else {
      add_placed(solid, id, frame);
    }
  }

  void add_placed(const Obstacle& solid, int id, int frame) {
    PlacedSolid placed;
    placed.id = id;
    placed.frame = frame;
    fill(solid, placed);
    const Near near = near_in(robot_.bounds.front(), frame);
    placed.distance = std::max(placed.apart(near.middle).norm() - placed.round, 0.0);
    for (int k = 0; k < 3; ++k) {
      placed.box.low[k] = round_down(placed.low[k]);
      placed.box.high[k] = round_up(placed.high[k]);
    }
    if (placed.kind == Kind::round) {
      const double far = placed.low.norm() + placed.high.norm() + placed.round;
      placed.box.round = round_up(placed.round + 4 * kFloat * far);
    }
    placed_.push_back(placed);
    ++used_[static_cast<std::size_t>(frame)];
  }

  /// The frame whose axes a solid shares, a new one where there is none.
  int frame_for(const Obstacle& solid) {
    const bool box = std::holds_alternative<BoxShape>(solid.shape) ||
                     std::holds_alternative<HeightFieldShape>(solid.shape);
    for (std::size_t f = 0; f < std::min(frames_.size(), kMaxCompared); ++f) {
      const Eigen::Matrix3d R = frames_[f].transpose() * solid.X_WO.R;
      if (lone_axis(R.col(2)) >= 0 && (!box || lone_axis(R.col(0)) >= 0)) {
        return static_cast<int>(f);
      }
    }
    frames_.push_back(solid.X_WO.R);
    used_.push_back(0);
    return static_cast<int>(frames_.size()) - 1;
  }

  void fill(const Obstacle& solid, PlacedSolid& out) const {
    const Eigen::Matrix3d& F = frames_[static_cast<std::size_t>(out.frame)];
    const Eigen::Vector3d p = F.transpose() * solid.X_WO.p;
    const Eigen::Matrix3d R = F.transpose() * solid.X_WO.R;
    const auto span = [&](const Eigen::Vector3d& half) {
      out.low = p - half;
      out.high = p + half;
    };
    if (const auto* box = std::get_if<BoxShape>(&solid.shape)) {
      span(R.cwiseAbs() * box->half);  // what the axes differ by is covered as well
    } else if (const auto* ball = std::get_if<BallShape>(&solid.shape)) {
      span(Eigen::Vector3d::Zero());
      set_round(ball->radius, out);
    } else if (const auto* capsule = std::get_if<CapsuleShape>(&solid.shape)) {
      span(R.col(2).cwiseAbs() * capsule->half_length);
      set_round(capsule->radius, out);
    } else if (const auto* cylinder = std::get_if<CylinderShape>(&solid.shape)) {
      out.kind = Kind::cylinder;
      out.axis = lone_axis(R.col(2));
      const double leak = kSameTurn * (cylinder->radius + cylinder->half_length);
      span(Eigen::Vector3d::Unit(out.axis) * (cylinder->half_length + leak));
      out.round = cylinder->radius + leak;
    } else {
      span(Eigen::Vector3d::Constant(kEverywhere));
      const int axis = lone_axis(R.col(2));
      (R(axis, 2) > 0 ? out.high : out.low)[axis] = p[axis];
      out.endless = true;
    }
  }

  static void set_round(double radius, PlacedSolid& out) {
    out.kind = Kind::round;
    out.round = radius;
  }

  /// Frame 0 costs no turning.
  void move_largest_frame_first() {
    std::swap(frames_[0], frames_[static_cast<std::size_t>(main_)]);
    for (PlacedSolid& placed : placed_) {
      placed.frame = placed.frame == main_ ? 0 : placed.frame == 0 ? main_ : placed.frame;
    }
  }

  void write_frames() {
    const Eigen::Matrix3d& F = frames_[0];
    Eigen::Map<Eigen::Matrix3f>(out_.tables.base) = (F.transpose() * robot_.R_WB).cast<float>();
    out_.frames.resize(9 * frames_.size());
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      const Eigen::Matrix3f R = (frames_[f].transpose() * F).cast<float>();
      Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(out_.frames.data() + 9 * f) = R;
    }
  }

  /// Bounds that hold for every group.
  GroupBounds everyone() const {
    GroupBounds out = robot_.bounds.front();
    for (std::size_t g = 0; g < robot_.bounds.size(); ++g) {
      if (robot_.groups[g].body == 0) continue;
      const GroupBounds& bounds = robot_.bounds[g];
      const double apart = (bounds.reach_center_W - out.reach_center_W).norm();
      out.reach = std::max(out.reach, apart + bounds.reach);
    }
    return out;
  }

  /// What is in lists stays in placed_.
  void build_crowd(const GroupBounds& all, const Obstacles& obstacles) {
    const bool is_crowd = placed_.size() > kMaxListed;
    if (!is_crowd && loose_.empty() && obstacles.clouds.empty()) return;
    const CrowdSpace space{frames_, frames_[0].transpose() * all.reach_center_W, all.reach,
                           least_radius(), kMaxCubes / std::max<std::size_t>(loose_.size(), 1)};
    CrowdBuilder crowd(space, out_);
    std::erase_if(placed_, [&](const PlacedSolid& placed) {
      if (!(is_crowd || placed.piece) || placed.endless) return false;
      crowd.add(add_item(all, placed));
      return true;
    });
    for (const int i : loose_) crowd.add(obstacles.solids[static_cast<std::size_t>(i)], i);
    crowd.build(obstacles.clouds, static_cast<int>(obstacles.solids.size()));
  }

  double least_radius() const {
    double least = kEverywhere;
    for (const LinkSpheres& link : robot_.set.links) {
      if (link.joint < 0) continue;
      for (const Sphere& sphere : link.spheres) least = std::min(least, sphere.radius);
    }
    return least;
  }

  FastItem add_item(const GroupBounds& all, const PlacedSolid& placed) {
    if (placed.kind == Kind::cylinder) {
      add_cylinder(placed);
      const int index = static_cast<int>(out_.cylinders.size()) - 1;
      return {FastKind::cylinder, placed.frame, index, placed.id};
    }
    add_box(near_in(all, placed.frame), placed);
    return {FastKind::box, placed.frame, static_cast<int>(out_.boxes.size()) - 1, placed.id};
  }

  /// Links of a group, by index into the sphere set; left empty where nothing is ignored.
  std::vector<int> links_of(std::size_t g) const {
    if (ignored_.empty()) return {};
    const FastGroup& group = robot_.groups[g];
    const auto first = robot_.link_of_sphere.begin() + group.first;
    std::vector<int> out(first, first + group.count);
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

  /// Whether all of some links are not held against an obstacle.
  bool ignored_by_all(std::span<const int> links, int obstacle) const {
    return !links.empty() && std::all_of(links.begin(), links.end(), [&](int link) {
      return std::binary_search(ignored_.begin(), ignored_.end(), IgnoredPair{link, obstacle});
    });
  }

  void write_ignored(std::size_t solids) {
    const std::size_t words = solids / 64 + 1;
    out_.ignored.assign(words * robot_.set.links.size(), 0);
    for (const IgnoredPair& pair : ignored_) {
      const auto link = static_cast<std::size_t>(pair.link);
      const auto solid = static_cast<std::size_t>(pair.obstacle);
      out_.ignored[link * words + solid / 64] |= std::uint64_t{1} << (solid % 64);
    }
    out_.tables.ignored_words = static_cast<int>(words);
  }

  /// What all of `links` ignore is left out.
  FastRun add_lists(const GroupBounds& bounds, double margin, const std::vector<int>& links) {
    const int first = static_cast<int>(out_.lists.size());
    Near near;
    for (const PlacedSolid& placed : placed_) {
      if (ignored_by_all(links, placed.id)) continue;
      if (placed.frame != near.frame) near = near_in(bounds, placed.frame);
      const double max = bounds.reach + margin + 1e-4 + placed.round;
      if (placed.apart(near.middle).squaredNorm() > max * max) continue;
      const int lists = static_cast<int>(out_.lists.size());
      if (lists == first || out_.lists.back().frame != placed.frame ||
          out_.lists.back().boxes.count == kMaxOfList) {
        start_list(placed.frame);
      }
      add(near, placed);
    }
    return {first, static_cast<int>(out_.lists.size()) - first};
  }

  Near near_in(const GroupBounds& bounds, int frame) const {
    return {frame, frames_[static_cast<std::size_t>(frame)].transpose() * bounds.reach_center_W,
            bounds.reach + 2 * kMaxClearance};
  }

  void start_list(int frame) {
    const FastRun boxes{static_cast<int>(out_.boxes.size()), 0};
    const FastRun cylinders{static_cast<int>(out_.cylinders.size()), 0};
    out_.lists.push_back({frame, boxes, boxes, cylinders});
  }

  void add(const Near& near, const PlacedSolid& placed) {
    FastList& list = out_.lists.back();
    if (placed.kind == Kind::cylinder) {
      add_cylinder(placed);
      ++list.cylinders.count;
      return;
    }
    add_box(near, placed);
    if (placed.kind == Kind::box) {
      ++list.boxes.count;
      ++list.rounds.first;
    } else {
      ++list.rounds.count;
    }
  }

  /// Plain boxes are cut down to what is within reach, where floats are fine enough.
  void add_box(const Near& near, const PlacedSolid& placed) {
    FastBox box = placed.box;
    for (int k = 0; k < 3 && placed.kind == Kind::box; ++k) {
      const double low = near.middle[k] - near.max, high = near.middle[k] + near.max;
      if (placed.low[k] < low) box.low[k] = round_down(low);
      if (placed.high[k] > high) box.high[k] = round_up(high);
    }
    out_.boxes.push_back(box);
    out_.box_ids.push_back(placed.id);
  }

  void add_cylinder(const PlacedSolid& placed) {
    const Eigen::Vector3d center = 0.5 * (placed.low + placed.high);
    const double half = 0.5 * (placed.high - placed.low)[placed.axis];
    const double leak = 8 * kFloat * (center.norm() + half + placed.round);
    FastCylinder out;
    for (int k = 0; k < 3; ++k) out.center[k] = static_cast<float>(center[k]);
    out.radius = round_up(placed.round + leak);
    out.half = round_up(half + leak);
    out.axis = placed.axis;
    out_.cylinders.push_back(out);
    out_.cylinder_ids.push_back(placed.id);
  }

  const FastRobotData& robot_;
  std::vector<IgnoredPair> ignored_;
  std::vector<Eigen::Matrix3d> frames_;  // R_WF
  std::vector<int> used_;                // solids of each frame
  int main_ = 0;                         // the frame that most solids share
  std::vector<PlacedSolid> placed_;
  std::vector<int> loose_;  // solids that need no frame of their own
  FastWorld& out_;
};

}  // namespace

FastWorld::FastWorld(const FastRobotData& robot, const Obstacles& obstacles) {
  WorldBuilder(robot, obstacles, *this).build(obstacles);
  tables.frames = frames.data();
  tables.lists = lists.data();
  tables.lists_of_group = lists_of_group.data();
  tables.ignored = ignored.data();
  tables.boxes = boxes.data();
  tables.cylinders = cylinders.data();
  tables.box_ids = box_ids.data();
  tables.cylinder_ids = cylinder_ids.data();
  tables.grid = grid.tables();
  tables.crowd = crowd.tables();
  tables.items = items.data();
  tables.triangles = triangles.data();
  for (FastPolytope& polytope : polytopes) polytope.planes = planes.data() + polytope.first;
  tables.polytopes = polytopes.data();
  tables.clouds = clouds.tables();
  tables.points = points.data();
  tables.point_ids = point_ids.data();
}

}  // namespace mjarm::detail
