#pragma once

#include <optional>
#include <vector>

#include "mjarm/core/json.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/path/curve.hpp"

namespace mjarm {

/// A path to be solved: either given poses or a curve.
struct PathRequest {
  std::vector<Pose> poses;               ///< `poses`, `ellipse` with `points`
  std::optional<Curve> curve;            ///< the other types
  std::optional<std::vector<double>> q;  ///< [rad or m] `start`
  std::optional<double> max_step;        ///< [rad or m] > 0
  std::optional<double> speed;           ///< [m/s] the tool is to keep, > 0
  std::optional<double> tilt;            ///< [rad] `orientation_tol`, in [0, pi/2)
};

/// Reads one request: `"type"` is one of poses (with `"poses"`), line (`"from"`, `"to"`), arc
/// (`"from"`, `"via"`, `"to"`), polyline (`"points"`, `"blend"` [m]) and ellipse (`"center"`,
/// `"a"`,
/// `"b"`, `"normal"`, `"quat"`, maybe `"points"`); a pose is `{"pos":[3],"quat":[4]}`.
/// @return an error that names the member.
[[nodiscard]] Result<PathRequest> path_request_of(const JsonValue& object, const Arm& arm);

/// Checks that a tolerance of orientation [rad] is in [0, pi/2).
[[nodiscard]] Result<void> check_tilt(double tilt);

}  // namespace mjarm
