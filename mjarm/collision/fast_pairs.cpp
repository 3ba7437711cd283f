#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "mjarm/collision/fast_robot_internal.hpp"

/// Which spheres of two links can meet at all. With few joints between the links this is decided by
/// a proof: over a box of joint values the distance changes by at most (lever * half width), summed
/// over the joints, so a box is cut until it is clear, or its middle shows an overlap.
namespace mjarm::detail {
namespace {

constexpr int kMostProved = 3;    // joints between two links; for more the search is too large
constexpr int kMostBoxes = 1000;  // of one search
constexpr double kSpare = 1e-5;   // [m] by which spheres that never meet keep apart at least

using Joints = std::array<double, kMostProved>;

class MeetingSearch {
 public:
  /// `levers` are those of body `b`.
  MeetingSearch(const Arm& arm, const LinkChain& chain, int a, int b,
                const std::array<double, kMaxDof>& levers)
      : chain_(chain), a_(a), b_(b) {
    for (int k = a; k < b && k < a + kMostProved; ++k) {
      const auto i = static_cast<std::size_t>(k - a);
      const FastLimits limits = fast_limits(arm, k);
      middle_[i] = 0.5 * (limits.upper + limits.lower);
      half_[i] = 0.5 * (limits.upper - limits.lower);
      levers_[i] = levers[static_cast<std::size_t>(k)] + 1e-6;
    }
  }

  /// False where no joint values bring the centres as near to each other as `reach`.
  bool may_meet(const Eigen::Vector3d& center_a, const Eigen::Vector3d& center_b, double reach) {
    if (b_ - a_ > kMostProved) return true;
    boxes_ = 0;
    return search(center_a, center_b, reach + kSpare, middle_, half_);
  }

 private:
  bool search(const Eigen::Vector3d& center_a, const Eigen::Vector3d& center_b, double reach,
              const Joints& middle, const Joints& half) {
    if (++boxes_ > kMostBoxes) return true;
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
  Eigen::Vector3d place(Eigen::Vector3d p, const Joints& q) const {
    for (int k = b_ - 1; k >= a_; --k) {
      const Link& link = chain_.links[k];
      const double value = q[static_cast<std::size_t>(k - a_)];
      const double angle = link.offset + (link.slide ? 0 : value);
      const double c = std::cos(angle), s = std::sin(angle);
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
};

Eigen::Vector3d center_of(const FastSphere& sphere) { return {sphere.x, sphere.y, sphere.z}; }

/// The pair with the partners that `meets` keeps; rows and pairs without any are left out.
template <class Meets>
void add_pair(FastRobotData& data, std::vector<FastPair>& pairs, int a, int b, Meets meets) {
  const FastGroup& from = data.groups[static_cast<std::size_t>(a)];
  const FastGroup& to = data.groups[static_cast<std::size_t>(b)];
  FastPair pair{a, b, static_cast<int>(data.rows.size()), 0};
  for (int k = from.first; k < from.first + from.count; ++k) {
    FastRow row{k, static_cast<int>(data.partners.size()), 0};
    for (int j = to.first; j < to.first + to.count; ++j) {
      const FastSphere& one = data.spheres[static_cast<std::size_t>(k)];
      const FastSphere& other = data.spheres[static_cast<std::size_t>(j)];
      if (!meets(one, other)) continue;
      const float reach = round_up(static_cast<double>(one.radius) + other.radius);
      data.partners.push_back({j, reach, -round_up(static_cast<double>(reach) * reach)});
      ++row.count;
    }
    if (row.count == 0) continue;
    data.rows.push_back(row);
    ++pair.count;
  }
  if (pair.count > 0) pairs.push_back(pair);
}

}  // namespace

void add_pairs(FastRobotData& data, const LinkChain& chain) {
  std::vector<int> group_of_link(data.set.links.size());
  for (std::size_t g = 0; g < data.link_of_group.size(); ++g) {
    group_of_link[static_cast<std::size_t>(data.link_of_group[g])] = static_cast<int>(g);
  }
  for (const auto& [first, second] : data.set.pairs) {
    int a = group_of_link[static_cast<std::size_t>(first)];
    int b = group_of_link[static_cast<std::size_t>(second)];
    const auto body = [&](int g) { return data.groups[static_cast<std::size_t>(g)].body; };
    if (body(a) > body(b)) std::swap(a, b);
    MeetingSearch search(data.arm, chain, body(a), body(b),
                         data.bounds[static_cast<std::size_t>(b)].levers);
    add_pair(data, data.pairs, a, b, [&](const FastSphere& one, const FastSphere& other) {
      // Radii are padded, which covers that centres are rounded to floats.
      return search.may_meet(center_of(one), center_of(other), one.radius + other.radius);
    });
    add_pair(data, data.every_pair, a, b,
             [](const FastSphere&, const FastSphere&) { return true; });
  }
}

}  // namespace mjarm::detail
