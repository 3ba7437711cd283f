#pragma once

#include <optional>

#include "mjarm/path/path_fix.hpp"

namespace mjarm::program::detail {

/// A way of the tool that cannot be gone, and how it was tried.
struct ClosedWay {
  Curve curve;
  JointVec q_start;  ///< [rad or m] (dof,) where the arm was before
  CurveOptions options = {};
};

/// The least change with which all of it was solved; none where it is not known what stops it, or
/// where none was found.
[[nodiscard]] std::optional<PathFix> find_fix(const IkSolver& ik, const ClosedWay& way);

}  // namespace mjarm::program::detail
