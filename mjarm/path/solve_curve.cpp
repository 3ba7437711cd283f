#include "mjarm/path/solve_curve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "mjarm/path/refine_internal.hpp"

namespace mjarm {
namespace {

constexpr int kRounds = 12;  // of adding stations where the curve is not had
constexpr std::size_t kMaxStations = 400'000;

/// Seven more stations within (s0, s1).
void split(std::vector<double>& stations, double s0, double s1) {
  constexpr int kParts = 8;
  for (int i = 1; i < kParts; ++i) stations.push_back(s0 + (s1 - s0) * i / kParts);
}

std::vector<double> first_stations(const Curve& curve, const CurveOptions& options) {
  constexpr double kMax = 2e5;
  const double step = std::max(options.step, curve.length() / kMax);
  const double turn = std::max(options.turn, curve.turn() / kMax);
  return curve.stations(step, turn);
}

/// True where the place of a failure between two stations is still to be found.
bool is_vague(const PathFailure& failure, double stretch) {
  constexpr double kPlace = 1e-5, kRace = 1e-8;
  const bool race = failure.code == PathErrc::singularity || failure.code == PathErrc::branch_flip;
  const bool known = failure.code == PathErrc::bad_input || failure.code == PathErrc::stopped;
  return failure.at > 0 && !known && stretch > (race ? kRace : kPlace);
}

PathFailure located(PathFailure failure, std::span<const double> stations, double end) {
  const std::size_t last = failure.at > 0 ? failure.at - 1 : 0;
  failure.s = stations.empty() ? 0 : stations[last];
  failure.fraction = failure.at > 0 && end > 0 ? failure.s / end : 0;
  return failure;
}

/// The failure of a path that is lost between two of its stations.
PathFailure lost_after(JointPath path, const detail::Lost& lost, double end) {
  PathFailure failure;
  failure.code = lost.joint >= 0 ? PathErrc::joint_speed : PathErrc::branch_flip;
  failure.joint = lost.joint;
  failure.amount = lost.amount;
  const auto after = std::upper_bound(path.s.begin(), path.s.end(), lost.s);
  failure.at = static_cast<std::size_t>(after - path.s.begin());
  path.s.resize(failure.at);
  path.q.resize(failure.at);
  failure = located(std::move(failure), path.s, end);
  failure.partial = std::move(path);
  return failure;
}

}  // namespace

Result<JointPath, PathFailure> solve_curve(const IkSolver& ik, const Curve& curve,
                                           std::span<const double> q_start,
                                           const CurveOptions& options) {
  if (!(options.pos_tol > 0 && options.rot_tol > 0 && options.step > 0 && options.turn > 0)) {
    PathFailure failure;
    failure.code = PathErrc::bad_input;
    failure.ik.code = IkErrc::bad_input;
    return fail(std::move(failure));
  }
  std::vector<double> stations = first_stations(curve, options);
  PathFailure failure;
  for (int round = 0; round < kRounds && stations.size() < kMaxStations; ++round) {
    std::vector<Pose> poses = curve.poses(stations);
    std::transform(poses.begin(), poses.end(), poses.begin(), options.change);
    auto path = solve_path(ik, poses, stations, q_start, options.path);
    if (path) {
      detail::Refined refined = detail::refine(ik, curve, *path, options);
      if (is_stopped(options.path.stop)) {
        failure = {};
        failure.code = PathErrc::stopped;
        break;
      }
      if (refined.lost.empty()) return std::move(refined.path);
      for (const detail::Lost& lost : refined.lost) {
        const auto after = std::upper_bound(path->s.begin(), path->s.end(), lost.s);
        split(stations, *(after - 1), *after);
      }
      failure = lost_after(std::move(*path), refined.lost.front(), curve.end());
    } else {
      failure = located(std::move(path.error()), stations, curve.end());
      const std::size_t at = failure.at;
      if (at == 0 || !is_vague(failure, stations[at] - stations[at - 1])) break;
      split(stations, stations[at - 1], stations[at]);
    }
    std::sort(stations.begin(), stations.end());
    stations.erase(std::unique(stations.begin(), stations.end()), stations.end());
  }
  return fail(std::move(failure));
}

}  // namespace mjarm
