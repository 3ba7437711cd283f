#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// What a moving arm keeps from what is round it. Every default is usable as is.
struct WatchOptions {
  double margin = 5e-3;       ///< [m] between exact geometry, > 0
  double held_margin = 1e-3;  ///< [m] > 0; of what the gripper holds, which is to be put down
};

/// Two bodies that are near to each other.
struct NearBodies {
  std::string body1, body2;
  double distance = 0;  ///< [m] between their surfaces; negative where they overlap
};

/// Watches an arm that goes wherever somebody leads it among things that move: tells of short ways
/// ahead whether they keep the margin, in exact geometry. By MuJoCo's rules about what collides,
/// but
/// - fingers count wherever the gripper can have them, so that it can always open and close;
/// - fingers may touch bodies that can be carried away (those with a free joint);
/// - a held body goes with the hand and keeps WatchOptions::held_margin from all but the hand.
///
/// Pairs that are proved never to meet are left out. Things that move by themselves stand still in
/// the look ahead. Owns its scratch memory: one a thread.
class SceneWatch {
 public:
  /// @return not_available where something in the scene has a shape whose distance cannot be
  /// measured (height fields, flexible bodies, signed distance fields); bad_input for margins that
  /// are not positive, or an arm that is not of the model.
  [[nodiscard]] static Result<SceneWatch> create(const Model& model, const Arm& arm,
                                                 const WatchOptions& options = {});
  ~SceneWatch();
  SceneWatch(SceneWatch&&) noexcept;
  SceneWatch& operator=(SceneWatch&&) noexcept;

  /// Where all stands now.
  /// @param qpos   (nq,) of the model.
  /// @param q_ref  (dof,) [rad or m] where the arm is led; by what it is elsewhere in `qpos` all
  ///               margins grow.
  /// @param held   number of a body with a free joint that is held; -1: none.
  void take(std::span<const double> qpos, const JointVec& q_ref, int held);

  /// What was found on a way.
  struct Verdict {
    bool free = true;
    int pair = -1;        ///< where it is not: of near()
    double distance = 0;  ///< [m] of it there
  };
  /// Whether the way from take()'s `q_ref` straight to `q1`, and straight on to `q2`, is free: each
  /// pair keeps its margin. One that is nearer already may not come nearer; but for a fiftieth of
  /// the way along each other as long as it keeps half the margin. Conservative advancement (B.
  /// Mirtich, Impulse-based dynamic simulation, 1996, ch. 2): from one look to the next no more
  /// than a fifth of the margin, or what is left up to it, can be lost, by the distances of the
  /// geoms from the joints' axes.
  [[nodiscard]] Verdict check_way(const JointVec& q1, const JointVec& q2);

  /// The names of a pair.
  [[nodiscard]] NearBodies near(const Verdict& verdict) const;
  /// Of what was measured at `q_ref` since take() and is nearer than 0.1 m the nearest pair.
  [[nodiscard]] std::optional<NearBodies> nearest() const;
  /// Pairs of geoms that are watched.
  [[nodiscard]] std::size_t pairs() const;

 private:
  struct Impl;
  explicit SceneWatch(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm
