// mjarm export, as a user calls it; what it writes is read back and walked through.
#include <gmock/gmock.h>

#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/program/program_reader.hpp"
#include "mjarm/program/urscript_check_test.hpp"

namespace mjarm::app {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string shipped_program(const std::string& name) {
  return std::string(MJARM_MODELS) + "/../examples/programs/" + name + ".yaml";
}

TEST(Export, ShippedProgramsAreTheSameMotion) {
  const support::TempFolder folder;
  for (const std::string name :
       {"ellipse", "letters", "movej", "movel", "point", "table", "ur5e"}) {
    SCOPED_TRACE(name);
    const std::string file = shipped_program(name);
    const auto result = mjarm({"export", file, "--to", "urscript"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const program::Program program = program::read_program(file).value();
    const Model model = Model::load(kUr5eScene).value();
    const Arm arm = find_arm(model).value();
    const program::ProgramPlan plan = program::plan_program(model, arm, program);
    const testing::UrScript script = testing::UrReader::read(result.out);
    EXPECT_EQ(script.name, "mjarm_" + name);
    testing::UrCheck check(script, plan);
    EXPECT_THAT(check.problems(), IsEmpty());
    EXPECT_NEAR(check.seconds(), plan.duration(), 0.1 * plan.duration());
    std::printf("%s: %zu statements, %.2f s planned, %.2f s by the script, within %.4f mm\n",
                name.c_str(), script.statements.size(), plan.duration(), check.seconds(),
                1e3 * check.worst_curve());
    if (name != "point") continue;  // planning again takes its time
    const auto out = folder.path() / (name + ".script");
    const auto written = mjarm({"export", file, "--to=urscript", "--out", out.string()});
    EXPECT_EQ(written.out, out.string() + "\n");
    EXPECT_EQ(folder.read(name + ".script"), result.out);
    EXPECT_EQ(mjarm({"--lang", "zh-CN", "export", file, "--to", "urscript"}).out, result.out);
  }
}

TEST(Export, WhatCannotBeExportedIsOneLine) {
  const support::TempFolder folder;
  const auto cell = [&](const std::string& text) {
    return folder.write("cell.yaml", text).string();
  };
  const std::string good = "robot: ur5e\nprogram:\n  - wait: 1\n";
  const auto wrong = mjarm({"export", cell(good), "--to", "urscritp"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(only_line(wrong), HasSubstr("did you mean \"urscript\"?"));
  EXPECT_EQ(mjarm({"export", cell(good)}).exit_code, 2);
  EXPECT_EQ(mjarm({"export", "--to", "urscript"}).exit_code, 2);
  EXPECT_EQ(mjarm({"export", "none.yaml", "--to", "urscript"}).exit_code, 2);
  const std::string itself = cell(good);
  EXPECT_EQ(mjarm({"export", itself, "--to", "urscript", "--out", itself}).exit_code, 2);
  EXPECT_EQ(folder.read("cell.yaml"), good);

  const auto panda =
      mjarm({"export", cell("robot: panda\nprogram:\n  - wait: 1\n"), "--to", "urscript"});
  EXPECT_EQ(panda.exit_code, 1);
  EXPECT_EQ(panda.out, "");
  EXPECT_THAT(only_line(panda), HasSubstr("Universal Robots"));

  const std::string faulty =
      cell("robot: ur5e\nprogram:\n  - movej: {joints: [0, 0, 9rad, 0, 0, 0]}\n");
  const auto fault = mjarm({"export", faulty, "--to", "urscript", "--out", itself + ".script"});
  EXPECT_EQ(fault.exit_code, 1);
  EXPECT_EQ(only_line(fault), only_line(mjarm({"run", faulty, "--headless"})));
  EXPECT_FALSE(folder.exists("cell.yaml.script"));
  const auto nowhere = mjarm({"export", cell(good), "--to", "urscript", "--out", "/none/x.script"});
  EXPECT_EQ(nowhere.exit_code, 1);
  EXPECT_THAT(only_line(nowhere), HasSubstr("/none"));
}

}  // namespace
}  // namespace mjarm::app
