#include "mjarm/path/shift.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "mjarm/core/messages.hpp"

namespace mjarm {
namespace {

constexpr double kStep = 0.05;  // [m] of the grid

/// Grid points within `reach`, shortest first; of equal length those along fewer axes first.
std::vector<Eigen::Vector3i> grid_of(double reach) {
  const int n = static_cast<int>(std::floor(reach / kStep + 1e-9));
  std::vector<Eigen::Vector3i> grid;
  for (int x = -n; x <= n; ++x) {
    for (int y = -n; y <= n; ++y) {
      for (int z = -n; z <= n; ++z) {
        if (x * x + y * y + z * z <= n * n) grid.emplace_back(x, y, z);
      }
    }
  }
  const auto axes = [](const Eigen::Vector3i& g) { return (g.array() != 0).count(); };
  std::stable_sort(grid.begin(), grid.end(), [&](const auto& g, const auto& h) {
    const int length_g = g.squaredNorm(), length_h = h.squaredNorm();
    return length_g != length_h ? length_g < length_h : axes(g) < axes(h);
  });
  return grid;
}

Pose moved(const Pose& X, const Eigen::Vector3d& shift) { return {X.p + shift, X.R}; }

/// False where a pose is out of reach by proof, or a few of them, spread over the path, have no
/// answer: cheap tests that spare a whole solve.
bool may_work(const IkSolver& ik, std::span<const Pose> poses, const Eigen::Vector3d& shift,
              std::span<const double> q_seed) {
  constexpr std::size_t kProbes = 8;
  for (const Pose& X : poses) {
    if (ik.reach().check(moved(X, shift))) return false;
  }
  const std::size_t stride = std::max<std::size_t>(1, poses.size() / kProbes);
  for (std::size_t i = 0; i < poses.size(); i += stride) {
    if (!ik.solve(moved(poses[i], shift), q_seed)) return false;
  }
  return true;
}

}  // namespace

Result<Eigen::Vector3d> find_shift(const IkSolver& ik, std::span<const Pose> poses,
                                   std::span<const double> q_seed, const PathOptions& options,
                                   double reach) {
  constexpr double kLongest = 1;  // [m] keeps the grid at 33,000 points
  constexpr int kProbed = 500;    // shifts that pass the geometric test
  constexpr int kSolved = 50;     // shifts solved as a whole
  if (poses.empty() || !(reach >= 0) || !(options.max_step > 0)) {
    return fail(Errc::bad_input, text(Msg::path_bad_call));
  }
  std::vector<double> s(poses.size());
  std::iota(s.begin(), s.end(), 0.0);
  std::vector<Pose> candidate(poses.size());
  int solved = 0;
  for (const Eigen::Vector3i& g : grid_of(std::min(reach, kLongest))) {
    const Eigen::Vector3d shift = g.cast<double>() * kStep;
    if (!may_work(ik, poses, shift, q_seed)) continue;
    std::transform(poses.begin(), poses.end(), candidate.begin(),
                   [&](const Pose& X) { return moved(X, shift); });
    if (solve_path(ik, candidate, s, q_seed, options)) return shift;
    if (++solved == kSolved) break;
  }
  return fail(Errc::impossible, text(Msg::path_no_shift, reach));
}

}  // namespace mjarm
