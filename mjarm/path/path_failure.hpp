#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "mjarm/collision/exact.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/kinematics/singularity.hpp"
#include "mjarm/path/joint_path.hpp"

namespace mjarm {

/// Why a path stops.
enum class PathErrc {
  out_of_reach,  ///< the pose is farther than the arm can stretch (up to `amount` m from there on)
  inner_void,    ///< it lies where the arm cannot fold into (up to `amount` m from there on)
  joint_limit,   ///< the arm goes on only with `joint` beyond its limit by `amount` rad or m
  singularity,   ///< it goes on, but `joint` would have to race (`amount` rad or m in one step)
  collision,     ///< it goes on, but `pair` would overlap by up to `amount` m
  branch_flip,   ///< only other answers go on, `amount` rad or m away in `joint`
  joint_speed,   ///< it goes on, but at the speed asked for `joint` would have to be faster than
                 ///< its limit by `amount` rad/s or m/s
  no_convergence,  ///< no answer was found; not a proof
  stopped,         ///< PathOptions::stop ended the work; nothing is known of the rest
  bad_input,       ///< NaN, a matrix that is no rotation, sizes that do not fit
};

/// The word used in files: "out_of_reach", "inner_void", ...
[[nodiscard]] std::string_view name(PathErrc code) noexcept;

/// Why a path has no answer, and what was had before that.
struct PathFailure {
  PathErrc code = PathErrc::no_convergence;
  std::size_t at = 0;   ///< index of the first pose that cannot be had
  double fraction = 0;  ///< share of the poses before it, 0 to 1; of a curve: of its parameter
  double s = 0;         ///< parameter of the last answer before it
  double amount = 0;    ///< see PathErrc
  int joint = -1;       ///< which joint, where the reason is about one
  SingularKind kind = SingularKind::none;  ///< which singularity
  double smallest = 0;                     ///< smallest singular value met there (singularity)
  GeomPair pair;      ///< what touches (collision), empty where only a predicate refused
  IkFailure ik;       ///< that of the pose alone (out_of_reach, inner_void, ...)
  JointPath partial;  ///< answers before it; never to be executed unasked
};

/// One line for people: the place, what is wrong and by how much.
[[nodiscard]] std::string describe(const PathFailure& failure, const Arm& arm);

}  // namespace mjarm
