#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "mjarm/planning/cell_tree_internal.hpp"

namespace mjarm::detail {

/// Looks whether cells lead from one place to another: follows the channels with the fewest mixed
/// cells and cuts these, until they are shut or open, or the work is spent (D. Zhu and J.-C.
/// Latombe, New heuristic algorithms for efficient hierarchical path planning, IEEE Transactions on
/// Robotics and Automation 7 (1991) 9).
class CellChannel {
 public:
  enum class Outcome {
    shut,    ///< no cell leads from one to the other
    open,    ///< open cells do
    spent,   ///< the work is
    unclear  ///< cells do that are as small as they get
  };

  /// @param from  a place that is free.
  CellChannel(CellTree& tree, const Eigen::Vector3d& from, const Eigen::Vector3d& to)
      : tree_(tree), ends_{from, to} {}

  /// @param work  to be spent, at most.
  [[nodiscard]] Outcome run(std::int64_t work);

  /// What an end that is shut in can reach.
  struct Room {
    double volume = 0;    ///< [m^3]
    double smallest = 0;  ///< [m] width of a cell
  };
  /// After Outcome::shut.
  /// @param end  0: `from`, 1: `to`.
  [[nodiscard]] Room room(int end) const;

 private:
  static constexpr int kNever = -1;
  /// How many mixed cells come before each cell, itself included; kNever where that is not known.
  using Depths = std::vector<int>;

  /// @param most  depth that matters.
  void flood(int from, int most, int to, Depths& out);
  [[nodiscard]] bool cut_shortest(int from, int to);

  CellTree& tree_;
  std::array<Eigen::Vector3d, 2> ends_;
  std::array<Depths, 2> depths_;
};

}  // namespace mjarm::detail
