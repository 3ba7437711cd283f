#pragma once

#include <vector>

#include "mjarm/core/joint_state.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/identification/joint_log.hpp"

namespace mjarm::detail {

/// A log without its noise: at each row the polynomial of fourth order that is nearest to the rows
/// about it (A. Savitzky, M. Golay, Analytical Chemistry 36 (1964) 1627). It shifts nothing in time
/// and treats positions and torques alike, so that what holds between them goes on to hold.
struct SmoothLog {
  double timestep = 0;            ///< [s]
  int half = 0;                   ///< rows to either side of each that count
  std::vector<JointState> state;  ///< of all rows but `half` at both ends
  std::vector<JointVec> torque;   ///< as many
};

/// @return bad_input for a log that is too short or too coarse in time; stopped().
[[nodiscard]] Result<SmoothLog> smooth(const JointLog& log, const StopCheck& stop = {});

}  // namespace mjarm::detail
