#include "mjarm/kinematics/workspace.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "mjarm/core/messages/kinematics.hpp"
#include "mjarm/core/threads.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik_all.hpp"

namespace mjarm {
namespace {

constexpr double kMaxCells = 1e7;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// [m] the tool is never farther from the first joint's frame than this; infinite for endless
/// slides.
double stretch(const Arm& arm) {
  double length = arm.X_JT.p.norm();
  for (int i = 0; i < arm.dof(); ++i) {
    if (i > 0) length += arm.joints[static_cast<std::size_t>(i)].X_PJ.p.norm();
    if (arm.joints[static_cast<std::size_t>(i)].type == JointType::slide) {
      length += std::max(std::abs(arm.limits.lower[i]), std::abs(arm.limits.upper[i]));
    }
  }
  return length;
}

/// The cells that the arm could stretch to, none asked yet.
WorkspaceMap grid(const Arm& arm, const WorkspaceOptions& options, double radius) {
  WorkspaceMap map{.u = options.normal == 0 ? 1 : 0, .v = options.normal == 2 ? 1 : 2};
  const Eigen::Vector3d& p_W0 = arm.joints.front().X_PJ.p;
  const auto first = [&](int axis) { return std::floor((p_W0[axis] - radius) / options.step); };
  const auto count = [&](int axis) {
    return static_cast<int>(std::ceil((p_W0[axis] + radius) / options.step) - first(axis)) + 1;
  };
  map.step = options.step;
  map.columns = count(map.u);
  map.rows = count(map.v);
  map.u_first = options.step * first(map.u);
  map.v_first = options.step * first(map.v);
  map.counted = arm.dof() <= (options.R_WT ? 6 : 3);
  const std::size_t cells = static_cast<std::size_t>(map.columns) * map.rows;
  map.branches.assign(cells, 0);
  map.manipulability.assign(cells, kNone);
  return map;
}

/// Manipulability, of the position alone where the orientation is free.
double freedom(const Arm& arm, const JointVec& q, bool with_orientation) {
  const Jacobian J = fk_jacobian(arm, as_span(q)).J_W;
  if (with_orientation) return manipulability(J);
  const Eigen::Matrix3d square = J.topRows<3>() * J.topRows<3>().transpose();
  return std::sqrt(std::max(0.0, square.determinant()));
}

/// Asks for one row; each cell by itself, so that the order of the rows does not matter.
void fill_row(const IkSolver& ik, const WorkspaceOptions& options, int row, WorkspaceMap& map) {
  const Arm& arm = ik.arm();
  Pose X_WT{{0, 0, 0}, options.R_WT.value_or(Eigen::Matrix3d::Identity())};
  X_WT.p[options.normal] = options.at;
  X_WT.p[map.v] = map.v_at(row);
  for (int column = 0; column < map.columns && !is_stopped(options.stop); ++column) {
    X_WT.p[map.u] = map.u_at(column);
    std::vector<IkSolution> answers;
    if (map.counted) {
      answers = solve_all(ik, X_WT, as_span(arm.home)).value_or(answers);
    } else if (auto answer = ik.solve(X_WT, as_span(arm.home))) {
      answers.push_back(*answer);
    }
    if (answers.empty()) continue;
    const std::size_t cell = static_cast<std::size_t>(row) * map.columns + column;
    map.branches[cell] = static_cast<int>(answers.size());
    double best = 0;
    for (const IkSolution& answer : answers) {
      best = std::max(best, freedom(arm, answer.q, options.R_WT.has_value()));
    }
    map.manipulability[cell] = best;
  }
}

/// Works the rows off in some threads; false where it was stopped.
bool fill(const Arm& arm, const WorkspaceOptions& options, WorkspaceMap& map) {
  const IkSolver ik(arm, {.task = options.R_WT ? IkTask::pose : IkTask::position});
  std::atomic<int> next_row = 0;
  run_in_threads(std::min(options.threads, map.rows), [&](int) {
    const IkSolver mine = ik;
    for (int row = next_row++; row < map.rows && !is_stopped(options.stop); row = next_row++) {
      fill_row(mine, options, row, map);
      if (options.progress) options.progress(static_cast<std::size_t>(map.columns));
    }
  });
  return !is_stopped(options.stop);
}

/// Cuts the border that is not reached off, but for one cell; false where nothing is reached.
bool crop(WorkspaceMap& map) {
  int left = map.columns, right = -1, low = map.rows, high = -1;
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      if (map.branches[static_cast<std::size_t>(row) * map.columns + column] == 0) continue;
      left = std::min(left, column);
      right = std::max(right, column);
      low = std::min(low, row);
      high = std::max(high, row);
    }
  }
  if (right < 0) return false;
  left = std::max(left - 1, 0);
  right = std::min(right + 1, map.columns - 1);
  low = std::max(low - 1, 0);
  high = std::min(high + 1, map.rows - 1);
  WorkspaceMap cut = map;
  cut.columns = right - left + 1;
  cut.rows = high - low + 1;
  cut.u_first = map.u_at(left);
  cut.v_first = map.v_at(low);
  cut.branches.clear();
  cut.manipulability.clear();
  for (int row = low; row <= high; ++row) {
    const auto from = static_cast<std::ptrdiff_t>(row) * map.columns + left;
    const auto to = from + cut.columns;
    cut.branches.insert(cut.branches.end(), map.branches.begin() + from, map.branches.begin() + to);
    cut.manipulability.insert(cut.manipulability.end(), map.manipulability.begin() + from,
                              map.manipulability.begin() + to);
  }
  map = std::move(cut);
  return true;
}

}  // namespace

Result<WorkspaceMap> map_workspace(const Arm& arm, const WorkspaceOptions& options) {
  if (!(options.step > 0) || !std::isfinite(options.at)) {
    return fail(Errc::bad_input, text(msg::kinematics_workspace_step, options.step));
  }
  const double radius = stretch(arm);
  if (!std::isfinite(radius)) return fail(Errc::usage, text(msg::kinematics_workspace_endless));
  const double across = 2 * radius / options.step + 3;
  if (across * across > kMaxCells) {
    return fail(Errc::usage, text(msg::kinematics_workspace_cells, options.step,
                                  2 * radius / (std::sqrt(kMaxCells) - 3), kMaxCells));
  }
  WorkspaceMap map = grid(arm, options, radius);
  if (!fill(arm, options, map)) {
    return fail(stopped());
  }
  if (crop(map)) return map;
  return fail(Errc::impossible, text(msg::kinematics_workspace_nothing,
                                     std::string(1, "xyz"[options.normal]), options.at, radius));
}

}  // namespace mjarm
