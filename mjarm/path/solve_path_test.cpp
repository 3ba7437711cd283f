#include "mjarm/path/solve_path.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/branch.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/posture.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/path/path_fix.hpp"
#include "mjarm/path/poses_test.hpp"
#include "tests/support/constants.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm {
namespace {

using support::kNaN;
using testing::kSeed;
constexpr double kDegree = std::numbers::pi / 180;

Ellipse tool_down(double y, double z = 0.5) {
  return {{0, y, z}, 0.3, 0.15, Eigen::Vector3d::UnitZ(), from_euler({3.14, 0, 0})};
}

TEST(SolvePath, TheEllipseOfTheDemoIsSolved) {
  const IkSolver ik(testing::ur5e());
  const std::vector<Pose> poses = ellipse_points(tool_down(-0.3), 200);
  const auto path = solve_path(ik, poses, kSeed);
  ASSERT_TRUE(path.has_value());
  testing::expect_on_poses(ik.arm(), *path, poses);
  EXPECT_LT(path->max_step(), 5.2 * kDegree);
  EXPECT_GT(path->max_step(), 0);
  EXPECT_LT((path->q.front() - path->q.back()).norm(), 1e-5);
}

TEST(SolvePath, AFreeChoiceIsTheBestPosture) {
  const IkSolver ik(testing::ur5e());
  const std::vector<Pose> poses = ellipse_points(tool_down(-0.3), 200);
  const auto near = solve_path(ik, poses, kSeed);
  const auto best = solve_path(ik, poses, kSeed, {.best_posture = true});
  ASSERT_TRUE(near.has_value() && best.has_value());
  testing::expect_on_poses(ik.arm(), *best, poses);
  const PostureCost cost(ik);
  double of_near = 0, of_best = 0;
  for (const JointVec& q : near->q) of_near += cost.at(as_span(q));
  for (const JointVec& q : best->q) of_best += cost.at(as_span(q));
  EXPECT_LT(of_best, of_near);
  for (const JointVec& q : best->q) EXPECT_EQ(branch_of(ik, as_span(q)).way[1], 0);  // elbow up
  // Where the arm stands at the first pose it stays in its branch.
  const auto kept =
      solve_path(ik, poses, as_span(near->q.front()), {.keep_start = true, .best_posture = true});
  ASSERT_TRUE(kept.has_value());
  EXPECT_LT((kept->q.front() - near->q.front()).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(SolvePath, ClearanceWeighsMoreThanTheElbow) {
  const IkSolver ik(testing::ur5e());
  const std::vector<Pose> poses = ellipse_points(tool_down(-0.3), 60);
  PathOptions options{.best_posture = true};
  // Something hangs where an elbow that is up would be near it.
  options.clearance = [&](std::span<const double> q) {
    return Clearance{branch_of(ik, q).way[1] == 0 ? 0.03 : 0.5, {}};
  };
  const auto path = solve_path(ik, poses, kSeed, options);
  ASSERT_TRUE(path.has_value());
  for (const JointVec& q : path->q) EXPECT_EQ(branch_of(ik, as_span(q)).way[1], 1);
}

TEST(SolvePath, TheEllipseOfTheGuideIsRefusedAndMended) {
  const IkSolver ik(testing::ur5e());
  const std::vector<Pose> poses = ellipse_points(tool_down(-0.2), 200);
  const auto path = solve_path(ik, poses, kSeed);
  ASSERT_FALSE(path.has_value());
  EXPECT_EQ(path.error().at, 37U);
  EXPECT_EQ(path.error().code, PathErrc::inner_void);
  EXPECT_NEAR(path.error().fraction, 37 / 200.0, 1e-12);
  EXPECT_EQ(path.error().partial.q.size(), 37U);

  const std::vector<UnreachableRange> ranges = unreachable_ranges(ik, poses, kSeed);
  ASSERT_EQ(ranges.size(), 1U);
  EXPECT_EQ(ranges[0].first, 37U);
  EXPECT_EQ(ranges[0].last, 62U);
  EXPECT_EQ(ranges[0].worst.code, IkErrc::inner_void);
  // The nearest point is 0.05 m from the axis.
  EXPECT_NEAR(ranges[0].worst.amount, 0.134 - 0.05, 1e-3);

  const auto shift = find_shift(ik, poses, kSeed);
  ASSERT_TRUE(shift.has_value()) << shift.error().what;
  EXPECT_TRUE(shift->isApprox(Eigen::Vector3d(0, -0.1, 0))) << shift->transpose();
}

TEST(SolvePath, ShiftIsZeroWhereNoneIsNeededAndFailsWhereNoneHelps) {
  const IkSolver ik(testing::ur5e());
  const auto none = find_shift(ik, ellipse_points(tool_down(-0.45, 0.4), 60), kSeed);
  ASSERT_TRUE(none.has_value());
  EXPECT_EQ(none->norm(), 0);
  Ellipse huge = tool_down(0);
  huge.a = 3;
  const auto hopeless = find_shift(ik, ellipse_points(huge, 60), kSeed);
  ASSERT_FALSE(hopeless.has_value());
  EXPECT_EQ(hopeless.error().code, Errc::impossible);
  EXPECT_NE(hopeless.error().what.find("0.40 m"), std::string::npos);
}

TEST(SolvePath, OtherBranchesAreTriedWhenTheNearestFails) {
  // From a wrist turned to its stop the line needs another winding.
  const Arm arm = testing::ur5e();
  const IkSolver ik(arm);
  const JointVec q0 = joint_vec(std::vector<double>{-1.57, -1.34, 2.2, -1.3, 1.55, 6.2});
  const Pose from = fk(arm, as_span(q0));
  const Curve turn = *Curve::line(from, {from.p, from.R * from_euler({0, 0, 1.0})});
  const std::vector<double> s = turn.stations(0.001, 0.05);
  std::vector<Pose> poses;
  for (const double x : s) poses.push_back(turn.at(x));
  const auto path = solve_path(ik, poses, s, as_span(q0));
  ASSERT_TRUE(path.has_value());
  testing::expect_on_poses(arm, *path, poses);
  EXPECT_LE(path->max_step(), 0.5);
}

TEST(SolvePath, AFlipIsNoAnswer) {
  const IkSolver ik(testing::ur5e());
  const Pose first = fk(ik.arm(), kSeed);
  std::vector<double> far = kSeed;
  far[0] += 1.5;
  const std::vector<Pose> poses{first, fk(ik.arm(), far)};
  const auto path = solve_path(ik, poses, kSeed);
  ASSERT_FALSE(path.has_value());
  EXPECT_EQ(path.error().code, PathErrc::branch_flip);
  EXPECT_EQ(path.error().at, 1U);
  EXPECT_TRUE(solve_path(ik, poses, kSeed, {.max_step = 2}).has_value());
}

TEST(SolvePath, BadInputIsRefused) {
  const IkSolver ik(testing::ur5e());
  const std::vector<Pose> poses = ellipse_points(tool_down(-0.3), 4);
  const auto code = [&](std::span<const Pose> p, std::vector<double> s, std::vector<double> q,
                        const PathOptions& options) {
    const auto path = solve_path(ik, p, s, q, options);
    return path ? PathErrc::no_convergence : path.error().code;
  };
  const std::vector<double> s{0, 1, 2, 3};
  EXPECT_EQ(code({}, {}, kSeed, {}), PathErrc::bad_input);
  EXPECT_EQ(code(poses, std::vector<double>{0, 1, 2}, kSeed, {}), PathErrc::bad_input);
  EXPECT_EQ(code(poses, {0, 1, 3, 2}, kSeed, {}), PathErrc::bad_input);
  EXPECT_EQ(code(poses, {0, 1, 2, kNaN}, kSeed, {}), PathErrc::bad_input);
  EXPECT_EQ(code(poses, s, {0, 0}, {}), PathErrc::bad_input);
  EXPECT_EQ(code(poses, s, kSeed, {.max_step = 0}), PathErrc::bad_input);
  EXPECT_EQ(code(poses, s, kSeed, {.max_step = 3.15}), PathErrc::bad_input);
  EXPECT_EQ(code(poses, s, kSeed, {.comfort = 2}), PathErrc::bad_input);
  std::vector<Pose> broken = poses;
  broken[2].p.x() = kNaN;
  EXPECT_EQ(code(broken, s, kSeed, {.max_step = 2}), PathErrc::bad_input);
  EXPECT_FALSE(find_shift(ik, {}, kSeed).has_value());
  EXPECT_FALSE(find_shift(ik, poses, kSeed, {}, kNaN).has_value());
}

std::vector<Pose> poses_of(const nlohmann::json& entry) {
  std::vector<Pose> poses;
  for (const auto& pose : entry.at("poses")) {
    const auto p = pose.at("pos").get<std::array<double, 3>>();
    const auto q = pose.at("quat").get<std::array<double, 4>>();
    poses.push_back({{p[0], p[1], p[2]}, to_matrix(Quat(q[0], q[1], q[2], q[3]))});
  }
  return poses;
}

TEST(SolvePathData, Ellipses) {
  MJARM_TEST_FILE(near_file, "ik/ur5e_ellipse.jsonl");
  MJARM_TEST_FILE(far_file, "ik/ur5e_ellipse_far.jsonl");
  const IkSolver ik(testing::ur5e());
  const std::vector<Pose> near = poses_of(support::load_json_lines(near_file).at(0));
  const std::vector<UnreachableRange> ranges = unreachable_ranges(ik, near, kSeed);
  ASSERT_EQ(ranges.size(), 1U);
  EXPECT_EQ(ranges[0].first, 37U);
  EXPECT_EQ(ranges[0].last, 62U);
  EXPECT_EQ(ranges[0].worst.code, IkErrc::inner_void);
  const std::vector<Pose> far = poses_of(support::load_json_lines(far_file).at(0));
  const auto path = solve_path(ik, far, kSeed);
  ASSERT_TRUE(path.has_value());
  testing::expect_on_poses(ik.arm(), *path, far);
  EXPECT_LT(path->max_step(), 2 * kDegree);
}

TEST(SolvePathData, AllLinesAreSolved) {
  MJARM_TEST_FILE(file, "ik/ur5e_lines.jsonl");
  const IkSolver ik(testing::ur5e());
  int line = 0;
  for (const auto& entry : support::load_json_lines(file)) {
    const std::vector<Pose> poses = poses_of(entry);
    const auto path = solve_path(ik, poses, as_span(ik.arm().home));
    EXPECT_TRUE(path.has_value()) << "line " << line << " stops at " << path.error().at << ": "
                                  << name(path.error().code);
    if (path) {
      testing::expect_on_poses(ik.arm(), *path, poses);
      EXPECT_LE(path->max_step(), 0.5);
    }
    ++line;
  }
  EXPECT_EQ(line, 20);
}

}  // namespace
}  // namespace mjarm
