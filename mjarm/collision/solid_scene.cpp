#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "mjarm/collision/solid_scene_internal.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm::detail {
namespace {

using Eigen::Vector3d;

constexpr double kRoundUp = 1 + 1e-9;  // of a bound of a motion

/// Velocity [m a unit of t] of a place, as a field over the world.
struct Turning {
  Vector3d turn = Vector3d::Zero();
  Vector3d shift = Vector3d::Zero();  // of the world's origin
  Turning operator-(const Turning& other) const { return {turn - other.turn, shift - other.shift}; }
  Vector3d at(const Vector3d& p) const { return turn.cross(p) + shift; }
};

/// How a solid moves as seen from what it is held against.
struct SolidMotion {
  Vector3d v = Vector3d::Zero();  // of its centre
  Vector3d turn = Vector3d::Zero();
  double reach = 0;  // [m]
  double bend = 0;   // [m] bound of the second derivative of its points
  double speed = 0;  // [m a unit of t] of any of them now, at most
  /// [m] that any of its points moves by at most.
  double way(double half) const { return half * (speed + 0.5 * bend * half) * kRoundUp; }
  /// [m a unit of t] of any of its points along `n`, now.
  double along(const Vector3d& n) const {
    return (std::abs(n.dot(v)) + n.cross(turn).norm() * reach) * kRoundUp;
  }
};

/// What a solid is held against: another, or a half-space z <= 0.
struct Part {
  const Convex* convex = nullptr;  // null: a half-space
  Pose X_WP;
  double radius() const { return convex != nullptr ? convex->radius() : 0; }
};

Separation separate(const Convex& a, const Pose& X_WA, const Part& b,
                    const SeparateLimits& limits) {
  if (b.convex != nullptr) return separate(a, X_WA, *b.convex, b.X_WP, limits);
  int hint = 0;
  const Vector3d n = b.X_WP.R.col(2);
  const Pose X_WS = X_WA * a.frame();
  const Vector3d lowest = X_WS * a.farthest(-(X_WS.R.transpose() * n), hint);
  const double gap = n.dot(lowest - b.X_WP.p);
  return {gap, n, std::max(gap, 0.0)};
}

/// The prisms of a height field under a box round a ball, one for each triangle of its surface.
/// MuJoCo cuts each cell from the crossing of lower row and column to that of both higher ones.
template <class Look>
void each_prism(const StandingSolid& field, const Vector3d& center_W, double reach,
                const Look& look) {
  const HeightFieldShape& ground = field.ground;
  const Vector3d c = field.X_WO.R.transpose() * (center_W - field.X_WO.p);
  const double dx = 2 * ground.half.x() / (ground.cols - 1);
  const double dy = 2 * ground.half.y() / (ground.rows - 1);
  const auto cell = [](double at, double width, int count) {
    return static_cast<int>(std::clamp(std::floor(at / width), 0.0, count - 2.0));
  };
  const auto corner = [&](int row, int col) {
    const auto index = static_cast<std::size_t>(row * ground.cols + col);
    return Vector3d(col * dx - ground.half.x(), row * dy - ground.half.y(), ground.heights[index]);
  };
  const int last_row = cell(c.y() + reach + ground.half.y(), dy, ground.rows);
  const int last_col = cell(c.x() + reach + ground.half.x(), dx, ground.cols);
  for (int row = cell(c.y() - reach + ground.half.y(), dy, ground.rows); row <= last_row; ++row) {
    for (int col = cell(c.x() - reach + ground.half.x(), dx, ground.cols); col <= last_col; ++col) {
      for (const auto& [r, k] : {std::pair{1, 0}, {0, 1}}) {
        std::array<Vector3d, 6> p = {corner(row, col), corner(row + r, col + k),
                                     corner(row + 1, col + 1)};
        if (std::max({p[0].z(), p[1].z(), p[2].z()}) < c.z() - reach) continue;
        for (std::size_t i = 0; i < 3; ++i) p[i + 3] = {p[i].x(), p[i].y(), ground.bottom};
        if (!look(Convex(p))) return;
      }
    }
  }
}

/// Calls `look(part)` for the convex parts of what stands that may be nearer than `within` to the
/// centre of a solid, until it says no.
template <class Look>
void each_part(const StandingSolid& standing, const Vector3d& center_W, double within,
               const Look& look) {
  switch (standing.kind) {
    case StandingSolid::Kind::half_space:
      look(Part{nullptr, standing.X_WO});
      return;
    case StandingSolid::Kind::convex:
      look(Part{&*standing.convex, Pose()});
      return;
    case StandingSolid::Kind::ground:
      each_prism(standing, center_W, within,
                 [&](const Convex& prism) { return look(Part{&prism, standing.X_WO}); });
  }
}

/// [m^2] From a place to the box round what stands. By hand, as often as this is needed.
double distance2(const StandingSolid& standing, const Vector3d& p) {
  const Vector3d &low = standing.low, &high = standing.high;
  const double x = std::max(std::max(low.x() - p.x(), p.x() - high.x()), 0.0);
  const double y = std::max(std::max(low.y() - p.y(), p.y() - high.y()), 0.0);
  const double z = std::max(std::max(low.z() - p.z(), p.z() - high.z()), 0.0);
  return x * x + y * y + z * z;
}

}  // namespace

double gap_to_standing(const Convex& convex, const Pose& X_WC, const StandingSolid& standing,
                       double enough) noexcept {
  double least = std::numeric_limits<double>::infinity();
  const double within = convex.reach() + convex.radius() + enough;
  each_part(standing, X_WC * convex.center(), within, [&](const Part& part) {
    const double radii = convex.radius() + part.radius();
    least = std::min(least, separate(convex, X_WC, part, {.enough = radii + enough}).gap - radii);
    return true;
  });
  return least;
}

double distance_to_standing(const Vector3d& p_W, const StandingSolid& standing,
                            double enough) noexcept {
  const Convex point{CoverSolid()};  // a ball without radius
  const Pose X_WP{p_W, Eigen::Matrix3d::Identity()};
  double least = std::numeric_limits<double>::infinity();
  each_part(standing, p_W, enough, [&](const Part& part) {
    const Separation apart =
        separate(point, X_WP, part, {.enough = part.radius() + std::min(enough, least)});
    least = std::min(least, std::max(apart.distance - part.radius(), 0.0));
    return true;
  });
  return least <= enough ? least : std::numeric_limits<double>::infinity();
}

/// A configuration, and how it moves along a way.
class SolidScene::Moment {
 public:
  Moment(const SolidScene& scene, std::span<const double> q, std::span<const double> way)
      : scene_(scene), way_(way) {
    fk_all(scene.arm_, q, X_WJ_);
    Turning sum;
    for (std::size_t k = 0; k < way.size(); ++k) {
      const ArmJoint& joint = scene.arm_.joints[k];
      const Vector3d axis_W = way[k] * (X_WJ_[k].R * joint.axis);
      if (joint.type == JointType::slide) {
        sum.shift += axis_W;
      } else {
        sum.turn += axis_W;
        sum.shift -= axis_W.cross(X_WJ_[k].p);
      }
      turning_[k] = sum;
    }
  }

  const Pose& place(int joint) const { return X_WJ_[static_cast<std::size_t>(joint)]; }

  /// Calls `look(solid, motion, within, standing)` for what is no farther than `near(motion)` from
  /// the ball round a solid (together: `within` [m] from its centre), until it says no.
  template <class Near, class Look>
  void each_standing(const Near& near, const Look& look) const {
    for (const LinkGroup& link : scene_.links_) {
      const NearOnes near_link = near_ones(link, near);
      if (near_link.next(0) == scene_.standing_.size()) continue;
      for (std::size_t i = link.first; i < link.end; ++i) {
        const LinkSolid& solid = scene_.solids_[i];
        const Vector3d c = place(solid.joint) * solid.convex.center();
        const double ball = solid.convex.reach() + solid.convex.radius();
        const SolidMotion moves = motion(solid, c, -1);
        for (std::size_t k = near_link.next(0); k < scene_.standing_.size();
             k = near_link.next(k + 1)) {
          const StandingSolid& standing = scene_.standing_[k];
          if (standing.ignored[static_cast<std::size_t>(solid.link)] != 0) continue;
          const double within = ball + near(moves);
          if (distance2(standing, c) > within * within) continue;
          if (!look(solid, moves, within, standing)) return;
        }
      }
    }
  }

  /// The same of paired links: `look(solid, motion, other)`.
  template <class Near, class Look>
  void each_pair(const Near& near, const Look& look) const {
    for (const auto& [a, b] : scene_.pairs_) {
      const LinkGroup& first = scene_.links_[static_cast<std::size_t>(a)];
      const LinkGroup& second = scene_.links_[static_cast<std::size_t>(b)];
      const Vector3d center_a = place(first.joint) * first.center;
      const Vector3d center_b = place(second.joint) * second.center;
      const SolidMotion whole = motion(second, center_b, first.joint);
      const double far = first.reach + second.reach + near(whole);
      if ((center_b - center_a).squaredNorm() > far * far) continue;
      for (std::size_t k = second.first; k < second.end; ++k) {
        const LinkSolid& solid = scene_.solids_[k];
        const Vector3d c = place(solid.joint) * solid.convex.center();
        const SolidMotion moves = motion(solid, c, first.joint);
        for (std::size_t i = first.first; i < first.end; ++i) {
          const LinkSolid& other = scene_.solids_[i];
          const Vector3d apart = place(other.joint) * other.convex.center() - c;
          const double reach = other.convex.reach() + other.convex.radius() + solid.convex.reach() +
                               solid.convex.radius() + near(moves);
          if (apart.squaredNorm() > reach * reach) continue;
          if (!look(solid, moves, other)) return;
        }
      }
    }
  }

 private:
  /// Of what stands, all that may be near enough to some solid of a link.
  class NearOnes {
   public:
    explicit NearOnes(std::size_t count) : count_(count) {}
    void set(std::size_t word, std::uint64_t bits) { bits_[word] = bits; }
    /// The first from `k` on; the count of all where there is none.
    [[nodiscard]] std::size_t next(std::size_t k) const {
      while (k < std::min(count_, kMarked)) {
        const std::size_t bit = k % NearBoxes::kWord;
        const std::uint64_t left = bits_[k / NearBoxes::kWord] >> bit;
        if (left != 0) return k + static_cast<std::size_t>(std::countr_zero(left));
        k += NearBoxes::kWord - bit;
      }
      return std::min(k, count_);
    }

    static constexpr std::size_t kWords = 16;

   private:
    static constexpr std::size_t kMarked = kWords * NearBoxes::kWord;  // more may all be near
    std::size_t count_;
    std::array<std::uint64_t, kWords> bits_{};
  };

  template <class Near>
  NearOnes near_ones(const LinkGroup& link, const Near& near) const {
    NearOnes out(scene_.standing_.size());
    const Vector3d center = place(link.joint) * link.center;
    const double within = (link.reach + near(motion(link, center, -1))) * kRoundUp;
    for (std::size_t k = 0; k < std::min(scene_.boxes_.words(), NearOnes::kWords); ++k) {
      out.set(k, scene_.boxes_.near(k, center, within));
    }
    return out;
  }

  SolidMotion motion(const LinkSolid& solid, const Vector3d& center_W, int base) const {
    return motion(solid.joint, solid.levers, center_W, solid.convex.reach(), base);
  }
  SolidMotion motion(const LinkGroup& link, const Vector3d& center_W, int base) const {
    return motion(link.joint, link.levers, center_W, link.reach, base);
  }

  /// @param base  the joint that moves what it is held against; -1: none does.
  SolidMotion motion(int joint, const std::array<double, kMaxDof>& levers, const Vector3d& center_W,
                     double reach, int base) const {
    if (way_.empty()) return {};
    Turning turning = turning_[static_cast<std::size_t>(joint)];
    if (base >= 0) turning = turning - turning_[static_cast<std::size_t>(base)];
    SolidMotion out{turning.at(center_W), turning.turn, reach, 0, 0};
    out.speed = out.v.norm() + out.turn.norm() * reach;
    double before = 0;  // rates of the joints after the base, summed
    for (int k = base + 1; k <= joint; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const double rate = std::abs(way_[i]);
      out.bend += levers[i] * rate * (rate + 2 * before);
      before += rate;
    }
    return out;
  }

  const SolidScene& scene_;
  std::span<const double> way_;
  std::array<Pose, kMaxDof> X_WJ_;
  std::array<Turning, kMaxDof> turning_;
};

SolidScene::SolidScene(Arm arm, std::vector<LinkSolid> solids, std::vector<StandingSolid> standing,
                       std::span<const std::array<int, 2>> pairs)
    : arm_(std::move(arm)), solids_(std::move(solids)), standing_(std::move(standing)) {
  for (std::size_t k = 0; k < solids_.size(); ++k) {
    const LinkSolid& solid = solids_[k];
    if (k == 0 || solid.link != solids_[k - 1].link)
      links_.push_back({.joint = solid.joint, .first = k, .end = k});
    ++links_.back().end;
  }
  for (LinkGroup& link : links_) {
    const std::span<const LinkSolid> ours(&solids_[link.first], link.end - link.first);
    for (const LinkSolid& solid : ours) {
      link.center += solid.convex.center() / static_cast<double>(ours.size());
    }
    for (const LinkSolid& solid : ours) {
      const double far = (solid.convex.center() - link.center).norm();
      link.reach = std::max(link.reach, far + solid.convex.reach() + solid.convex.radius());
      for (std::size_t k = 0; k < kMaxDof; ++k) {
        link.levers[k] = std::max(link.levers[k], solid.levers[k]);
      }
    }
  }
  for (const StandingSolid& solid : standing_) boxes_.add(solid.low, solid.high);
  for (auto [a, b] : pairs) {
    const auto joint = [&](int link) { return links_[static_cast<std::size_t>(link)].joint; };
    if (joint(a) > joint(b)) std::swap(a, b);
    pairs_.push_back({a, b});
  }
}

double SolidScene::free_half(std::span<const double> q, std::span<const double> way, double half,
                             const SphereMargins& margins) const noexcept {
  const Moment moment(*this, q, way);
  double proved = half;
  // Narrows `proved` to what two cores allow; false where they are too near.
  const auto keep = [&](const SolidMotion& motion, double need, const auto& separation) {
    const Separation apart =
        separation(SeparateLimits{need + motion.way(proved), std::max(need, 0.0)});
    const double left = apart.gap - need;
    if (!(left > 0)) {
      proved = -1;
      return false;
    }
    const double speed = motion.along(apart.normal), bend = motion.bend;
    if (speed * proved + 0.5 * bend * proved * proved * kRoundUp < left) return true;
    proved = 2 * left / (speed + std::sqrt(speed * speed + 2 * bend * left)) / kRoundUp;
    return true;
  };
  const auto near = [&](double margin) {
    return [&, margin](const SolidMotion& motion) {
      return margin + kSolidSpare + motion.way(proved);
    };
  };
  moment.each_standing(
      near(margins.obstacles), [&](const LinkSolid& solid, const SolidMotion& motion, double within,
                                   const StandingSolid& standing) {
        const Pose& X_WL = moment.place(solid.joint);
        const double need = solid.convex.radius() + margins.obstacles + kSolidSpare;
        each_part(standing, X_WL * solid.convex.center(), within, [&](const Part& part) {
          return keep(motion, need + part.radius(), [&](const SeparateLimits& limits) {
            return separate(solid.convex, X_WL, part, limits);
          });
        });
        return proved >= 0;
      });
  if (proved < 0) return proved;
  moment.each_pair(near(margins.links), [&](const LinkSolid& solid, const SolidMotion& motion,
                                            const LinkSolid& other) {
    const double radii = solid.convex.radius() + other.convex.radius();
    return keep(motion, radii + margins.links + kSolidSpare, [&](const SeparateLimits& limits) {
      return separate(solid.convex, moment.place(solid.joint), other.convex,
                      moment.place(other.joint), limits);
    });
  });
  return proved;
}

double SolidScene::farthest(std::span<const double> off) const noexcept {
  double most = 0;
  for (const LinkGroup& link : links_) {
    double sum = 0;
    for (std::size_t k = 0; k < off.size(); ++k) sum += link.levers[k] * off[k];
    most = std::max(most, sum * kRoundUp);
  }
  return most;
}

bool SolidScene::is_free(std::span<const double> q, const SphereMargins& margins) const noexcept {
  return free_half(q, {}, 0, margins) >= 0;
}

SolidScene::Clearance SolidScene::clearance(std::span<const double> q, double max,
                                            const SphereMargins& margins) const noexcept {
  const Moment moment(*this, q, {});
  Clearance out{max, {}};
  const auto note = [&](double distance, const Pair& pair) {
    if (distance < out.distance) out = {distance, pair};
    return true;
  };
  const auto near = [&](double margin) {
    return [&, margin](const SolidMotion&) { return margin + std::max(out.distance, 0.0); };
  };
  // Of two cores and what is kept round them.
  const auto between = [&](const Convex& a, const Pose& X_WA, const Part& b, double margin) {
    const double need = a.radius() + b.radius() + margin;
    const double enough = need + std::max(out.distance, 0.0);
    const Separation apart = separate(a, X_WA, b, {.enough = enough});
    if (apart.gap > 0 || b.convex == nullptr) return apart.gap - need;
    return -depth_of_overlap(a, X_WA, *b.convex, b.X_WP) - margin;
  };
  moment.each_standing(near(margins.obstacles), [&](const LinkSolid& solid, const SolidMotion&,
                                                    double within, const StandingSolid& standing) {
    const Pose& X_WL = moment.place(solid.joint);
    const Pair pair{solid.link, static_cast<int>(&standing - standing_.data()), -1};
    each_part(standing, X_WL * solid.convex.center(), within, [&](const Part& part) {
      return note(between(solid.convex, X_WL, part, margins.obstacles), pair);
    });
    return true;
  });
  moment.each_pair(
      near(margins.links), [&](const LinkSolid& solid, const SolidMotion&, const LinkSolid& other) {
        const Part part{&solid.convex, moment.place(solid.joint)};
        return note(between(other.convex, moment.place(other.joint), part, margins.links),
                    {other.link, -1, solid.link});
      });
  return out;
}

}  // namespace mjarm::detail
