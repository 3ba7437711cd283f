#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "mjarm/collision/fast_robot_internal.hpp"

/// How far two groups with at most two joints between them keep apart, as a table over the values
/// of these joints: most values are far from any overlap or well within one, and looking that up
/// costs less than tests of spheres. Within a box of joint values a distance differs from that in
/// the middle by at most (lever * half width), summed over the joints.
namespace mjarm::detail {
namespace {

constexpr int kLeastPartPairs = 4;       // fewer are looked at as fast
constexpr int kMaxApartTests = 200'000;  // of spheres, to make a table
constexpr int kLeastApartBoxes = 300;    // fewer say too little
constexpr int kApartSide = 64;           // cells along one joint
constexpr int kApartLevels = 7;          // sizes of boxes, from one cell to all
constexpr double kApartPlenty = 0.05;    // [m] as far apart is not looked at more closely
constexpr double kApartUnit = 1e-3;      // [m] of the numbers in the cells
// Which cell a value is in is decided in single precision: cells reach a little farther, and
// distances count a little less.
constexpr double kApartWiden = 1.01, kApartSpare = 2e-5;  // [m]

/// A joint on its way from body to body: first where its frame is, then its motion.
Pose joint_frame(const Link& link) {
  Eigen::Matrix3d R_tilt = Eigen::Matrix3d::Identity();
  R_tilt.bottomRightCorner<2, 2>() << link.tilt_cos, -link.tilt_sin, link.tilt_sin, link.tilt_cos;
  return {{link.t[0], link.t[1], link.t[2]}, R_tilt};
}
Pose joint_motion(const Link& link, double q) {
  const Eigen::AngleAxisd turn(link.offset + (link.slide ? 0 : q), Eigen::Vector3d::UnitZ());
  return {{0, 0, link.slide ? q : 0}, turn.toRotationMatrix()};
}

class ApartBuilder {
 public:
  ApartBuilder(const FastRobotData& data, const LinkChain& chain, const FastPair& pair)
      : data_(data), chain_(chain), from_(body(pair.a)), to_(body(pair.b)) {
    for (int r = pair.first; r < pair.first + pair.count; ++r) {
      const FastRow& row = data.rows[static_cast<std::size_t>(r)];
      part_pairs_ += row.count;
      for (int i = row.first; i < row.first + row.count; ++i) {
        const FastPartPair& parts = data.part_pairs[static_cast<std::size_t>(i)];
        for (int j = parts.first; j < parts.first + parts.count; ++j) {
          partners_.push_back(data.partners[static_cast<std::size_t>(j)]);
        }
      }
    }
    std::ranges::stable_sort(partners_, {}, &FastPartners::b);
  }

  /// Writes the cells behind the others; no side: a table does not pay.
  FastApart build(std::vector<std::uint8_t>& cells) {
    FastApart out;
    const int joints = to_ - from_;
    if (joints < 1 || joints > 2 || part_pairs_ < kLeastPartPairs) return out;
    const int max = kMaxApartTests / static_cast<int>(partners_.size());
    if (max < kLeastApartBoxes) return out;
    out.side = kApartSide;
    out.unit = static_cast<float>(kApartUnit);
    out.first = static_cast<int>(cells.size());
    for (int k = 0; k < joints; ++k) set_axis(k, out);
    rows_ = joints == 2 ? kApartSide : 1;
    set_spheres();
    cells.resize(cells.size() + static_cast<std::size_t>(kApartSide * rows_));
    fill(max, &cells[static_cast<std::size_t>(out.first)]);
    return out;
  }

 private:
  /// Values of a joint: the ends and middles of cells, which are the middles of boxes.
  static constexpr int kStations = 2 * kApartSide + 1;
  struct Axis {
    double low = 0, width = 0;          // of a cell
    std::array<Pose, kStations> poses;  // after the first joint; of the second its motion alone
  };

  /// A sphere of group b and those of group a it must not meet.
  struct FarSphere {
    Eigen::Vector3d center;                  // in its body
    std::size_t first = 0, last = 0;         // of the partners
    std::array<double, kApartLevels> slack;  // [m] by the size of boxes
  };

  /// Cells [i, i + size) along the first joint, [j, ...) along the second.
  struct Box {
    int i, j, size;
  };

  /// Cuts boxes of cells in halves along each joint, the large ones first, until what they say
  /// is enough or `max` have been looked at.
  void fill(int max, std::uint8_t* cells) const {
    std::vector<Box> boxes = {{0, 0, kApartSide}};
    for (std::size_t next = 0; next < boxes.size() && next < static_cast<std::size_t>(max);
         ++next) {
      const Box box = boxes[next];
      const Finding found = look(box);
      const int high = std::min(box.size, rows_);
      for (int j = box.j; j < box.j + high; ++j) {
        std::fill_n(cells + j * kApartSide + box.i, box.size, code(found));
      }
      if (found.overlap || found.apart > kApartPlenty || box.size == 1) continue;
      const int half = box.size / 2;
      for (int j = 0; j < high; j += half) {
        for (int i = 0; i < box.size; i += half) boxes.push_back({box.i + i, box.j + j, half});
      }
    }
  }

  int body(int g) const { return data_.groups[static_cast<std::size_t>(g)].body; }
  void set_axis(int k, FastApart& out) {
    const FastLimits limits = fast_limits(data_.arm, from_ + k);
    Axis& axis = axes_[static_cast<std::size_t>(k)];
    axis.low = limits.lower;
    axis.width = (limits.upper - limits.lower) / out.side;
    out.joint[k] = from_ + k;
    out.low[k] = static_cast<float>(limits.lower);
    out.per_unit[k] = axis.width > 0 ? static_cast<float>(1 / axis.width) : 0;
    const Link& link = chain_.links[from_ + k];
    for (int i = 0; i < kStations; ++i) {
      Pose& X = axis.poses[static_cast<std::size_t>(i)];
      X = joint_motion(link, axis.low + 0.5 * i * axis.width);
      if (k == 0) X = joint_frame(link) * X;
      if (from_ + k + 1 < to_) X = X * joint_frame(chain_.links[from_ + k + 1]);
    }
  }

  void set_spheres() {
    for (std::size_t k = 0; k < partners_.size(); ++k) {
      const int sphere = partners_[k].b;
      if (k == 0 || partners_[k - 1].b != sphere) {
        const FastSphere& b = data_.spheres[static_cast<std::size_t>(sphere)];
        FarSphere& fresh = spheres_.emplace_back(FarSphere{{b.x, b.y, b.z}, k, k, {}});
        for (int level = 0; level < kApartLevels; ++level) {
          fresh.slack[static_cast<std::size_t>(level)] = slack(sphere, 1 << level);
        }
      }
      spheres_.back().last = k + 1;
    }
  }

  /// [m] by how much the distance of a sphere can differ elsewhere in a box of so many cells.
  double slack(int sphere, int size) const {
    double out = kApartSpare;
    for (int k = from_; k < to_; ++k) {
      const double width = size * axes_[static_cast<std::size_t>(k - from_)].width;
      out += (0.5 * kApartWiden * width + kApartSpare) *
             data_.levers_of_sphere[static_cast<std::size_t>(sphere)][static_cast<std::size_t>(k)];
    }
    return out;
  }

  /// What is true everywhere in a box.
  struct Finding {
    double apart;  ///< [m] at least
    bool overlap;
  };

  /// Group b seen from group a in the middle of a box.
  [[nodiscard]] Pose middle(const Box& box) const {
    const Pose& first = axes_[0].poses[static_cast<std::size_t>(2 * box.i + box.size)];
    if (rows_ == 1) return first;
    return first * axes_[1].poses[static_cast<std::size_t>(2 * box.j + box.size)];
  }

  Finding look(const Box& box) const {
    const Pose X_AB = middle(box);
    const auto level = static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(box.size)));
    Finding out{std::numeric_limits<double>::infinity(), false};
    for (const FarSphere& sphere : spheres_) {
      const Eigen::Vector3d way = X_AB * sphere.center;
      const double spare = sphere.slack[level];
      for (std::size_t k = sphere.first; k < sphere.last; ++k) {
        const FastSphere& a = data_.spheres[static_cast<std::size_t>(partners_[k].a)];
        const double gap = (way - Eigen::Vector3d(a.x, a.y, a.z)).norm() - partners_[k].reach;
        if (gap + spare < 0) return {gap - spare, true};
        out.apart = std::min(out.apart, gap - spare);
      }
    }
    return out;
  }

  static std::uint8_t code(const Finding& found) {
    if (found.overlap) return 0;
    const double units = std::floor(std::max(found.apart / kApartUnit, 0.0));
    return static_cast<std::uint8_t>(1 + std::min(units, 254.0));
  }

  const FastRobotData& data_;
  const LinkChain& chain_;
  int from_, to_;
  int part_pairs_ = 0;
  int rows_ = 1;                        // of cells: along the second joint
  std::vector<FastPartners> partners_;  // those of a sphere of group b side by side
  std::vector<FarSphere> spheres_;
  std::array<Axis, 2> axes_;
};

}  // namespace

void add_apart(FastRobotData& data, const LinkChain& chain) {
  for (FastPair& pair : data.pairs) {
    const FastApart table = ApartBuilder(data, chain, pair).build(data.apart_cells);
    if (table.side == 0) continue;
    pair.apart = static_cast<int>(data.apart.size());
    data.apart.push_back(table);
  }
  data.apart_cells.resize(data.apart_cells.size() + 3);  // gather() reads whole words
}

}  // namespace mjarm::detail
