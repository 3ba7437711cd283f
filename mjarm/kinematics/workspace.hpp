#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm {

/// Which points of space are asked for, and how the tool stands there. Every default is usable as
/// is.
struct WorkspaceOptions {
  int normal = 2;      ///< axis of the world the slice stands across: 0 = x, 1 = y, 2 = z
  double at = 0.4;     ///< [m] where the slice cuts that axis
  double step = 0.02;  ///< [m] edge of a cell, > 0
  std::optional<Eigen::Matrix3d> R_WT = {};  ///< how the tool stands; none: any way will do
  int threads = 1;                           ///< >= 1; the map is the same for any number
  /// Told how many cells have been done since the last time, from any thread. May be empty.
  std::function<void(std::size_t cells)> progress = {};
  StopCheck stop = {};
};

/// Where the tool can go on a slice of space. A cell is a square about its middle; the middles
/// stand at multiples of the step.
struct WorkspaceMap {
  int u = 0;             ///< axis of the world along a row, the lower one of the two
  int v = 1;             ///< axis of the world from row to row
  int columns = 0;       ///< cells of a row
  int rows = 0;          ///< > 0; what cannot be reached is cut off, but for one cell all round
  double u_first = 0;    ///< [m] middle of the first column
  double v_first = 0;    ///< [m] middle of the first row
  double step = 0;       ///< [m]
  bool counted = false;  ///< false: the arm has joints to spare, so there is no number of answers
  std::vector<int> branches = {};  ///< shape (rows, columns): answers apart from windings;
                                   ///< 1 for any where they are not counted, 0 for none
  /// Likewise; the best of the answers, where they are not counted that of the one found; NaN for
  /// none.
  std::vector<double> manipulability = {};

  /// [m] middle of a column, of a row.
  [[nodiscard]] double u_at(int column) const { return u_first + step * column; }
  [[nodiscard]] double v_at(int row) const { return v_first + step * row; }
};

/// Asks the inverse kinematics of every cell that the arm could stretch to.
/// @return bad_input for a step that is not positive, usage for more than 10^7 cells or an arm with
///         endless slides, impossible where the tool reaches no cell, system where `stop` ended
///         the work.
[[nodiscard]] Result<WorkspaceMap> map_workspace(const Arm& arm, const WorkspaceOptions& options);

}  // namespace mjarm
