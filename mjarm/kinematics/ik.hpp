#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/kinematics/chain.hpp"
#include "mjarm/kinematics/general_six.hpp"
#include "mjarm/kinematics/link_chain.hpp"
#include "mjarm/kinematics/reach.hpp"
#include "mjarm/kinematics/seven_axis.hpp"
#include "mjarm/kinematics/six_axis.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm {

/// Why a pose has no answer.
enum class IkErrc {
  out_of_reach,    ///< farther than the arm can stretch (`amount` m too far)
  inner_void,      ///< inside a region the arm cannot fold into (`amount` m too near)
  joint_limit,     ///< reached only with `joint` beyond its limit by `amount` rad or m
  collision,       ///< answers exist, the validity predicate refused them all
  no_convergence,  ///< no answer found in the given number of restarts; not a proof
  too_far,         ///< answers exist, all with `joint` more than `max_step` from the seed
  bad_input,       ///< NaN, a matrix that is no rotation, a seed of the wrong size
};

/// The word used in files: "out_of_reach", "inner_void", ...
[[nodiscard]] std::string_view name(IkErrc code) noexcept;

/// What of a goal pose must be met.
enum class IkTask {
  pose,      ///< position and orientation
  position,  ///< position alone, as for an arm of fewer than six joints; any orientation will do
  axis,      ///< position and direction of the tool's z axis; the turn about it is free
};
/// The words for them: "pose", "position", "axis".
[[nodiscard]] std::span<const std::string_view> ik_task_names() noexcept;
/// The most that an arm can do everywhere: with fewer than six joints it cannot turn its tool as it
/// likes.
[[nodiscard]] IkTask task_for(const Arm& arm) noexcept;

/// How hard to try, and when to call it solved. Every default is usable as is.
struct IkOptions {
  double pos_tol = 1e-7;       ///< [m]   |p_goal - p|, > 0
  double rot_tol = 1e-7;       ///< [rad] angle of R^T R_goal, or between the z axes, > 0
  int max_iterations = 100;    ///< steps a start, > 0
  int restarts = 100;          ///< random seeds tried after q_seed, >= 0
  std::uint64_t seed = 1;      ///< same inputs and seed, same answer
  bool closed_form = true;     ///< false: by the numeric search even where a closed form is known
  IkTask task = IkTask::pose;  ///< with `position`, rot_tol plays no part
  /// [rad or m] farthest that any joint may be from the seed, > 0: rather no answer than a flip.
  double max_step = std::numeric_limits<double>::infinity();
  /// Accepts or refuses a configuration (collision, taste); empty accepts all. Must not throw.
  std::function<bool(std::span<const double> q)> valid = {};
};

/// A configuration and how far its tool is from the goal.
struct IkSolution {
  JointVec q;          ///< [rad or m] within the limits
  double pos_err = 0;  ///< [m]
  double rot_err = 0;  ///< [rad] with `axis` that between the z axes, with `position` 0
  int iterations = 0;  ///< steps taken in all
  int restarts = 0;    ///< random starts used; 0 = solved from the seed
};

/// Why a solve failed, and the closest configuration it met.
struct IkFailure {
  IkErrc code = IkErrc::no_convergence;
  IkSolution best;    ///< closest attempt, within the limits
  double amount = 0;  ///< how far beyond: [m] for reach and void, [rad or m] for a joint
  double bound = 0;   ///< [m] the radius that is broken (out_of_reach, inner_void), else 0
  ReachShape shape = ReachShape::none;  ///< round what that radius is (out_of_reach, inner_void)
  int joint = -1;                       ///< which joint, for joint_limit and too_far
};

/// One line for people: what is wrong and by how much.
[[nodiscard]] std::string describe(const IkFailure& failure, const Arm& arm);

/// Inverse kinematics of one arm. A value: copy it to use it from another thread.
class IkSolver {
 public:
  /// For options that a user chose.
  /// @return bad_input: one line that names the first option out of its range, or that says that
  /// the arm has no joints or too many.
  [[nodiscard]] static Result<IkSolver> create(const Arm& arm, IkOptions options);
  /// For options that are known to be in their ranges: with others every solve is bad_input.
  explicit IkSolver(const Arm& arm, IkOptions options = {});
  /// The same arm with other options, whose geometry need not be looked at again.
  [[nodiscard]] IkSolver with(IkOptions options) const;

  /// Finds q with fk(q) within tolerance of `X_WT`. Where a closed form is known (six_axis.hpp,
  /// seven_axis.hpp), the answer nearest to `q_seed` by the largest joint distance, then by the
  /// sum, that `options.valid` accepts; else the first that a search from `q_seed`, then from
  /// random starts, finds. Every hinge stands in its winding nearest to `q_seed`.
  /// @param X_WT    tool pose in the world frame, translation in [m]; its matrix orthonormal to
  /// 1e-6.
  /// @param q_seed  [rad or m] shape (dof,); clamped to the limits before use.
  /// @return IkFailure with the reason and the best attempt. out_of_reach and inner_void are proofs
  ///         from geometry (reach.hpp); with an exact closed form every reason is one, but where a
  ///         joint is nearly free. There, and with a form that is not exact, the numeric search has
  ///         found nothing either; without a form the reasons tell what it met. Never throws, never
  ///         allocates (but for what `options.valid` does).
  [[nodiscard]] Result<IkSolution, IkFailure> solve(const Pose& X_WT,
                                                    std::span<const double> q_seed) const noexcept;

  [[nodiscard]] const Arm& arm() const noexcept { return arm_; }
  [[nodiscard]] const IkOptions& options() const noexcept { return options_; }
  /// What the arm can never reach.
  [[nodiscard]] const Reach& reach() const noexcept { return reach_; }
  [[nodiscard]] const Chain& chain() const noexcept { return chain_; }
  /// The same, made for fast forward kinematics.
  [[nodiscard]] const LinkChain& links() const noexcept { return links_; }
  /// The closed form in use, if any.
  [[nodiscard]] const std::optional<SixAxis>& six_axis() const noexcept { return six_; }
  /// The same of seven axes.
  [[nodiscard]] const std::optional<SevenAxis>& seven_axis() const noexcept { return seven_; }
  /// What finds all branches of six hinges where no closed form does exactly (solve_all()).
  [[nodiscard]] const std::optional<GeneralSix>& general_six() const noexcept { return general_; }
  /// [m] position error that weighs as much as 1 rad in the numeric search.
  [[nodiscard]] double length() const noexcept { return length_; }

 private:
  Arm arm_;
  IkOptions options_;
  Chain chain_;
  LinkChain links_;
  Reach reach_;
  std::optional<SixAxis> six_;
  std::optional<SevenAxis> seven_;
  std::optional<GeneralSix> general_;
  double length_ = 1;
};

}  // namespace mjarm
