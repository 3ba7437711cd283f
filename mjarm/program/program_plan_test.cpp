#include "mjarm/program/program_plan.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "mjarm/kinematics/fk.hpp"
#include "mjarm/path/ellipse.hpp"
#include "mjarm/program/program_reader.hpp"
#include "mjarm/trajectory/tool_down_test.hpp"

namespace mjarm::program {
namespace {

using ::testing::HasSubstr;
using testing::kDown;
using testing::kSeed;

const Robot& robot() {
  static const Robot kRobot = [] {
    Program program;
    program.robot = "ur5e";
    return load_program_robot(program, "").value();
  }();
  return kRobot;
}

ProgramPlan plan_of(const Program& program) {
  return plan_program(robot().model, robot().arm, program);
}

ProgramPlan plan_text(const std::string& instructions, const std::string& head = "") {
  const auto program =
      parse_program("robot: ur5e\n" + head + "program:\n" + instructions, "p.yaml");
  EXPECT_TRUE(program.has_value()) << program.error().what;
  return plan_of(*program);
}

std::string faults_of(const ProgramPlan& plan) {
  std::string out;
  for (const ProgramFault& fault : plan.faults) {
    out += std::to_string(fault.place.line) + " " + fault.reason + ": " + fault.what + "\n";
  }
  return out;
}

/// Every motion starts where the one before ends, at rest, within the limits.
void expect_connected(const ProgramPlan& plan) {
  JointVec q = plan.q_start;
  for (const PlannedMove& move : plan.moves) {
    const JointState first = move.trajectory.at(0);
    EXPECT_LT((first.q - q).cwiseAbs().maxCoeff(), 1e-9) << move.word;
    EXPECT_EQ(first.v.cwiseAbs().maxCoeff(), 0) << move.word;
    q = move.trajectory.at(move.trajectory.duration()).q;
    const LimitUse use = check_limits(move.trajectory, robot().arm.limits);
    EXPECT_LE(use.worst(), 1 + 1e-6) << move.word;
    EXPECT_LE(use.position.maxCoeff(), 1e-9) << move.word;
  }
}

Pose end_of(const ProgramPlan& plan, std::size_t i) {
  const PlannedMove& move = plan.moves.at(i);
  return fk(plan.arms[move.tool], as_span(move.trajectory.at(move.trajectory.duration()).q));
}

/// Largest distance of the moving tool from the curve of the motion.
double strayed(const ProgramPlan& plan, const PlannedMove& move) {
  double worst = 0;
  for (int i = 0; i <= 200; ++i) {
    const JointVec q = move.trajectory.at(move.trajectory.duration() * i / 200).q;
    worst = std::max(worst, move.curve->nearest(fk(plan.arms[move.tool], as_span(q)).p).distance);
  }
  return worst;
}

TEST(ProgramPlan, BeginsAtItsStart) {
  const std::string head = "postures: {up: [0, -90deg, 90deg, -90deg, 90deg, 0]}\nstart: up\n";
  const ProgramPlan plan = plan_text("  - movej: {joints: home}\n", head);
  ASSERT_TRUE(plan.ok()) << faults_of(plan);
  EXPECT_NEAR(plan.q_start[1], -std::numbers::pi / 2, 1e-12);
  EXPECT_EQ(plan.moves.front().trajectory.at(0).q, plan.q_start);
  expect_connected(plan);
}

TEST(ProgramPlan, AStartBeyondTheLimitsOrOfOtherJointsIsAFault) {
  const ProgramPlan beyond =
      plan_text("  - movej: {joints: home}\n", "start: [0, 0, 9, 0, 0, 0]\n");
  ASSERT_EQ(beyond.faults.size(), 1U) << faults_of(beyond);
  EXPECT_EQ(beyond.faults[0].place.line, 2);
  EXPECT_EQ(beyond.faults[0].reason, "joint_limit");
  const ProgramPlan other = plan_text("  - movej: {joints: home}\n", "start: [0, 0]\n");
  ASSERT_EQ(other.faults.size(), 1U) << faults_of(other);
  EXPECT_THAT(other.faults[0].what, HasSubstr("expected 6 joint values, got 2"));
  EXPECT_EQ(other.faults[0].code, Errc::bad_input);
}

TEST(ProgramPlan, DoesWhatTheCallsSay) {
  Program program;
  const Pose a{{0.2, -0.45, 0.4}, kDown}, b{{-0.2, -0.45, 0.4}, kDown},
      c{{-0.2, -0.45, 0.3}, kDown};
  program.instructions = {
      move_j(kSeed),  move_j(a), move_l(b, 0.1, 0.02),
      move_l(c, 0.2), wait(0.5), move_c({{0, -0.35, 0.3}, kDown}, {{0.2, -0.45, 0.3}, kDown})};
  const ProgramPlan plan = plan_of(program);
  ASSERT_TRUE(plan.ok()) << faults_of(plan);
  ASSERT_EQ(plan.moves.size(), 5U);
  expect_connected(plan);
  EXPECT_EQ(plan.moves[0].trajectory.at(1e9).q, joint_vec(kSeed));
  EXPECT_LT((end_of(plan, 1).p - a.p).norm(), 1e-6);
  EXPECT_EQ(plan.moves[2].instructions, 2U);
  EXPECT_LT((end_of(plan, 2).p - c.p).norm(), 1e-6);
  EXPECT_EQ(plan.moves[3].trajectory.duration(), 0.5);
  for (const std::size_t i : {std::size_t{2}, std::size_t{4}}) {
    ASSERT_TRUE(plan.moves[i].curve.has_value());
    EXPECT_LT(strayed(plan, plan.moves[i]), 1e-6);
  }
  // The corner is cut, within its blend.
  const double cut = plan.moves[2].curve->nearest(b.p).distance;
  EXPECT_GT(cut, 0.002);
  EXPECT_LT(cut, 0.02);
}

TEST(ProgramPlan, EveryLegHasItsOwnSpeed) {
  Program program;
  program.instructions = {move_j(Pose{{0.3, -0.45, 0.4}, kDown}),
                          move_l({{-0.1, -0.45, 0.4}, kDown}, 0.3, 0.02),
                          move_l({{-0.1, -0.45, 0.2}, kDown}, 0.05)};
  const ProgramPlan plan = plan_of(program);
  ASSERT_TRUE(plan.ok()) << faults_of(plan);
  const PlannedMove& move = plan.moves.back();
  EXPECT_EQ(move.instructions, 2U);
  double fastest[2] = {0, 0};
  const double h = 1e-3;
  for (double t = h; t < move.trajectory.duration(); t += h) {
    const Pose X = fk(robot().arm, as_span(move.trajectory.at(t).q));
    const Pose before = fk(robot().arm, as_span(move.trajectory.at(t - h).q));
    double& max = fastest[X.p.z() < 0.375 ? 1 : 0];
    max = std::max(max, (X.p - before.p).norm() / h);
  }
  EXPECT_NEAR(fastest[0], 0.3, 0.003);
  EXPECT_NEAR(fastest[1], 0.05, 0.0005);
}

/// Speed of the tool [m/s] from `t - h` to `t`.
double speed_at(const PlannedMove& move, double t, double h) {
  const Pose X = fk(robot().arm, as_span(move.trajectory.at(t).q));
  return (X.p - fk(robot().arm, as_span(move.trajectory.at(t - h).q)).p).norm() / h;
}

TEST(ProgramPlan, LinesAndArcsAreBlendedIntoOneMotion) {
  const Pose a{{0.2, -0.35, 0.4}, kDown}, b{{0.2, -0.5, 0.4}, kDown}, c{{-0.2, -0.5, 0.4}, kDown},
      d{{-0.2, -0.35, 0.4}, kDown};
  const Pose via{{0, -0.6, 0.4}, kDown};
  Program program;
  program.instructions = {move_j(kSeed), move_j(a), move_l(b, 0.2, 0.04),
                          move_c(via, c, 0.08, 0.04), move_l(d, 0.2)};
  const ProgramPlan plan = plan_of(program);
  ASSERT_TRUE(plan.ok()) << faults_of(plan);
  expect_connected(plan);
  ASSERT_EQ(plan.moves.size(), 3U);
  const PlannedMove& move = plan.moves.back();
  EXPECT_EQ(move.instructions, 3U);
  EXPECT_EQ(move.word, "movel+movec");
  EXPECT_LT(strayed(plan, move), 1e-6);
  EXPECT_LT((end_of(plan, 2).p - d.p).norm(), 1e-6);
  for (const Pose& corner : {b, c}) {
    const double cut = move.curve->nearest(corner.p).distance;
    EXPECT_GT(cut, 0.001);
    EXPECT_LT(cut, 0.04);
  }
  EXPECT_LT(move.curve->nearest(via.p).distance, 1e-9);
  double max[2] = {0, 0}, least = 1;
  const double h = 1e-3;
  for (double t = h; t < move.trajectory.duration(); t += h) {
    const Pose X = fk(robot().arm, as_span(move.trajectory.at(t).q));
    const double speed = speed_at(move, t, h);
    double& fastest = max[X.p.y() < -0.52 ? 1 : 0];
    fastest = std::max(fastest, speed);
    if ((X.p - a.p).norm() > 0.03 && (X.p - d.p).norm() > 0.03) least = std::min(least, speed);
  }
  EXPECT_NEAR(max[0], 0.2, 0.002);
  EXPECT_NEAR(max[1], 0.08, 0.001);
  EXPECT_GT(least, 0.05);  // no stop on the way

  // The check can fail: without blends it is three motions with stops between them.
  program.instructions = {move_j(kSeed), move_j(a), move_l(b, 0.2), move_c(via, c, 0.08),
                          move_l(d, 0.2)};
  const ProgramPlan stops = plan_of(program);
  ASSERT_TRUE(stops.ok()) << faults_of(stops);
  EXPECT_EQ(stops.moves.size(), 5U);
}

TEST(ProgramPlan, BlendsThatDoNotFitAreNamedWithWhatDoes) {
  // Half a circle of radius 0.1 m between two lines: a corner takes a quarter of the circle, 0.157
  // m, at most.
  const std::string head =
      "  - movej: {pos: [0.3, -0.5, 0.4], euler: [180deg, 0, 0]}\n"
      "  - movel: {pos: [0.1, -0.5, 0.4], euler: [180deg, 0, 0]";
  const std::string arc =
      "}\n  - movec: {via: {pos: [0, -0.6, 0.4], euler: [180deg, 0, 0]}, "
      "to: {pos: [-0.1, -0.5, 0.4], euler: [180deg, 0, 0]}";
  const std::string last = "}\n  - movel: {pos: [-0.3, -0.5, 0.4], euler: [180deg, 0, 0]}\n";
  EXPECT_THAT(faults_of(plan_text(head + ", blend: 20mm" + arc + ", blend: 180mm" + last)),
              ::testing::AllOf(HasSubstr("5 blend_overlap"), HasSubstr("0.18 m"),
                               HasSubstr("leave 0.1571 m")));
  EXPECT_THAT(faults_of(plan_text(head + ", blend: 180mm" + arc + ", blend: 20mm" + last)),
              HasSubstr("4 blend_overlap"));
  // An arc that is none is named where it stands, though it belongs to the motion before.
  const std::string straight =
      "}\n  - movec: {via: {pos: [0, -0.5, 0.4], euler: [180deg, 0, 0]}, "
      "to: {pos: [-0.1, -0.5, 0.4], euler: [180deg, 0, 0]}";
  EXPECT_THAT(faults_of(plan_text(head + ", blend: 20mm" + straight + last)),
              ::testing::AllOf(HasSubstr("5 bad_input"), HasSubstr("one line")));
  // Polylines too, wherever the tool stands before.
  EXPECT_THAT(faults_of(plan_text("  - polyline: {points: [[0.1, -0.4, 0.4], [0, -0.4, 0.4], "
                                  "[0, -0.5, 0.4], [0.1, -0.5, 0.4]], euler: [180deg, 0, 0], "
                                  "blend: 0.07}\n")),
              HasSubstr("3 blend_overlap"));
}

TEST(ProgramPlan, WholeCirclesAndMovesThatGoNowhereAreNotBlended) {
  const ProgramPlan plan = plan_text(
      "  - movej: {pos: [0.1, -0.4, 0.4], euler: [180deg, 0, 0]}\n"
      "  - set: {zone: 20mm}\n"
      "  - movel: {pos: [0.1, -0.4, 0.4], euler: [180deg, 0, 0]}\n"
      "  - movel: {pos: [0, -0.5, 0.4], euler: [180deg, 0, 0]}\n"
      "  - circle: {via: {pos: [0.1, -0.5, 0.4], euler: [180deg, 0, 0]}, "
      "to: {pos: [0.1, -0.6, 0.4], euler: [180deg, 0, 0]}}\n"
      "  - movec: {via: {pos: [-0.1, -0.55, 0.4], euler: [180deg, 0, 0]}, "
      "to: {pos: [-0.1, -0.45, 0.4], euler: [180deg, 0, 0]}}\n"
      "  - movel: {pos: [0, -0.4, 0.4], euler: [180deg, 0, 0]}\n");
  ASSERT_TRUE(plan.ok()) << faults_of(plan);
  expect_connected(plan);
  std::vector<std::string> words;
  for (const PlannedMove& move : plan.moves) words.push_back(move.word);
  EXPECT_THAT(words, ::testing::ElementsAre("movej", "movel", "movel", "movec", "movec+movel"));
}

TEST(ProgramPlan, GoalsOfJointMovesGetTheAnswerFromWhichTheRestCanBeDone) {
  // From the nearest answer to the first pose the line cannot be done, from another one it can.
  const ProgramPlan plan = plan_text(
      "  - movej: {joints: [-2.2, -1.9, 1.2, -0.87, -1.57, 0]}\n"
      "  - movej: {pos: [0.35, -0.35, 0.3], euler: [180deg, 0, 0]}\n"
      "  - movel: {pos: [-0.35, -0.35, 0.3], euler: [180deg, 0, 0]}\n");
  ASSERT_TRUE(plan.ok()) << faults_of(plan);
  expect_connected(plan);
}

TEST(ProgramPlan, PosesAreInTheFrameThatIsSet) {
  const std::string head =
      "frames:\n  table: {pos: [0.1, -0.5, 0.1], euler: [0, 0, 90deg]}\n"
      "  corner: {pos: [0, 0.1, 0], quat: [1, 0, 0, 0], frame: table}\n";
  const ProgramPlan plan = plan_text(
      "  - movej: {pos: [0, 0, 0.3], euler: [180deg, 0, 0], frame: corner}\n"
      "  - set: {frame: table}\n"
      "  - movel: {pos: [0.1, 0, 0.3], euler: [180deg, 0, 0]}\n"
      "  - ellipse: {center: [0, 0, 0.3], a: 0.1, b: 0.05, normal: [0, 0, 1], "
      "euler: [180deg, 0, 0]}\n",
      head);
  ASSERT_TRUE(plan.ok()) << faults_of(plan);
  EXPECT_LT((end_of(plan, 0).p - Eigen::Vector3d(0, -0.5, 0.4)).norm(), 1e-6);
  EXPECT_LT((end_of(plan, 1).p - Eigen::Vector3d(0.1, -0.4, 0.4)).norm(), 1e-6);
  // By the rule of the u axis: along the world's x, whatever the frame.
  const Pose X = end_of(plan, plan.moves.size() - 1);
  EXPECT_LT((X.p - Eigen::Vector3d(0.2, -0.5, 0.4)).norm(), 1e-6);
  EXPECT_EQ(plan.moves[2].word, "approach");
}

TEST(ProgramPlan, FramesThatAreNoneAreNamed) {
  EXPECT_THAT(
      faults_of(plan_text("  - movej: {pos: [0, -0.4, 0.4], euler: [3, 0, 0], frame: tabel}\n",
                          "frames: {table: {pos: [0, 0, 0], quat: [1, 0, 0, 0]}}\n")),
      ::testing::AllOf(HasSubstr("4 unknown_name"), HasSubstr("\"table\"")));
  EXPECT_THAT(faults_of(plan_text("  - movej: {pos: [0, 0, 0.1], euler: [0, 0, 0], "
                                  "frame: attachment_site}\n")),
              HasSubstr("moves with the arm"));
  EXPECT_THAT(faults_of(plan_text("  - movej: {pos: [0, 0, 0.1], euler: [0, 0, 0], frame: a}\n",
                                  "frames:\n  a: {pos: [0, 0, 0], quat: [1, 0, 0, 0], frame: b}\n"
                                  "  b: {pos: [0, 0, 0], quat: [1, 0, 0, 0], frame: a}\n")),
              HasSubstr("by itself"));
  EXPECT_THAT(faults_of(plan_text("  - wait: 1\n  - set: {tool: nothing}\n")),
              HasSubstr("4 unknown_name"));
}

TEST(ProgramPlan, AnotherToolIsMovedToTheSamePose) {
  const ProgramPlan plan = plan_text(
      "  - movej: {pos: [0, -0.45, 0.4], euler: [180deg, 0, 0]}\n"
      "  - set: {tool: wrist_3_link}\n"
      "  - movel: {pos: [0.1, -0.45, 0.4], euler: [180deg, 0, 0]}\n");
  ASSERT_EQ(plan.arms.size(), 2U);
  ASSERT_TRUE(plan.ok()) << faults_of(plan);
  EXPECT_EQ(plan.moves.back().tool, 1U);
  EXPECT_LT((end_of(plan, plan.moves.size() - 1).p - Eigen::Vector3d(0.1, -0.45, 0.4)).norm(),
            1e-6);
}

TEST(ProgramPlan, RepeatsAreUnrolled) {
  const ProgramPlan plan = plan_text(
      "  - movej: {pos: [0, -0.45, 0.4], euler: [180deg, 0, 0]}\n"
      "  - repeat:\n      times: 3\n      program:\n"
      "        - movel: {pos: [0.1, -0.45, 0.4], euler: [180deg, 0, 0]}\n"
      "        - movel: {pos: [0, -0.45, 0.4], euler: [180deg, 0, 0]}\n");
  ASSERT_TRUE(plan.ok()) << faults_of(plan);
  EXPECT_EQ(plan.moves.size(), 7U);
  EXPECT_EQ(plan.moves[5].place.line, 7);
  expect_connected(plan);
  const ProgramPlan long_one = plan_text(
      "  - repeat: {times: 10000, program: [repeat: {times: 10000, program: [wait: 1]}]}\n");
  EXPECT_THAT(faults_of(long_one), HasSubstr("too_long"));
}

TEST(ProgramPlan, RepeatsOfNothingThatMovesEndToo) {
  const auto thrice = [](const std::string& body) {
    return "  - repeat: {times: 10000, program: [repeat: {times: 10000, program: [repeat: {times: "
           "10000, program: [" +
           body + "]}]}]}\n";
  };
  EXPECT_THAT(faults_of(plan_text(thrice("set: {speed: 0.1}"))), HasSubstr("too_long"));
  const ProgramPlan wrong = plan_text(thrice("set: {tool: nothing}"));
  EXPECT_EQ(wrong.faults.size(), 1U) << faults_of(wrong);
  EXPECT_THAT(faults_of(wrong), HasSubstr("unknown_name"));
}

TEST(ProgramPlan, GoesOnAfterAFault) {
  const ProgramPlan plan = plan_text(
      "  - movej: {pos: [0, -0.45, 0.4], euler: [180deg, 0, 0]}\n"
      "  - movel: {pos: [0, -2, 0.4], euler: [180deg, 0, 0]}\n"
      "  - movel: {pos: [0.1, -0.45, 0.4], euler: [180deg, 0, 0]}\n"
      "  - movej: {joints: [0, 0, 7, 0, 0, 0]}\n"
      "  - movej: {joints: [0, 0, 0]}\n"
      "  - plan: {joints: home}\n"
      "  - grip: close\n");
  const std::string all = faults_of(plan);
  EXPECT_EQ(plan.faults.size(), 4U) << all;
  EXPECT_THAT(all, HasSubstr("4 out_of_reach"));
  EXPECT_THAT(all, HasSubstr("6 joint_limit"));
  EXPECT_THAT(all, HasSubstr("7 bad_input: expected 6 joint values, got 3"));
  EXPECT_THAT(all, HasSubstr("9 not_available"));
}

/// Who only asks whether all of it can be done need not wait for the rest, nor for what would mend
/// it.
TEST(ProgramPlan, StopsAtTheFirstFaultWhereThatIsEnough) {
  Program program;
  const auto down = [](double x, double y) { return ProgramPose{.X_FT = {{x, y, 0.4}, kDown}}; };
  program.instructions = {{MoveJ{.goal = down(0, -0.45)}},
                          {MoveL{.goal = down(0, -0.95)}},
                          {MoveL{.goal = down(0.1, -0.45)}},
                          {MoveJ{.goal = down(0, -2)}}};
  for (int i = 0; i < 4; ++i) program.instructions[static_cast<std::size_t>(i)].place.line = i + 1;
  const ProgramPlan all = plan_of(program);
  ASSERT_EQ(all.faults.size(), 2U) << faults_of(all);
  EXPECT_TRUE(all.faults[0].fix.has_value()) << faults_of(all);
  const ProgramPlan first =
      plan_program(robot().model, robot().arm, program, {.to_first_fault = true});
  ASSERT_EQ(first.faults.size(), 1U) << faults_of(first);
  EXPECT_EQ(first.faults[0].reason, all.faults[0].reason);
  EXPECT_FALSE(first.faults[0].fix.has_value());
}

TEST(ProgramPlan, DegreesWithoutAUnitAreGuessedAt) {
  EXPECT_THAT(faults_of(plan_text("  - movej: {joints: [0, -90, 90, -90, -90, 0]}\n")),
              HasSubstr("90deg"));
}

TEST(ProgramPlan, MeasuresEveryMotion) {
  const ProgramPlan plan = plan_text(
      "  - movej: {pos: [0, -0.45, 0.4], euler: [180deg, 0, 0]}\n"
      "  - movel: {pos: [0, -0.45, 0.08], euler: [180deg, 0, 0]}\n");
  ASSERT_TRUE(plan.ok()) << faults_of(plan);
  const MoveMeasures& low = *plan.moves.back().measures;
  EXPECT_GT(low.clearance, 0);
  EXPECT_LT(low.clearance, 0.1);
  EXPECT_THAT(low.nearest.geom1 + low.nearest.geom2, HasSubstr("floor"));
  EXPECT_GT(low.singularity.smallest, 0);
  EXPECT_GE(low.limit_joint, 0);
  EXPECT_GT(low.limit_room, 0.5);
}

}  // namespace
}  // namespace mjarm::program
