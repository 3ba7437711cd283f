#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/program/program_plan.hpp"
#include "mjarm/program/urscript_reader_test.hpp"

namespace mjarm::testing {

/// Link lengths [m] of a UR5e: those of the controller, and the rounded ones of the shipped model.
struct UrChain {
  double d1, a2, a3, d4, d5, d6;
};
inline constexpr UrChain kController{0.1625, -0.425, -0.3922, 0.1333, 0.0997, 0.0996};
inline constexpr UrChain kShipped{0.163, -0.425, -0.392, 0.134, 0.1, 0.1};

/// Flange in base by homogeneous matrices, as in the data sheet.
inline Pose ur_fk(const UrChain& l, const std::vector<double>& q) {
  const double d[6] = {l.d1, 0, 0, l.d4, l.d5, l.d6}, a[6] = {0, l.a2, l.a3, 0, 0, 0};
  const double ca[6] = {0, 1, 1, 0, 0, 1}, sa[6] = {1, 0, 0, 1, -1, 0};
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  for (int i = 0; i < 6; ++i) {
    const double c = std::cos(q[i]), s = std::sin(q[i]);
    Eigen::Matrix4d A;
    A << c, -s * ca[i], s * sa[i], a[i] * c, s, c * ca[i], -c * sa[i], a[i] * s, 0, sa[i], ca[i],
        d[i], 0, 0, 0, 1;
    T = T * A;
  }
  return {T.block<3, 1>(0, 3), T.block<3, 3>(0, 0)};
}

/// A pose p[x, y, z, rx, ry, rz].
inline Pose ur_pose(const std::vector<double>& p) {
  const Eigen::Vector3d w(p[3], p[4], p[5]);
  const double angle = w.norm();
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  if (angle > 0) R = Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
  return {{p[0], p[1], p[2]}, R};
}

/// Walks through a script as a controller would, beside the plan it was made from, and notes all
/// that differs.
class UrCheck {
 public:
  /// @param X_WB  the controller's base frame in the world, known from elsewhere.
  UrCheck(const UrScript& script, const program::ProgramPlan& plan, const Pose& X_WB = {})
      : script_(script), plan_(plan), X_WB_(X_WB) {}

  /// What is wrong, a line each; empty where script and plan are the same motion.
  std::vector<std::string> problems() {
    try {
      joint_goal(plan_.q_start);
      for (const PlannedMove& move : plan_.moves) check(move);
      if (i_ != script_.statements.size()) note("statements are left over");
    } catch (const std::exception& stop) {
      note(stop.what());
    }
    return problems_;
  }
  double seconds() const { return seconds_; }  ///< of the motions, as a controller takes them
  double worst_curve() const { return worst_curve_; }      ///< [m] of points from their curve
  double worst_nominal() const { return worst_nominal_; }  ///< [m] model from controller
  int count(const std::string& word) const {
    return static_cast<int>(std::ranges::count(script_.statements, word, &UrStatement::word));
  }

 private:
  static constexpr double kExact = 1e-9;   // [m], [rad]
  static constexpr double kCurve = 1e-4;   // [m] what is promised for points of curves
  static constexpr double kCurveR = 1e-3;  // [rad]

  void note(const std::string& what) {
    problems_.push_back("statement " + std::to_string(i_) + ": " + what);
  }
  void below(double value, double max, const std::string& what) {
    if (!(value <= max)) note(what + " " + std::to_string(value * 1e9) + "e-9");
  }

  const UrStatement& next(const std::string& word) {
    while (i_ < script_.statements.size() && script_.statements[i_].word == "set_tcp") {
      X_FT_ = ur_pose(script_.statements[i_++].lists.at(0));
    }
    if (i_ >= script_.statements.size()) throw std::runtime_error("the script ends early");
    const UrStatement& out = script_.statements[i_++];
    if (!word.empty() && out.word != word) throw std::runtime_error("expected " + word);
    return out;
  }

  const UrStatement& joint_goal(const JointVec& q) {
    const UrStatement& out = next("movej");
    if (out.kinds != "q") throw std::runtime_error("movej to no joint values");
    below((joint_vec(out.lists[0]) - q).cwiseAbs().maxCoeff(), kExact, "joint values off");
    q_ = out.lists[0];
    by_joints_ = true;
    return out;
  }

  static double ramps(double way, double a, double v) {
    return v * v >= a * way ? 2 * std::sqrt(way / a) : way / v + v / a;
  }

  void check(const PlannedMove& move) {
    const double planned = move.trajectory.duration();
    if (move.curve) {
      tool_move(move);
    } else if (!move.measures) {
      if (move.close)
        below(std::abs(next("set_tool_digital_out").numbers.at(1) - *move.close), 0, "grip");
      if (planned > 0) below(std::abs(next("sleep").numbers.at(0) - planned), kExact, "sleep");
      seconds_ += planned;
    } else if (planned > 0) {
      const JointVec q0 = joint_vec(q_), q1 = move.trajectory.at(planned).q;
      const JointVec from = by_joints_ ? q0 : move.trajectory.at(0).q;
      const UrStatement& to = joint_goal(q1);
      const double way = (q1 - from).cwiseAbs().maxCoeff();
      const double seconds = ramps(way, to.named.at("a"), to.named.at("v"));
      below(std::abs(seconds - planned), 1e-6, "time of a joint move off by");
      seconds_ += seconds;
      const Pose X = fk(plan_.arms[move.tool], as_span(q1));
      const Pose exact = X_WB_ * ur_fk(kShipped, q_) * X_FT_;
      below((exact.p - X.p).norm(), kExact, "tool after movej off by");
      below(angle_between(exact.R, X.R), kExact, "tool after movej turned by");
      const Pose nominal = X_WB_ * ur_fk(kController, q_) * X_FT_;
      worst_nominal_ = std::max(worst_nominal_, (nominal.p - X.p).norm());
    }
  }

  /// The next pose, in the world.
  Pose world(const UrStatement& statement, std::size_t k = 0) {
    if (statement.kinds.size() <= k || statement.kinds[k] != 'p') {
      throw std::runtime_error("expected a pose");
    }
    return X_WB_ * ur_pose(statement.lists[k]);
  }

  static double of(const UrStatement& statement, const std::string& name) {
    const auto found = statement.named.find(name);
    return found == statement.named.end() ? 0 : found->second;
  }

  void tool_move(const PlannedMove& move) {
    const Curve& curve = *move.curve;
    Pose X = curve.at(0);
    if (by_joints_) {
      const Pose start = world(next("movel"));
      below((start.p - X.p).norm(), kExact, "start off by");
      below(angle_between(start.R, X.R), kExact, "start turned by");
      const Pose reached = X_WB_ * ur_fk(kShipped, q_) * X_FT_;
      below((reached.p - start.p).norm(), 1e-6, "start from where movej ends");
      below(angle_between(reached.R, start.R), 1e-5, "start turned from where movej ends");
      by_joints_ = false;
    }
    const Pose last = curve.at(curve.end());
    double done = 0, r = 0, v_before = 0;
    const double before = seconds_;
    std::vector<Eigen::Vector3d> way{X.p};
    for (bool there = false; !there;) {
      const UrStatement& to = next("");
      const Pose X_to = world(to, to.word == "movec" ? 1 : 0);
      done += segment(move, to, X, X_to, r, way);
      r = of(to, "r");
      time_of(to, (X_to.p - X.p).norm(), v_before, r);
      X = X_to;
      there = (X.p - last.p).norm() < 1e-6 && done > 0.9 * curve.length() && !(r > 0);
    }
    below((X.p - last.p).norm(), kExact, "end off by");
    below(angle_between(X.R, last.R), kExact, "end turned by");
    covered(move, way);
    const double seconds = seconds_ - before, planned = move.trajectory.duration();
    below(std::abs(seconds - planned), 0.15 * planned, "time of a tool move off by");
  }

  /// One statement; returns its length [m].
  double segment(const PlannedMove& move, const UrStatement& to, const Pose& X, const Pose& X_to,
                 double r_from, std::vector<Eigen::Vector3d>& way) {
    constexpr int kPlaces = 40;
    const Curve& curve = *move.curve;
    if (to.word == "movec") return arc(curve, X.p, world(to, 0).p, X_to.p, way);
    const bool process = to.word == "movep";
    if (!process && to.word != "movel") throw std::runtime_error("unknown " + to.word);
    const double length = (X_to.p - X.p).norm(), r = of(to, "r");
    if (length > kExact) below(r + r_from, length, "blends overlap");
    if (process) {
      const double s = curve.nearest(X_to.p).s;
      below(curve.nearest(X_to.p).distance, kExact, "point off by");
      below(std::min(angle_between(curve.at(s).R, X_to.R), angle_between(curve.at(0).R, X_to.R)),
            1e-6, "point turned by");
    }
    for (int i = 0; i <= kPlaces; ++i) {
      const double x = static_cast<double>(i) / kPlaces;
      const Pose here = interpolate(X, X_to, x);
      way.push_back(here.p);
      if (!process && (x * length < r_from || (1 - x) * length < r)) continue;
      const Curve::Nearest near = curve.nearest(here.p);
      below(near.distance, process ? kCurve : kExact, "way off by");
      worst_curve_ = std::max(worst_curve_, near.distance);
      if (length < kExact || i == 0 || i == kPlaces) continue;  // a turn, or a corner
      below(angle_between(curve.at(near.s).R, here.R), process ? kCurveR : 1e-6, "way turned by");
    }
    return length;
  }

  /// An arc through three points, by the center of their circle.
  double arc(const Curve& curve, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
             const Eigen::Vector3d& c, std::vector<Eigen::Vector3d>& way) {
    const Eigen::Vector3d u = b - a, w = c - a, n = u.cross(w);
    const Eigen::Vector3d center =
        a + (w.squaredNorm() * n.cross(u) + u.squaredNorm() * w.cross(n)) / (2 * n.squaredNorm());
    const Eigen::Vector3d x = a - center, y = n.normalized().cross(x);
    const auto angle = [&](const Eigen::Vector3d& p) {
      const double t = std::atan2((p - center).dot(y), (p - center).dot(x));
      return t < 0 ? t + 2 * std::numbers::pi : t;
    };
    if (angle(b) > angle(c)) note("via is beyond the end");
    for (int i = 0; i <= 100; ++i) {
      const double t = angle(c) * i / 100;
      way.push_back(center + std::cos(t) * x + std::sin(t) * y);
      below(curve.nearest(way.back()).distance, kExact, "arc off by");
    }
    return arc_length_ = angle(c) * x.norm();
  }

  /// The time a controller takes: each way at its speed, and the ramps at rests.
  void time_of(const UrStatement& to, double length, double& v_before, double r) {
    if (to.named.contains("t")) {
      seconds_ += to.named.at("t");
      return;
    }
    const double a = to.named.at("a"), v = to.named.at("v");
    const double way = to.word == "movec" ? arc_length_ : length;
    const bool from_rest = v_before == 0, to_rest = !(r > 0);
    seconds_ += from_rest && to_rest ? ramps(way, a, v)
                                     : way / v + (from_rest || to_rest ? v / (2 * a) : 0);
    v_before = to_rest ? 0 : v;
  }

  /// Whether the statements go all along the curve, blends apart.
  void covered(const PlannedMove& move, const std::vector<Eigen::Vector3d>& way) {
    const Curve& curve = *move.curve;
    if (!(curve.length() > 0)) return;
    double blend = kCurve;
    for (const CurveBlend& b : curve.blends()) blend = std::max(blend, b.radius);
    for (const double s : curve.stations(curve.length() / 200, 1)) {
      const Eigen::Vector3d p = curve.at(s).p;
      double least = 1e9;
      for (std::size_t i = 1; i < way.size(); ++i) {
        const Eigen::Vector3d d = way[i] - way[i - 1];
        const double x =
            d.squaredNorm() > 0 ? std::clamp((p - way[i - 1]).dot(d) / d.squaredNorm(), 0., 1.) : 0;
        least = std::min(least, (p - way[i - 1] - x * d).norm());
      }
      below(least, 1.01 * blend, "not covered");
    }
  }

  const UrScript& script_;
  const program::ProgramPlan& plan_;
  Pose X_WB_;
  Pose X_FT_;
  std::vector<double> q_;
  bool by_joints_ = true;
  std::size_t i_ = 0;
  double seconds_ = 0, worst_curve_ = 0, worst_nominal_ = 0, arc_length_ = 0;
  std::vector<std::string> problems_;
};

}  // namespace mjarm::testing
