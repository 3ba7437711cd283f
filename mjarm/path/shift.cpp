#include "mjarm/path/shift.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "mjarm/core/messages/path.hpp"

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

/// True where geometry proves that a pose is out of reach.
bool proven_bad(const IkSolver& ik, std::span<const Pose> poses) {
  return std::any_of(poses.begin(), poses.end(),
                     [&](const Pose& X) { return ik.reach().check(X).has_value(); });
}

/// True where a few poses, spread over the path, all have answers: spares many a whole solve.
bool probes_solved(const IkSolver& ik, std::span<const Pose> poses,
                   std::span<const double> q_seed) {
  constexpr std::size_t kProbes = 8;
  const std::size_t stride = std::max<std::size_t>(1, poses.size() / kProbes);
  for (std::size_t i = 0; i < poses.size(); i += stride) {
    if (!ik.solve(poses[i], q_seed)) return false;
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
    return fail(Errc::bad_input, text(msg::path_bad_call));
  }
  std::vector<double> s(poses.size());
  std::iota(s.begin(), s.end(), 0.0);
  std::vector<Pose> candidate(poses.size());
  int probed = 0, solved = 0;
  for (const Eigen::Vector3i& g : grid_of(std::min(reach, kLongest))) {
    const Eigen::Vector3d shift = g.cast<double>() * kStep;
    std::transform(poses.begin(), poses.end(), candidate.begin(),
                   [&](const Pose& X) { return moved(X, shift); });
    if (proven_bad(ik, candidate)) continue;
    if (++probed > kProbed || solved == kSolved) break;
    if (!probes_solved(ik, candidate, q_seed)) continue;
    ++solved;
    if (solve_path(ik, candidate, s, q_seed, options)) return shift;
  }
  return fail(Errc::impossible, text(msg::path_no_shift, reach));
}

}  // namespace mjarm
