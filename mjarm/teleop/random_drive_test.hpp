#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/model/scene_bodies.hpp"
#include "mjarm/sim/sim.hpp"
#include "mjarm/teleop/teleop.hpp"

namespace mjarm::testing {

/// Somebody who holds directions down at random, changes them, the frame and the gripper.
class RandomHand {
 public:
  explicit RandomHand(std::uint64_t seed) : rng_(seed) {}

  TeleopInput at(double time) {
    if (time < until_) return input_;
    until_ = time + rng_.uniform(0.1, 2.0);
    const auto held = [&](double size) {
      const double way = rng_.uniform(-1, 1);
      return way < -0.4 ? -size : way > 0.4 ? size : 0.0;
    };
    for (int k = 0; k < 3; ++k) {
      input_.linear[k] = held(0.25);
      input_.angular[k] = rng_.uniform(0, 1) < 0.5 ? 0 : held(1);
    }
    input_.frame = rng_.uniform(0, 1) < 0.5 ? TwistFrame::tool : TwistFrame::world;
    input_.grip = held(2);
    return input_;
  }

 private:
  Rng rng_;
  double until_ = 0;
  TeleopInput input_;
};

/// Somebody who every now and then takes something, and goes on at random with it in the hand.
class GraspingHand {
 public:
  GraspingHand(const Robot& robot, std::uint64_t seed)
      : arm_(robot.arm),
        objects_(scene_bodies(robot.model, robot.arm).objects),
        hand_(seed),
        rng_(seed, 1) {}

  TeleopInput at(const Sim& sim) {
    if (sim.time() >= from_ + kCarried) {
      from_ = sim.time();
      if (!objects_.empty()) body_ = objects_[rng_.below(objects_.size())].body;
    }
    const double t = sim.time() - from_;
    TeleopInput input = hand_.at(sim.time());
    if (body_ < 0 || t < kAtRandom) return input;
    if (t < kClosed) return fetch(sim, t);
    input.grip = 0;
    if (t < kLifted) input.linear = {0, 0, 0.2};
    return input;
  }

 private:
  // [s] Ends of what it does one after the other.
  static constexpr double kAtRandom = 10, kAbove = 14, kDown = 17, kClosed = 18, kLifted = 19,
                          kCarried = 30;

  /// From above, across a side of the body.
  [[nodiscard]] TeleopInput fetch(const Sim& sim, double t) const {
    if (t > kDown) return {.grip = 2};
    const Pose X_WT = sim.tool(arm_), X_WB = sim.body_pose(body_);
    Eigen::Matrix3d R = Eigen::Matrix3d::Zero();
    for (const double sign : {-1.0, 1.0}) {
      for (int k = 0; k < 3; ++k) {
        Eigen::Vector3d x = sign * X_WB.R.col(k);
        if (std::abs(x.z()) > 0.3) continue;
        x = Eigen::Vector3d(x.x(), x.y(), 0).normalized();
        if (x.dot(X_WT.R.col(0)) > R.col(0).dot(X_WT.R.col(0)) || R.isZero()) {
          R << x, Eigen::Vector3d(0, 0, -1).cross(x), Eigen::Vector3d(0, 0, -1);
        }
      }
    }
    const auto towards = [](const Eigen::Vector3d& way, double most) -> Eigen::Vector3d {
      return 3 * way * std::min(1.0, most / (3 * way.norm() + 1e-9));
    };
    const Eigen::Vector3d above(0, 0, t < kAbove ? 0.12 : 0.0);
    return {.linear = towards(X_WB.p + above - X_WT.p, t < kAbove ? 0.25 : 0.08),
            .angular = towards(rotation_log(R * X_WT.R.transpose()), 1),
            .grip = -2};
  }

  Arm arm_;
  std::vector<SceneObject> objects_;
  RandomHand hand_;
  Rng rng_;
  double from_ = -kCarried;
  int body_ = -1;
};

/// Contacts that the arm should never have, by MuJoCo's own list and the tree of bodies: of links,
/// hand and fingers with anything, but of fingers with bodies that have a free joint, and of the
/// hand's parts with each other. What moves is nobody's fault: a thing that is let go falls on a
/// hand that points upwards, or on an upper arm, where it may come to rest and roll about.
class ForbiddenContacts {
 public:
  explicit ForbiddenContacts(const Robot& robot)
      : m_(*robot.model.raw()), moved_(static_cast<std::size_t>(m_.nbody), false) {
    const int first = m_.dof_bodyid[robot.arm.joints.front().dof];
    const int last = m_.dof_bodyid[robot.arm.joints.back().dof];
    for (int b = 0; b < static_cast<int>(m_.nbody); ++b) {
      arm_.push_back(b > 0 && (b == first || arm_[static_cast<std::size_t>(m_.body_parentid[b])]));
      hand_.push_back(b > 0 && (b == last || hand_[static_cast<std::size_t>(m_.body_parentid[b])]));
      finger_.push_back(hand_.back() && b != last && m_.body_jntnum[b] > 0);
    }
  }

  /// The first of them as "left_finger - table"; empty: none. To be called after each period.
  [[nodiscard]] std::string first(const Sim& sim) {
    std::string out;
    for (const Contact& contact : sim.contacts()) {
      if (contact.depth <= 0 || contact.body1 < 0 || contact.body2 < 0) continue;
      const std::pair pair(contact.body1, contact.body2);
      if (!is_bad(pair.first, pair.second) && !is_bad(pair.second, pair.first)) continue;
      const bool fell = moved_[static_cast<std::size_t>(pair.first)] ||
                        moved_[static_cast<std::size_t>(pair.second)] || fallen_.contains(pair);
      if (fell) fallen_.insert(pair);
      if (!fell && out.empty()) out = contact.first + " - " + contact.second;
    }
    for (int b = 0; b < static_cast<int>(m_.nbody); ++b) {
      if (!is_free(b)) continue;
      const std::span<const double> v =
          sim.qvel().subspan(static_cast<std::size_t>(m_.jnt_dofadr[m_.body_jntadr[b]]), 3);
      moved_[static_cast<std::size_t>(b)] = std::hypot(v[0], v[1], v[2]) > kStill;
    }
    return out;
  }

 private:
  bool is_free(int body) const {
    return m_.body_jntnum[body] > 0 && m_.jnt_type[m_.body_jntadr[body]] == mjJNT_FREE;
  }
  bool is_bad(int body, int other) const {
    const auto b = static_cast<std::size_t>(body), o = static_cast<std::size_t>(other);
    if (!arm_[b] || (hand_[b] && hand_[o])) return false;
    return !(finger_[b] && is_free(other));
  }

  static constexpr double kStill = 0.01;  // [m/s]
  const mjModel& m_;
  std::vector<bool> moved_;               // things in the period before
  std::set<std::pair<int, int>> fallen_;  // contacts that began by something that moved
  std::vector<bool> arm_, hand_, finger_;
};

/// How a drive went.
struct DriveResult {
  std::string contact;       ///< the first that should not be; empty: none
  double time = 0;           ///< [s] of it, or of the end
  double way = 0;            ///< [m] of the tool
  double slowed = 0;         ///< share of the periods with input in which something was near
  double held = 0;           ///< [s] something was held
  std::vector<double> qpos;  ///< at the end
};

/// Drives a robot at random for `seconds` of simulated time, or until something touches. What fell
/// from the table is put back every now and then.
inline DriveResult drive(const Robot& robot, const TeleopOptions& options, std::uint64_t seed,
                         double seconds) {
  constexpr double kAgain = 60;  // [s]
  Sim sim(robot.model);
  Result<Teleop> teleop = Teleop::create(robot, options);
  if (!teleop) throw std::runtime_error(teleop.error().what);
  std::optional<GraspingHand> hand;
  std::optional<ForbiddenContacts> forbidden;
  DriveResult out;
  int near = 0, all = 0;
  Eigen::Vector3d p;
  double before = 0;  // [s] up to the last time things were put back
  while (before + sim.time() < seconds && out.contact.empty()) {
    if (!hand || sim.time() >= kAgain) {
      before += sim.time();
      sim.reset_home();
      sim.place(robot.arm, as_span(robot.arm.home));
      teleop->begin(sim);
      forbidden.emplace(robot);
      hand.emplace(robot, seed + 1000 * static_cast<std::uint64_t>(before));
      p = sim.tool(robot.arm).p;
    }
    if (auto done = teleop->advance(sim, hand->at(sim)); !done) {
      throw std::runtime_error(done.error().what);
    }
    out.contact = forbidden->first(sim);
    const TeleopState state = teleop->state();
    near += state.limit == TeleopLimit::near ? 1 : 0;
    out.held += state.held.empty() ? 0 : teleop->period();
    ++all;
    const Eigen::Vector3d now = sim.tool(robot.arm).p;
    out.way += (now - std::exchange(p, now)).norm();
  }
  out.time = before + sim.time();
  out.slowed = static_cast<double>(near) / all;
  out.qpos.assign(sim.qpos().begin(), sim.qpos().end());
  return out;
}

}  // namespace mjarm::testing
