#include "mjarm/path/joint_path.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mjarm/core/messages/path.hpp"
#include "mjarm/kinematics/ik_all.hpp"

namespace mjarm {
namespace {

double largest_step(const JointVec& from, const JointVec& to) {
  return (to - from).cwiseAbs().maxCoeff();
}

bool finite_ascending(std::span<const double> s) {
  for (std::size_t i = 0; i < s.size(); ++i) {
    if (!std::isfinite(s[i]) || (i > 0 && s[i] < s[i - 1])) return false;
  }
  return true;
}

/// From pose 0 at `q_first` along all poses, each from the answer before.
Result<JointPath, PathFailure> walk(const IkSolver& ik, std::span<const Pose> poses,
                                    std::span<const double> s, const JointVec& q_first,
                                    double max_step) {
  JointPath path;
  path.s.reserve(poses.size());
  path.q.reserve(poses.size());
  path.s.push_back(s[0]);
  path.q.push_back(q_first);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const auto answer = ik.solve(poses[i], view(path.q.back()));
    const bool flip = answer && largest_step(path.q.back(), answer->q) > max_step;
    if (!answer || flip) {
      PathFailure failure;
      failure.flip = flip;
      failure.at = i;
      failure.fraction = static_cast<double>(i) / static_cast<double>(poses.size());
      if (!answer) failure.ik = answer.error();
      if (flip) failure.ik.best = *answer;
      failure.code = failure.ik.code;
      failure.partial = std::move(path);
      return fail(std::move(failure));
    }
    path.s.push_back(s[i]);
    path.q.push_back(answer->q);
  }
  return path;
}

/// Answers for `X_WT` to start from: the branches in the windings nearest to `q_start`, then those
/// nearest to the middle of the limits, which leave most room to both sides.
std::vector<JointVec> starts(const IkSolver& ik, const Pose& X_WT, std::span<const double> q_start,
                             int branches) {
  JointVec q_middle = joint_vec(q_start);
  for (Eigen::Index j = 0; j < q_middle.size(); ++j) {
    const double middle = 0.5 * (ik.arm().limits.lower[j] + ik.arm().limits.upper[j]);
    if (std::isfinite(middle)) q_middle[j] = middle;
  }
  std::vector<JointVec> found;
  for (const std::span<const double> seed : {q_start, view(q_middle)}) {
    const auto answers = solve_all(ik, X_WT, seed);
    if (!answers) continue;
    const std::size_t count = std::min(answers->size(), static_cast<std::size_t>(branches));
    for (std::size_t i = 0; i < count; ++i) found.push_back((*answers)[i].q);
  }
  return found;
}

PathFailure bad_call() {
  PathFailure failure;
  failure.code = failure.ik.code = IkErrc::bad_input;
  return failure;
}

}  // namespace

double JointPath::max_step() const {
  double worst = 0;
  for (std::size_t i = 1; i < q.size(); ++i) worst = std::max(worst, largest_step(q[i - 1], q[i]));
  return worst;
}

Result<JointPath, PathFailure> solve_path(const IkSolver& ik, std::span<const Pose> poses,
                                          std::span<const double> s,
                                          std::span<const double> q_start,
                                          const PathOptions& options) {
  if (poses.empty() || poses.size() != s.size() || !finite_ascending(s) ||
      !(options.max_step > 0) || options.start_branches < 1) {
    return fail(bad_call());
  }
  const auto first = ik.solve(poses[0], q_start);
  if (!first) {
    PathFailure failure;
    failure.code = first.error().code;
    failure.ik = first.error();
    return fail(std::move(failure));
  }
  Result<JointPath, PathFailure> nearest = walk(ik, poses, s, first->q, options.max_step);
  if (nearest) return nearest;

  std::optional<JointPath> best;
  PathFailure farthest = std::move(nearest.error());
  for (const JointVec& q : starts(ik, poses[0], q_start, options.start_branches)) {
    Result<JointPath, PathFailure> path = walk(ik, poses, s, q, options.max_step);
    if (path) {
      if (!best || path->max_step() < best->max_step()) best = std::move(*path);
    } else if (path.error().at > farthest.at) {
      farthest = std::move(path.error());
    }
  }
  if (best) return std::move(*best);
  return fail(std::move(farthest));
}

std::vector<UnreachableRange> unreachable_ranges(const IkSolver& ik, std::span<const Pose> poses,
                                                 std::span<const double> q_seed) {
  std::vector<UnreachableRange> ranges;
  JointVec seed = joint_vec(q_seed.first(std::min<std::size_t>(q_seed.size(), kMaxDof)));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto answer = ik.solve(poses[i], view(seed));
    if (answer) {
      seed = answer->q;
    } else if (!ranges.empty() && ranges.back().last + 1 == i) {
      ranges.back().last = i;
      if (answer.error().amount > ranges.back().worst.amount) ranges.back().worst = answer.error();
    } else {
      ranges.push_back({i, i, answer.error()});
    }
  }
  return ranges;
}

Result<JointPath> joint_line(std::span<const double> q0, std::span<const double> q1, int n) {
  const auto finite = [](std::span<const double> q) {
    return std::all_of(q.begin(), q.end(), [](double x) { return std::isfinite(x); });
  };
  if (n < 2 || q0.empty() || q0.size() != q1.size() ||
      q0.size() > static_cast<std::size_t>(kMaxDof) || !finite(q0) || !finite(q1)) {
    return fail(Errc::bad_input, text(msg::path_bad_call));
  }
  const JointVec from = joint_vec(q0), to = joint_vec(q1);
  const double length = (to - from).norm();
  JointPath path;
  for (int i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / (n - 1);
    path.s.push_back(t * length);
    path.q.push_back((1 - t) * from + t * to);
  }
  return path;
}

}  // namespace mjarm
