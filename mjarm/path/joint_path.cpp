#include "mjarm/path/joint_path.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mjarm/core/messages.hpp"
#include "mjarm/core/rng.hpp"

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

/// Answers for `X_WT` other than `q_known`, from random starts: up to `count` of them, each of
/// another branch or winding.
std::vector<JointVec> other_starts(const IkSolver& ik, const Pose& X_WT, const JointVec& q_known,
                                   int count) {
  constexpr double kSame = 1e-3;    // [rad or m]
  constexpr int kStartsEach = 8;    // random starts for every answer wanted
  const JointLimits& limits = ik.arm().limits;
  Rng rng(ik.options().rng_seed, 1);
  std::vector<JointVec> found{q_known};
  for (int i = 0; i < kStartsEach * count && static_cast<int>(found.size()) <= count; ++i) {
    JointVec seed = q_known;
    for (Eigen::Index j = 0; j < seed.size(); ++j) {
      const double lower = std::max(limits.lower[j], q_known[j] - 4);
      const double upper = std::min(limits.upper[j], q_known[j] + 4);
      seed[j] = rng.uniform(lower, upper);
    }
    const auto answer = ik.solve(X_WT, view(seed));
    if (!answer) continue;
    const bool known = std::any_of(found.begin(), found.end(), [&](const JointVec& q) {
      return largest_step(q, answer->q) < kSame;
    });
    if (!known) found.push_back(answer->q);
  }
  found.erase(found.begin());
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
  for (const JointVec& q : other_starts(ik, poses[0], first->q, options.start_branches)) {
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
    return fail(Errc::bad_input, text(Msg::path_bad_call));
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
