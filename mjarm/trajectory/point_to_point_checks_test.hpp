#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/trajectory/limits_test.hpp"
#include "mjarm/trajectory/point_to_point.hpp"

namespace mjarm::testing {

/// The worst over a motion, from the exact extremes of its pieces.
struct Worst {
  double velocity = 0, acceleration = 0, jerk = 0;  ///< beyond the limit, as a share of it
  double q = 0, v = 0, a = 0;  ///< jumps between pieces and to the end [rad], [rad/s], [rad/s^2]
};

/// What is left of a piece when the next one begins, or the end.
inline void add_jump(const PointToPoint::Piece& now, double q, double v, double a, Worst& worst) {
  worst.q = std::max(worst.q, std::abs(now.q - q));
  worst.v = std::max(worst.v, std::abs(now.v - v));
  worst.a = std::max(worst.a, std::abs(now.a - a));
}

/// @param from  [s] limits other than the jerk's are looked at from there on.
inline Worst worst_of(const PointToPoint& motion, const JointState& end, const JointLimits& limits,
                      double from = 0) {
  Worst worst;
  for (int i = 0; i < motion.dof(); ++i) {
    const auto pieces = motion.pieces(i);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      const bool last = k + 1 == pieces.size();
      const PointToPoint::Piece& p = pieces[k];
      const double h = (last ? motion.duration() : pieces[k + 1].t) - p.t;
      const auto after = [&](double x) {
        return PointToPoint::Piece{p.t + x, p.q + x * (p.v + x * (p.a / 2 + x * p.jerk / 6)),
                                   p.v + x * (p.a + x * p.jerk / 2), p.a + x * p.jerk, p.jerk};
      };
      const double begin = std::max(0.0, from - p.t);
      for (const double x : {begin, h, p.a * (p.a + h * p.jerk) < 0 ? -p.a / p.jerk : h}) {
        if (x < begin || x > h) continue;
        worst.velocity = std::max(worst.velocity, std::abs(after(x).v) / limits.velocity[i] - 1);
        worst.acceleration =
            std::max(worst.acceleration, std::abs(after(x).a) / limits.acceleration[i] - 1);
      }
      worst.jerk = std::max(worst.jerk, std::abs(p.jerk) / limits.jerk[i] - 1);
      if (last) {
        add_jump(after(h), end.q[i], end.v[i], end.a[i], worst);
      } else {
        add_jump(after(h), pieces[k + 1].q, pieces[k + 1].v, pieces[k + 1].a, worst);
      }
    }
  }
  return worst;
}

/// How long the fastest motion takes [s].
inline double duration(const JointState& start, const JointState& end, const JointLimits& limits) {
  const auto motion = PointToPoint::solve(start, end, limits);
  EXPECT_TRUE(motion.has_value());
  return motion ? motion->duration() : std::numeric_limits<double>::infinity();
}

}  // namespace mjarm::testing
