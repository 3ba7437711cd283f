#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mjarm/kinematics/ik.hpp"
#include "mjarm/kinematics/singularity.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {

/// Which limit of a joint holds a tool back.
enum class SpeedLimit { velocity, acceleration, jerk };

/// The word used in files: "velocity", "acceleration" or "jerk".
[[nodiscard]] std::string_view name(SpeedLimit limit) noexcept;

/// A stretch of a motion on which the tool is slower than asked.
struct SpeedDip {
  double s_from = 0, s_to = 0;  ///< parameters of the curve
  double t_from = 0, t_to = 0;  ///< [s]
  double least = 0;             ///< [m/s] lowest speed ([rad/s] in a turn on the spot)
  double s_least = 0;           ///< parameter of the curve where that is
  /// The one that would exceed a limit most there, at the speed asked for; where none would, as the
  /// tool is on its way to that speed, the one that is nearest to a limit.
  int joint = -1;
  SpeedLimit limit = SpeedLimit::velocity;  ///< which one
  double use = 0;  ///< share of that limit which the speed asked for would take, or the motion does
  double kept = 1;  ///< share of the speed asked for at which no joint would, all along the dip
  SingularKind kind = SingularKind::none;  ///< the singularity nearby, where there is one
};

/// One line for people.
[[nodiscard]] std::string describe(const SpeedDip& dip, const Arm& arm);

/// Where the tool, timed by time_tool_path() along `curve` with stops at its corners, is over 1 %
/// slower than asked, ascending. Speeding up from stops and slowing down to them as gently as the
/// options want it does not count, nor does half as much way again.
[[nodiscard]] std::vector<SpeedDip> find_speed_dips(const IkSolver& ik, const Curve& curve,
                                                    const Trajectory& trajectory,
                                                    const TimingOptions& options);

}  // namespace mjarm
