#include "mjarm/path/failing_paths_test.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "mjarm/path/path_fix.hpp"
#include "tests/support/rounds.hpp"

namespace mjarm {
namespace {

struct Score {
  int paths = 0, named = 0, mended = 0;
  std::string missed;  ///< what was named wrong or not mended
};

/// Does what the fix says and solves the path once more.
bool works(const testing::FailingPath& path, PathOptions options, const PathFix& fix) {
  std::vector<Pose> poses;
  for (const Pose& X : path.poses) poses.push_back(fix.change(X));
  if (fix.kind == FixKind::max_step) options.max_step = fix.max_step;
  if (fix.kind == FixKind::slower) options.tool_speed = fix.tool_speed;
  const auto solved = solve_path(IkSolver(path.arm), poses, as_span(path.arm.home), options);
  if (!solved || solved->max_step() > options.max_step) return false;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose X = fk(path.arm, as_span(solved->q[i]));
    if ((X.p - poses[i].p).norm() > 1e-6 || angle_between(X.R, poses[i].R) > 1e-6) return false;
    if (!within_limits(path.arm, as_span(solved->q[i]))) return false;
    if (path.clearance && path.clearance(as_span(solved->q[i])).distance < 0) return false;
    if (i == 0 || options.tool_speed == 0) continue;
    const double time = (poses[i].p - poses[i - 1].p).norm() / options.tool_speed;
    const JointVec speed = (solved->q[i] - solved->q[i - 1]).cwiseAbs() / time;
    if ((speed - path.arm.limits.velocity).maxCoeff() > 1e-3) return false;
  }
  return !(options.tool_speed > path.tool_speed);
}

void judge(const testing::FailingPath& path, int number, const char* kind, Score& score) {
  PathOptions options;
  options.clearance = path.clearance;
  options.tool_speed = path.tool_speed;
  const IkSolver ik(path.arm);
  const auto home = as_span(path.arm.home);
  const auto solved = solve_path(ik, path.poses, home, options);
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

/// 24 paths, 360 with MJARM_LONG_TESTS=1.
void judge_all(std::uint64_t seed) {
  const int rounds = testing::rounds(1, 15);
  Rng rng(seed);
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
  std::printf("%d paths, %d named right, %d mended by the first repair\n", score.paths, score.named,
              score.mended);
}

TEST(FailingPaths, CausesAreNamedAndFirstRepairsWork) { judge_all(2026); }

/// A seed that nothing was tuned to.
TEST(FailingPaths, LikewiseForAFreshSeed) { judge_all(71804); }

}  // namespace
}  // namespace mjarm
