#include "mjarm/program/urscript.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <numbers>

#include "mjarm/model/find_arm.hpp"
#include "mjarm/program/program_reader.hpp"
#include "mjarm/program/urscript_check_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::program {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::UrCheck;
using testing::UrReader;
using testing::UrScript;

/// A program, its plan and its script.
struct Exported {
  Program program;
  Robot robot;
  ProgramPlan plan;
  Result<std::string> text;

  UrScript script() const { return UrReader::read(*text); }
};

Exported exported(const std::string& instructions, const std::string& head = "robot: ur5e\n",
                  const std::string& file = "cell.yaml") {
  Program program = parse_program(head + "program:\n" + instructions, file).value();
  program.name = std::filesystem::path(file).stem().string();
  Robot robot = load_program_robot(program, file).value();
  ProgramPlan plan = plan_program(robot.model, robot.arm, program);
  EXPECT_TRUE(plan.ok()) << plan.faults.front().what;
  Result<std::string> text = to_urscript(program, robot, plan, {.version = "1.2.3"});
  return {std::move(program), std::move(robot), std::move(plan), std::move(text)};
}

constexpr const char* kAll =
    "  - movej: {pos: [0.2, -0.45, 0.4], euler: [180deg, 0, 0]}\n"
    "  - movel: {pos: [-0.1, -0.45, 0.4], euler: [180deg, 0, 0.3], speed: 0.2, blend: 20mm}\n"
    "  - movel: {pos: [-0.1, -0.55, 0.3], euler: [180deg, 0, 0.3], speed: 0.1, blend: 10mm}\n"
    "  - movel: {pos: [-0.1, -0.45, 0.3], euler: [180deg, 0.2, 0]}\n"
    "  - movel: {pos: [-0.1, -0.45, 0.3], euler: [180deg, 0, 0]}\n"
    "  - wait: 0.5\n"
    "  - movec: {via: {pos: [0, -0.4, 0.3], euler: [180deg, 0, 0]}, to: {pos: [0.1, -0.45, 0.3], "
    "euler: [180deg, 0, 0]}}\n"
    "  - circle: {center: [0, -0.45, 0.3], radius: 0.1, normal: [0, 0, 1], euler: [180deg, 0, 0]}\n"
    "  - ellipse: {center: [0, -0.45, 0.3], a: 0.15, b: 0.05, normal: [0, 0.1, 1], euler: "
    "[180deg, 0, 0]}\n"
    "  - polyline: {points: [[0.1, -0.4, 0.3], [0.2, -0.4, 0.3], [0.2, -0.5, 0.3]], euler: "
    "[180deg, 0, 0], blend: 15mm}\n"
    "  - text: {text: Z1, pos: [0, -0.5, 0.3], height: 50mm, euler: [180deg, 0, 0]}\n"
    "  - movej: {joints: home, speed: 0.3}\n";

TEST(Urscript, IsTheSameMotion) {
  const Exported all = exported(kAll);
  ASSERT_TRUE(all.text.has_value()) << all.text.error().what;
  const UrScript script = all.script();
  EXPECT_EQ(script.name, "mjarm_cell");
  UrCheck check(script, all.plan);
  EXPECT_THAT(check.problems(), IsEmpty()) << *all.text;
  EXPECT_EQ(check.count("movec"), 3);
  EXPECT_GT(check.count("movep"), 20);
  EXPECT_EQ(check.count("sleep"), 1);
  EXPECT_LT(check.worst_nominal(), 0.002);  // the model's lengths are rounded
  EXPECT_NEAR(check.seconds(), all.plan.duration(), 0.05 * all.plan.duration());
  std::printf("%.3f s planned, %.3f s by the script; points within %.4f mm; model %.2f mm off\n",
              all.plan.duration(), check.seconds(), 1e3 * check.worst_curve(),
              1e3 * check.worst_nominal());
  EXPECT_EQ(to_urscript(all.program, all.robot, all.plan, {.version = "1.2.3"}).value(), *all.text);
  for (const char* part : {"# line 4: movel\n", "# line 5: movel\n", "mjarm 1.2.3", "UR5e"}) {
    EXPECT_THAT(*all.text, HasSubstr(part));
  }
}

TEST(Urscript, WaysRoundObstaclesStopAtTheirCorners) {
  const Exported all = exported("  - plan: {pos: [-0.2, -0.45, 0.3], euler: [180deg, 0, 0]}\n");
  ASSERT_TRUE(all.text.has_value()) << all.text.error().what;
  const std::vector<JointVec>& corners = all.plan.moves.back().corners;
  const UrScript script = all.script();
  std::vector<testing::UrStatement> moves;
  for (const testing::UrStatement& statement : script.statements) {
    if (statement.word == "movej") moves.push_back(statement);
  }
  ASSERT_EQ(moves.size(), corners.size());  // the first goes to where the program begins
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_NEAR(moves[i].lists[0][k], corners[i][static_cast<Eigen::Index>(k)], 1e-6) << i;
    }
  }
}

TEST(Urscript, TheCheckSeesEveryNumberThatIsWrong) {
  const Exported all = exported(
      "  - movej: {pos: [0.2, -0.45, 0.4], euler: [180deg, 0, 0]}\n"
      "  - movel: {pos: [-0.1, -0.45, 0.4], euler: [180deg, 0, 0], speed: 0.05, blend: 20mm}\n"
      "  - movel: {pos: [-0.1, -0.55, 0.4], euler: [180deg, 0, 0], speed: 0.05}\n"
      "  - wait: 0.5\n"
      "  - movec: {via: {pos: [0, -0.4, 0.4], euler: [180deg, 0, 0]}, to: {pos: [0.1, -0.45, 0.4], "
      "euler: [180deg, 0, 0]}}\n");
  const UrScript script = all.script();
  ASSERT_THAT(UrCheck(script, all.plan).problems(), IsEmpty());
  int tried = 0;
  for (std::size_t i = 1; i < script.statements.size(); ++i) {
    const auto& statement = script.statements[i];
    for (std::size_t k = 0; k < statement.lists.size(); ++k) {
      // Of a via point only the place counts.
      const bool via = statement.word == "movec" && k == 0;
      for (std::size_t n = 0; n < (via ? 3U : 6U); ++n) {
        UrScript wrong = script;
        wrong.statements[i].lists[k][n] += 1e-5;
        EXPECT_FALSE(UrCheck(wrong, all.plan).problems().empty()) << i << " " << k << " " << n;
        ++tried;
      }
    }
    UrScript less = script;
    less.statements.erase(less.statements.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_FALSE(UrCheck(less, all.plan).problems().empty()) << i;
    for (const char* name : {"a", "v"}) {
      if (statement.word != "movej" || i == 1) continue;
      UrScript wrong = script;
      wrong.statements[i].named[name] *= 0.99;
      EXPECT_FALSE(UrCheck(wrong, all.plan).problems().empty()) << i << name;
    }
  }
  EXPECT_GT(tried, 30);
  for (const char* broken : {"p[0.2", "(p", "end\n", "],"}) {
    std::string text = *all.text;
    text.erase(text.find(broken), 2);
    EXPECT_ANY_THROW(UrReader::read(text)) << broken;
  }
}

TEST(Urscript, PosesAreInTheControllersBaseWhereverTheArmStands) {
  const std::string urdf = find_model_file("ur5e")->parent_path().string() + "/ur5e.urdf";
  // The root of the URDF is turned by pi about z.
  const Exported turned = exported(
      "  - movej: {joints: [1.2, -1.5, 1.5, -1.57, -1.57, 0]}\n"
      "  - movel: {pos: [-0.1, 0.45, 0.4], euler: [180deg, 0, 0]}\n",
      "robot: " + urdf + "\n");
  ASSERT_TRUE(turned.text.has_value()) << turned.text.error().what;
  const Pose half{{0, 0, 0}, from_euler({0, 0, std::numbers::pi})};
  EXPECT_THAT(UrCheck(turned.script(), turned.plan, half).problems(), IsEmpty());
  EXPECT_NEAR(turned.script().statements.back().lists[0][0], 0.1, 1e-9);
  EXPECT_THAT(UrCheck(turned.script(), turned.plan).problems(), ::testing::Not(IsEmpty()));

  // On a wall, with a prefix before every name.
  const support::TempFolder folder;
  const auto scene =
      folder.write("cell.xml", R"(<mujoco>
  <asset><model name="arm" file=")" +
                                   (find_model_file("ur5e")->parent_path() / "ur5e.xml").string() +
                                   R"("/></asset>
  <worldbody><body name="wall" pos="0.3 0.2 1" euler="90 0 30"><attach model="arm" prefix="left_"/></body>
  </worldbody></mujoco>)");
  Program program;
  program.robot = scene.string();
  program.name = "wall";
  Result<Model> model = Model::load(scene, {.allow_outside = true});
  ASSERT_TRUE(model.has_value()) << model.error().what;
  const Arm arm = find_arm(*model, {.tip = "left_attachment_site"}).value();
  program.instructions = {move_j(std::vector<double>{-1.57, -1.34, 2.65, -1.3, 1.55, 0})};
  const Pose X_WT = fk(arm, std::vector<double>{-1.57, -1.34, 2.65, -1.3, 1.55, 0});
  program.instructions.push_back(move_l(X_WT * Pose{{0.02, 0, -0.05}, from_euler({0, 0, 0.2})}));
  const Robot robot{*model, arm};
  const ProgramPlan plan = plan_program(*model, arm, program);
  ASSERT_TRUE(plan.ok()) << plan.faults.front().what;
  const Result<std::string> text = to_urscript(program, robot, plan);
  ASSERT_TRUE(text.has_value()) << text.error().what;
  const Eigen::Matrix3d R = (Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX()) *
                             Eigen::AngleAxisd(std::numbers::pi / 6, Eigen::Vector3d::UnitZ()))
                                .toRotationMatrix();
  EXPECT_THAT(UrCheck(UrReader::read(*text), plan, {{0.3, 0.2, 1}, R}).problems(), IsEmpty());
}

TEST(Urscript, TheToolIsGivenInTheFlange) {
  const Exported other = exported(
      "  - movej: {pos: [0, -0.45, 0.4], euler: [180deg, 0, 0]}\n"
      "  - set: {tool: ee_link, frame: table}\n"
      "  - movel: {pos: [0.1, 0.1, 0.1], euler: [0, 90deg, 0]}\n",
      "robot: ur5e\nframes: {table: {pos: [0, -0.5, 0.3], quat: [1, 0, 0, 0]}}\n");
  const UrScript script = other.script();
  UrCheck check(script, other.plan);
  EXPECT_THAT(check.problems(), IsEmpty()) << *other.text;
  EXPECT_EQ(check.count("set_tcp"), 2);
  EXPECT_THAT(script.statements[0].lists[0], ::testing::Each(::testing::DoubleNear(0, 1e-9)));
  EXPECT_THAT(*other.text, HasSubstr("tool: ee_link"));
  EXPECT_NEAR(script.statements.back().lists[0][1], -0.4, 1e-9);
}

TEST(Urscript, OtherArmsAreRefused) {
  const Exported panda = exported("  - wait: 1\n", "robot: panda\n");
  ASSERT_FALSE(panda.text.has_value());
  EXPECT_EQ(panda.text.error().code, Errc::impossible);
  EXPECT_THAT(panda.text.error().what, HasSubstr("Universal Robots"));
  // The right names, another arm: the elbow's axis is turned round.
  Exported ur = exported("  - wait: 1\n");
  ur.robot.arm.joints[2].axis = -ur.robot.arm.joints[2].axis;
  const auto turned = to_urscript(ur.program, ur.robot, ur.plan);
  ASSERT_FALSE(turned.has_value());
  EXPECT_THAT(turned.error().what, HasSubstr("axes"));
  ur.plan.faults.push_back({{}, "wait", "no", "a fault", Errc::impossible});
  EXPECT_EQ(to_urscript(ur.program, ur.robot, ur.plan).error().what, "a fault");
}

TEST(Urscript, NamesBecomeIdentifiersAndComments) {
  Exported cell = exported("  - wait: 1\n");
  for (const std::string name : {"movej", "1 a-b", "\u684c\u5b50", "a\n  movej([1])\nend", ""}) {
    cell.program.name = name;
    const auto text = to_urscript(cell.program, cell.robot, cell.plan);
    const UrScript script = UrReader::read(text.value());
    EXPECT_EQ(script.name.rfind("mjarm_", 0), 0U) << script.name;
    EXPECT_THAT(UrCheck(script, cell.plan).problems(), IsEmpty()) << name;
  }
}

}  // namespace
}  // namespace mjarm::program
