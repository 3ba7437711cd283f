#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mjarm/kinematics/ik.hpp"
#include "mjarm/kinematics/link_chain.hpp"
#include "mjarm/kinematics/posture.hpp"
#include "mjarm/path/solve_path.hpp"

namespace mjarm::detail {

/// How good the best track to an answer is; smaller is better.
struct TrackRank {
  double tightness = 0;  ///< worst of the track, in [comfort, 1]
  double posture = 0;    ///< sum of PostureCost; 0 where nobody asks for it
  double start = 0;      ///< [rad or m] largest joint distance of its first answer from q_start
  double length = 0;     ///< [rad or m] sum of the steps' norms
  [[nodiscard]] bool operator<(const TrackRank& other) const noexcept;
};

/// One answer to one pose, and the best track that leads to it.
struct TrackNode {
  JointVec q;
  int parent = -1;  ///< index in the layer before
  TrackRank rank;
  bool aside = false;  ///< the track has moved aside within itself
};

/// The answers to one pose that tracks lead to, best first.
using Layer = std::vector<TrackNode>;

/// For the same arm with joints that turn as far as they like.
[[nodiscard]] IkSolver without_limits(const IkSolver& ik);

/// X_WT turned to where the tool would rather stand, by no more than `tol` [rad].
[[nodiscard]] Pose turned_to(const Pose& X_WT, const Eigen::Matrix3d& R_WT, double tol);

/// Makes the answers to each pose out of those to the pose before.
class PathLayers {
 public:
  /// What is looked at in a configuration by itself.
  struct Room {
    double tightness = 0;                  ///< limits left aside
    double clearance = PostureCost::kFar;  ///< [m], where it is looked at
  };

  /// One way in which an arm of six axes answers a pose, in one winding, limits left aside.
  struct Branch {
    JointVec q;
    std::optional<Room> room = {};  ///< none: refused, or not looked at
    bool looked_at = false;
  };

  static constexpr std::size_t kMaxNodes = 512;    ///< a layer; the best are kept
  static constexpr std::size_t kMaxFollowed = 96;  ///< likewise without a closed form of six axes

  /// Keeps references to both.
  PathLayers(const IkSolver& ik, const PathOptions& options);

  /// All answers to the first pose; empty where there is none.
  [[nodiscard]] Layer first(const Pose& X_WT, const JointVec& q_start) const;
  /// All that tracks lead to at X_WT from `before`, which is not empty, at the pose X_before.
  /// @param branches  what is known of X_WT, which other tracks need again; empty: nothing yet.
  [[nodiscard]] Layer next(const Pose& X_before, const Pose& X_WT, const Layer& before,
                           std::vector<Branch>& branches) const;

  /// The answer to X_WT that goes on from `q`, limits and whatever may be touched left aside: the
  /// nearest one. None where there is no answer.
  [[nodiscard]] std::optional<JointVec> onward(const Pose& X_WT, const JointVec& q) const;
  /// The solver that knows no limits.
  [[nodiscard]] const IkSolver& boundless() const noexcept { return boundless_; }
  [[nodiscard]] const IkSolver& ik() const noexcept { return ik_; }
  [[nodiscard]] const PathOptions& options() const noexcept { return options_; }
  /// Longest step of each joint from pose to pose.
  [[nodiscard]] JointVec longest_step(const Pose& X_before, const Pose& X_WT) const;
  [[nodiscard]] double smallest_singular_value(const JointVec& q) const;
  /// `q` is within the limits, and as far from them as a track of that tightness is.
  [[nodiscard]] bool fits(const JointVec& q, double tightness) const;
  /// The same of all that tightness is about, but for the steps, and with a tolerance for
  /// singularities; and `q` is not refused.
  [[nodiscard]] bool has_room(const JointVec& q, double tightness) const;
  /// A solver from seeds whose limits are those that has_room() asks for.
  [[nodiscard]] IkSolver within(double tightness) const;
  /// How long the step from the pose X_before to X_WT is, as a share of what is allowed.
  [[nodiscard]] double step_share(const Pose& X_before, const Pose& X_WT,
                                  const JointVec& step) const;

 private:
  [[nodiscard]] std::vector<Pose> allowed(const Pose& X_WT) const;
  [[nodiscard]] std::vector<Branch> branches_at(const Pose& X_WT, const JointVec& q_seed) const;
  [[nodiscard]] Layer join(const Layer& before, const JointVec& longest,
                           std::vector<Branch>& branches) const;
  [[nodiscard]] Layer follow(const Pose& X_WT, const Layer& before, const JointVec& longest) const;
  [[nodiscard]] std::vector<JointVec> aside(const JointVec& q) const;
  [[nodiscard]] std::optional<Room> room(const JointVec& q) const;
  [[nodiscard]] double limit_tightness(const JointVec& q) const;
  [[nodiscard]] double singular_tightness(const JointVec& q) const;
  [[nodiscard]] double posture_cost(const JointVec& q, const Room& room, double start) const;
  [[nodiscard]] TrackRank extended(const TrackNode& node, const JointVec& q, const Room& room,
                                   const JointVec& longest) const;
  [[nodiscard]] double level(double tightness) const;

  const IkSolver& ik_;
  const PathOptions& options_;
  IkSolver all_;        // answers within the limits, whatever they touch
  IkSolver near_;       // the same within max_step of the seed, no random starts
  IkSolver boundless_;  // the same without limits
  LinkChain chain_;
  std::optional<PostureCost> posture_;  // none where postures do not count
};

}  // namespace mjarm::detail
