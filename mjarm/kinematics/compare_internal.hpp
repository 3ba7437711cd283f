#pragma once

#include <vector>

#include "mjarm/kinematics/compare.hpp"

namespace mjarm {

/// Differences below this do not count as a cause [m], [rad].
struct CauseTolerance {
  double value = 1e-7;
};

/// Explains `second` by changes to `first`, joint by joint as both are written.
[[nodiscard]] std::vector<Cause> explain_as_written(const Arm& first, const Arm& second,
                                                    CauseTolerance tolerance);

/// Explains `second` by changes to `first` from their screw axes, one list for each way to begin
/// at the base.
[[nodiscard]] std::vector<std::vector<Cause>> explain_by_screws(const Arm& first, const Arm& second,
                                                                CauseTolerance tolerance);

/// Adds what is left between `first` with the causes so far and `second` at zero, as a cause of the
/// tool.
void add_tool(const Arm& first, const Arm& second, CauseTolerance tolerance,
              std::vector<Cause>& causes);

/// For each joint of `second` the index of its partner in `first`: by name where all are found and
/// `by_name` is set, else by order.
[[nodiscard]] std::vector<int> match_joints(const Arm& first, const Arm& second, bool& by_name);

}  // namespace mjarm
