#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "mjarm/collision/fast_robot_internal.hpp"

/// Which spheres of two links can meet at all. With few joints between the links this is decided by
/// a proof: over a box of joint values the distance changes by at most (lever * half width), summed
/// over the joints, so a box is cut until it is clear, or its middle shows an overlap.
namespace mjarm::detail {
namespace {

constexpr int kMaxProved = 3;    // joints between two links; for more the search is too large
constexpr int kMaxBoxes = 1000;  // of one search,
constexpr int kFewBoxes = 100;   // where there are margins: such a robot is made for a few searches
constexpr double kNeverMeet = 1e-5;  // [m] by which spheres that never meet keep apart at least

using Joints = std::array<double, kMaxProved>;

/// Sines and cosines, those asked for lately at hand: searches of one pair of bodies cut the same
/// boxes again and again.
class Turns {
 public:
  struct Turn {
    double angle = std::numeric_limits<double>::quiet_NaN(), c = 0, s = 0;
  };
  const Turn& operator()(double angle) {
    Turn& turn = kept_[(std::bit_cast<std::uint64_t>(angle) * 0x9E3779B97F4A7C15U) >> 56U];
    if (turn.angle != angle) turn = {angle, std::cos(angle), std::sin(angle)};
    return turn;
  }

 private:
  std::array<Turn, 256> kept_;
};

class MeetingSearch {
 public:
  MeetingSearch(const FastRobotData& data, const LinkChain& chain, int a, int b)
      : chain_(chain), a_(a), b_(b) {
    const Arm& arm = data.arm;
    if (data.margins.obstacles > 0 || data.margins.links > 0) max_boxes_ = kFewBoxes;
    for (int k = a; k < b && k < a + kMaxProved; ++k) {
      const auto i = static_cast<std::size_t>(k - a);
      const FastLimits limits = fast_limits(arm, k);
      middle_[i] = 0.5 * (limits.upper + limits.lower);
      half_[i] = 0.5 * (limits.upper - limits.lower);
    }
  }

  /// False where no joint values bring the centres as near to each other as `reach`.
  /// `levers` are those of the one on body b.
  bool may_meet(const Eigen::Vector3d& center_a, const Eigen::Vector3d& center_b,
                const std::array<double, kMaxDof>& levers, double reach) {
    if (b_ - a_ > kMaxProved) return true;
    for (int k = a_; k < b_; ++k) {
      levers_[static_cast<std::size_t>(k - a_)] = levers[static_cast<std::size_t>(k)] + 1e-6;
    }
    boxes_ = 0;
    return search(center_a, center_b, reach + kNeverMeet, middle_, half_);
  }

 private:
  bool search(const Eigen::Vector3d& center_a, const Eigen::Vector3d& center_b, double reach,
              const Joints& middle, const Joints& half) {
    if (++boxes_ > max_boxes_) return true;
    const double gap = (place(center_b, middle) - center_a).norm() - reach;
    if (gap <= 0) return true;
    double slack = 0;
    std::size_t widest = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(b_ - a_); ++i) {
      slack += levers_[i] * half[i];
      if (levers_[i] * half[i] > levers_[widest] * half[widest]) widest = i;
    }
    if (gap > slack) return false;
    Joints child_half = half;
    child_half[widest] *= 0.5;
    for (const double side : {-1.0, 1.0}) {
      Joints child = middle;
      child[widest] += side * child_half[widest];
      if (search(center_a, center_b, reach, child, child_half)) return true;
    }
    return false;
  }

  /// A point of body b, seen from body a.
  Eigen::Vector3d place(Eigen::Vector3d p, const Joints& q) {
    for (int k = b_ - 1; k >= a_; --k) {
      const Link& link = chain_.links[k];
      const double value = q[static_cast<std::size_t>(k - a_)];
      const auto [angle, c, s] = turns_(link.offset + (link.slide ? 0 : value));
      const double x = c * p.x() - s * p.y();
      const double y = s * p.x() + c * p.y();
      const double z = p.z() + (link.slide ? value : 0);
      p = {link.t[0] + x, link.t[1] + link.tilt_cos * y - link.tilt_sin * z,
           link.t[2] + link.tilt_sin * y + link.tilt_cos * z};
    }
    return p;
  }

  const LinkChain& chain_;
  int a_, b_;
  Joints middle_{}, half_{}, levers_{};
  int boxes_ = 0;
  int max_boxes_ = kMaxBoxes;
  Turns turns_;
};

Eigen::Vector3d center_of(const FastSphere& sphere) { return {sphere.x, sphere.y, sphere.z}; }

/// Links that must not overlap, both ways round, by their indices.
class LinkPairs {
 public:
  explicit LinkPairs(const SphereSet& set)
      : count_(set.links.size()), paired_(count_ * count_, false) {
    for (const auto& [a, b] : set.pairs) paired_[at(a, b)] = paired_[at(b, a)] = true;
  }
  bool has(int a, int b) const { return paired_[at(a, b)]; }

 private:
  std::size_t at(int a, int b) const {
    return static_cast<std::size_t>(a) * count_ + static_cast<std::size_t>(b);
  }
  std::size_t count_;
  std::vector<bool> paired_;
};

/// [m] by how much two radii, which have the margin from obstacles in them, are too much for links.
double surplus(const FastRobotData& data) {
  return 2 * data.margins.obstacles - data.margins.links;
}

/// How near two spheres, or balls round some, come until their links are too near.
float reach_of(const FastRobotData& data, const FastSphere& a, const FastSphere& b) {
  return round_up(static_cast<double>(a.radius) + b.radius - surplus(data));
}

/// The spheres of two parts that `meets` keeps; without any the parts are left out.
template <class Meets>
void add_part_pair(FastRobotData& data, FastRow& row, int a, int b, const Meets& meets) {
  const FastPart& from = data.parts[static_cast<std::size_t>(a)];
  const FastPart& to = data.parts[static_cast<std::size_t>(b)];
  const int first = static_cast<int>(data.partners.size());
  for (int i = from.first; i < from.first + from.count; ++i) {
    for (int j = to.first; j < to.first + to.count; ++j) {
      if (!meets(i, j)) continue;
      const float reach = reach_of(data, data.spheres[static_cast<std::size_t>(i)],
                                   data.spheres[static_cast<std::size_t>(j)]);
      data.partners.push_back({i, j, reach, -round_up(static_cast<double>(reach) * reach)});
    }
  }
  const int count = static_cast<int>(data.partners.size()) - first;
  if (count == 0) return;
  data.part_pairs.push_back({a, b, reach_of(data, from.ball, to.ball), first, count});
  ++row.count;
}

/// The pair of groups a and b; without any spheres it is left out.
template <class Meets>
void add_pair(FastRobotData& data, std::vector<FastPair>& pairs, int a, int b, const Meets& meets) {
  const FastGroup& from = data.groups[static_cast<std::size_t>(a)];
  const FastGroup& to = data.groups[static_cast<std::size_t>(b)];
  FastPair pair{a, b, static_cast<int>(data.rows.size()), 0, reach_of(data, from.ball, to.ball)};
  for (int i = from.parts.first; i < from.parts.first + from.parts.count; ++i) {
    FastRow row{i, reach_of(data, data.parts[static_cast<std::size_t>(i)].ball, to.ball),
                static_cast<int>(data.part_pairs.size()), 0};
    for (int j = to.parts.first; j < to.parts.first + to.parts.count; ++j) {
      add_part_pair(data, row, i, j, meets);
    }
    if (row.count == 0) continue;
    data.rows.push_back(row);
    ++pair.count;
  }
  if (pair.count > 0) pairs.push_back(pair);
}

}  // namespace

void add_pairs(FastRobotData& data, const LinkChain& chain) {
  const LinkPairs links(data.set);
  const auto paired = [&](int one, int other) {
    return links.has(data.link_of_sphere[static_cast<std::size_t>(one)],
                     data.link_of_sphere[static_cast<std::size_t>(other)]);
  };
  const auto body = [&](int g) { return data.groups[static_cast<std::size_t>(g)].body; };
  // Groups begin with the farthest; b is never nearer to the base than a.
  const int count = static_cast<int>(data.groups.size());
  for (int a = count - 1; a >= 0; --a) {
    for (int b = a; b >= 0; --b) {
      MeetingSearch search(data, chain, body(a), body(b));
      add_pair(data, data.pairs, a, b, [&](int one, int other) {
        const FastSphere& from = data.spheres[static_cast<std::size_t>(one)];
        const FastSphere& to = data.spheres[static_cast<std::size_t>(other)];
        // Radii are padded, which covers that centres are rounded to floats.
        return (a != b || one < other) && paired(one, other) &&
               search.may_meet(center_of(from), center_of(to),
                               data.levers_of_sphere[static_cast<std::size_t>(other)],
                               from.radius + to.radius - surplus(data));
      });
      add_pair(data, data.every_pair, a, b,
               [&](int one, int other) { return (a != b || one < other) && paired(one, other); });
    }
  }
}

}  // namespace mjarm::detail
