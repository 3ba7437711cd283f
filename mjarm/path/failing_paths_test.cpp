#include "mjarm/path/failing_paths_test.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <numeric>
#include <string>

#include "mjarm/path/path_fix.hpp"

namespace mjarm {
namespace {

struct Score {
  int paths = 0, named = 0, mended = 0;
  std::string missed;  ///< what was named wrong or not mended
};

std::vector<double> counted(std::size_t n) {
  std::vector<double> s(n);
  std::iota(s.begin(), s.end(), 0.0);
  return s;
}

/// Does what the fix says and solves the path once more.
bool works(const testing::FailingPath& path, PathOptions options, const PathFix& fix) {
  std::vector<Pose> poses;
  for (const Pose& X : path.poses) poses.push_back(fix.change(X));
  if (fix.kind == FixKind::max_step) options.max_step = fix.max_step;
  const auto solved =
      solve_path(IkSolver(path.arm), poses, counted(poses.size()), view(path.arm.home), options);
  if (!solved || solved->max_step() > options.max_step) return false;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose X = fk(path.arm, view(solved->q[i]));
    if ((X.p - poses[i].p).norm() > 1e-6 || angle_between(X.R, poses[i].R) > 1e-6) return false;
    if (!within_limits(path.arm, view(solved->q[i]))) return false;
    if (path.clearance && path.clearance(view(solved->q[i])).distance < 0) return false;
  }
  return true;
}

void judge(const testing::FailingPath& path, int number, const char* kind, Score& score) {
  PathOptions options;
  options.clearance = path.clearance;
  const IkSolver ik(path.arm);
  const auto home = view(path.arm.home);
  const auto solved = solve_path(ik, path.poses, counted(path.poses.size()), home, options);
  ++score.paths;
  const std::string which = std::string("\n") + kind + " " + std::to_string(number) + ": ";
  if (solved) {
    score.missed += which + "solved";
    return;
  }
  const PathFailure& failure = solved.error();
  EXPECT_EQ(failure.partial.q.size(), failure.at);
  EXPECT_LT(failure.fraction, 1);
  bool named = failure.code == path.cause;
  if (path.joint >= 0) {
    named = named && failure.joint == path.joint && std::abs(failure.amount - path.amount) < 1e-6;
  }
  if (failure.code == PathErrc::collision) named = named && failure.amount <= path.amount + 1e-9;
  if (failure.code == PathErrc::singularity) named = named && failure.kind == SingularKind::wrist;
  score.named += named;
  const auto fixes = find_fixes(ik, path.poses, home, options, failure, 1);
  const bool mended = !fixes.empty() && works(path, options, fixes.front());
  score.mended += mended;
  if (!named || !mended) {
    score.missed += which + describe(failure, path.arm) + "; " +
                    (fixes.empty() ? "no fix" : describe(fixes.front()));
  }
}

/// 21 paths, 315 with MJARM_LONG_TESTS=1.
TEST(FailingPaths, CausesAreNamedAndFirstRepairsWork) {
  const int rounds = std::getenv("MJARM_LONG_TESTS") != nullptr ? 15 : 1;
  Rng rng(2026);
  Score score;
  int number = 0;
  for (const testing::FailureClass& kind : testing::kFailureClasses) {
    for (int round = 0; round < rounds; ++round) {
      for (const double depth : kind.depths) {
        judge(kind.make(rng, depth), number++, kind.name, score);
      }
    }
  }
  EXPECT_GE(score.named, 0.95 * score.paths) << score.missed;
  EXPECT_GE(score.mended, 0.80 * score.paths) << score.missed;
}

}  // namespace
}  // namespace mjarm
