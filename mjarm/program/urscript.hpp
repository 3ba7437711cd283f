#pragma once

#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/program/program_plan.hpp"

namespace mjarm::program {

/// How a plan is written for a controller of Universal Robots. Every default is usable as is.
struct UrscriptOptions {
  std::string version = {};  ///< of mjarm, told in the head of the script; may be empty
  /// Curves that URScript has no word for become points, between which the straight lines leave
  /// the curve by at most this.
  double pos_tol = 1e-4;  ///< [m]   > 0
  double rot_tol = 1e-3;  ///< [rad] > 0, likewise for the orientation
};

/// `plan` of `program` in URScript: one function, and its call. Tool poses are in the controller's
/// base frame, wherever the arm stands in the world; joint moves have the plan's joint values, so
/// that the arm takes the planned branch. The speed of a statement is the plan's greatest on it,
/// the acceleration such that ramps and a stretch at that speed take as long as the plan (about as
/// long where blended moves differ in speed). The text is ASCII; equal input gives equal bytes,
/// whatever the language.
/// @return an error where the plan has faults, or where the arm is none of Universal Robots: by the
///         names of its joints, and by where their axes are.
[[nodiscard]] Result<std::string> to_urscript(const Program& program, const Robot& robot,
                                              const ProgramPlan& plan,
                                              const UrscriptOptions& options = {});

}  // namespace mjarm::program
