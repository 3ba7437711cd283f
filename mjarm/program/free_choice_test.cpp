// Which of several answers to a pose a program takes: by words, else the best posture.
#include <gmock/gmock.h>

#include "mjarm/kinematics/branch.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik_all.hpp"
#include "mjarm/program/program_plan.hpp"
#include "mjarm/program/program_reader.hpp"

namespace mjarm::program {
namespace {

using ::testing::HasSubstr;

const Robot& choice_robot(const std::string& name) {
  static std::map<std::string, Robot> robots;
  if (!robots.contains(name)) {
    Program program;
    program.robot = name;
    robots.emplace(name, load_program_robot(program, "").value());
  }
  return robots.at(name);
}

ProgramPlan choice_plan(const std::string& text, const std::string& robot = "ur5e") {
  const auto program = parse_program("robot: " + robot + "\n" + text, "p.yaml");
  EXPECT_TRUE(program.has_value()) << program.error().what;
  if (!program) return {};
  return plan_program(choice_robot(robot).model, choice_robot(robot).arm, *program);
}

/// How the arm is bent all along a motion; empty parts where that changes.
Branch bent_along(const ProgramPlan& plan, std::size_t i, const std::string& robot = "ur5e") {
  const IkSolver ik(choice_robot(robot).arm);
  const Trajectory& trajectory = plan.moves.at(i).trajectory;
  Branch out = branch_of(ik, as_span(trajectory.at(0).q));
  for (int k = 1; k <= 20; ++k) {
    const Branch here = branch_of(ik, as_span(trajectory.at(trajectory.duration() * k / 20).q));
    for (std::size_t part = 0; part < out.way.size(); ++part) {
      if (here.way[part] != out.way[part]) out.way[part] = -1;
    }
  }
  return out;
}

Branch bent_at_end(const ProgramPlan& plan, std::size_t i, const std::string& robot = "ur5e") {
  const Trajectory& trajectory = plan.moves.at(i).trajectory;
  const IkSolver ik(choice_robot(robot).arm);
  return branch_of(ik, as_span(trajectory.at(trajectory.duration()).q));
}

constexpr const char* kChoiceEllipse =
    "  - ellipse: {center: [0, -0.3, 0.5], a: 0.3, b: 0.15, normal: [0, 0, 1], euler: [3.14, 0, "
    "0]}\n";
constexpr int kElbowUp = 0, kElbowDown = 1;

TEST(FreeChoice, TheEllipseIsDrawnWithTheElbowUp) {
  const ProgramPlan plan = choice_plan(std::string("program:\n") + kChoiceEllipse);
  ASSERT_TRUE(plan.ok()) << plan.faults.front().what;
  EXPECT_EQ(bent_along(plan, plan.moves.size() - 1).way[1], kElbowUp);
  // The elbow stays well above the floor.
  std::array<Pose, kMaxDof> X_WJ;
  const PlannedMove& move = plan.moves.back();
  for (int k = 0; k <= 20; ++k) {
    const JointVec q = move.trajectory.at(move.trajectory.duration() * k / 20).q;
    fk_all(choice_robot("ur5e").arm, as_span(q), X_WJ);
    EXPECT_GT(X_WJ[2].p.z(), 0.35);
  }
}

TEST(FreeChoice, SoAreOtherCurvesOfOtherArms) {
  const ProgramPlan line = choice_plan(
      "program:\n  - polyline: {points: [[-0.3, 0.3, 0.3], [0.3, 0.3, 0.3], [0.3, 0.5, 0.4]], "
      "euler: [3.14, 0, 0]}\n");
  ASSERT_TRUE(line.ok()) << line.faults.front().what;
  EXPECT_EQ(bent_along(line, line.moves.size() - 1).way[1], kElbowUp);
  const ProgramPlan panda = choice_plan(
      "program:\n  - circle: {center: [0.5, 0, 0.4], radius: 0.1, normal: [0, 0, 1], euler: "
      "[180deg, 0, 0]}\n",
      "panda");
  ASSERT_TRUE(panda.ok()) << panda.faults.front().what;
  EXPECT_EQ(bent_along(panda, panda.moves.size() - 1, "panda").way[1], kElbowUp);
}

TEST(FreeChoice, APoseIsReachedInTheBestPosture) {
  const ProgramPlan plan =
      choice_plan("program:\n  - movej: {pos: [0, -0.3, 0.5], euler: [3.14, 0, 0]}\n");
  ASSERT_TRUE(plan.ok());
  EXPECT_EQ(bent_at_end(plan, 0).way[1], kElbowUp);
  const ProgramPlan round =
      choice_plan("program:\n  - plan: {pos: [0, -0.3, 0.5], euler: [3.14, 0, 0]}\n");
  ASSERT_TRUE(round.ok());
  EXPECT_EQ(bent_at_end(round, 0).way[1], kElbowUp);
}

TEST(FreeChoice, JointValuesOfTheProgramMeanTheNearestAnswer) {
  // An elbow that is down, by joint values: the pose that follows is reached from there.
  const std::string joints = "[-1.1, -3.0, 1.6, -0.14, -1.57, 0.46]";
  const std::string pose = "  - movej: {pos: [0, -0.3, 0.5], euler: [3.14, 0, 0]}\n";
  const ProgramPlan moved = choice_plan("program:\n  - movej: {joints: " + joints + "}\n" + pose);
  ASSERT_TRUE(moved.ok());
  EXPECT_EQ(bent_at_end(moved, 1).way[1], kElbowDown);
  const ProgramPlan started = choice_plan("start: " + joints + "\nprogram:\n" + pose);
  ASSERT_TRUE(started.ok());
  EXPECT_EQ(bent_at_end(started, 0).way[1], kElbowDown);
  const JointVec end = started.moves[0].trajectory.at(started.moves[0].trajectory.duration()).q;
  const IkSolver ik(choice_robot("ur5e").arm);
  const auto nearest = ik.solve(fk(ik.arm(), as_span(end)), as_span(started.q_start));
  ASSERT_TRUE(nearest.has_value());
  EXPECT_LT((nearest->q - end).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(FreeChoice, ABranchIsAskedForByWords) {
  const IkSolver ik(choice_robot("ur5e").arm);
  const auto all =
      solve_all(ik, {{0, -0.3, 0.5}, from_euler({3.14, 0, 0})}, as_span(ik.arm().home));
  ASSERT_TRUE(all.has_value());
  int reached = 0;
  for (const IkSolution& answer : *all) {
    const Branch wanted = branch_of(ik, as_span(answer.q));
    std::string words;
    for (std::size_t part = 0; part < wanted.way.size(); ++part) {
      words += (part > 0 ? ", " : "") + std::string(branch_parts()[part]) + ": " +
               std::string(branch_ways(static_cast<int>(part))[wanted.way[part]]);
    }
    const ProgramPlan plan =
        choice_plan("program:\n  - movej: {pos: [0, -0.3, 0.5], euler: [3.14, 0, 0], branch: {" +
                    words + "}}\n");
    if (!plan.ok()) continue;  // something is in the way
    ++reached;
    EXPECT_EQ(bent_at_end(plan, 0), wanted) << words;
    const ProgramPlan set = choice_plan("branch: {" + words + "}\nprogram:\n" +
                                        "  - movej: {pos: [0, -0.3, 0.5], euler: [3.14, 0, 0]}\n");
    ASSERT_TRUE(set.ok()) << words;
    EXPECT_EQ(bent_at_end(set, 0), wanted) << words;
  }
  EXPECT_GE(reached, 4);
}

TEST(FreeChoice, CurvesAreDrawnInTheBranchThatIsSet) {
  const ProgramPlan plan =
      choice_plan(std::string("program:\n  - set: {branch: {elbow: down}}\n") + kChoiceEllipse);
  ASSERT_TRUE(plan.ok()) << plan.faults.front().what;
  EXPECT_EQ(bent_along(plan, plan.moves.size() - 1).way[1], kElbowDown);
  const ProgramPlan again = choice_plan(
      std::string("branch: {elbow: down}\nprogram:\n  - set: {branch: {}}\n") + kChoiceEllipse);
  ASSERT_TRUE(again.ok()) << again.faults.front().what;
  EXPECT_EQ(bent_along(again, again.moves.size() - 1).way[1], kElbowUp);
}

TEST(FreeChoice, BadWordsAreAnsweredByTheNearest) {
  const auto refusal = [](const std::string& text) {
    const auto read = parse_program("robot: ur5e\n" + text, "p.yaml");
    return read ? std::string() : read.error().what;
  };
  const std::string pose = "pos: [0, 0.5, 0.5], euler: [3.14, 0, 0]";
  EXPECT_THAT(refusal("program:\n  - movej: {" + pose + ", branch: {elbow: upp}}\n"),
              HasSubstr("movej: branch: elbow: expected one of up, down, got \"upp\" (did you mean "
                        "\"up\"?)"));
  EXPECT_THAT(refusal("program:\n  - movej: {" + pose + ", branch: {elbw: up}}\n"),
              HasSubstr("unknown field \"elbw\" (did you mean \"elbow\"?)"));
  EXPECT_THAT(refusal("branch: left\nprogram: [wait: 1]\n"), HasSubstr("branch: expected fields"));
  EXPECT_THAT(refusal("program:\n  - movej: {joints: home, branch: {elbow: up}}\n"),
              HasSubstr("movej: joints goes without \"branch\""));
}

TEST(FreeChoice, ABranchThatIsNotThereIsAFaultWithThoseThatAre) {
  // Straight above the base nothing is left or right of the other; this far out the arm stretches.
  const ProgramPlan plan = choice_plan(
      "program:\n  - movej: {pos: [0.5, 0.2, 0.2], euler: [90deg, 0, 0], branch: {shoulder: left, "
      "elbow: down, wrist: flip}}\n");
  ASSERT_EQ(plan.faults.size(), 1U);
  EXPECT_EQ(plan.faults[0].place.line, 3);
  EXPECT_EQ(plan.faults[0].reason, "no_branch");
  EXPECT_THAT(plan.faults[0].what,
              HasSubstr("no answer with shoulder=left,elbow=down,wrist=flip; there are: "));
}

}  // namespace
}  // namespace mjarm::program
