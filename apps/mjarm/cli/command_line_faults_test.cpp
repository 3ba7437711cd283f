// What is wrong with a command line is told as what it is, with the nearest right word.
#include <gmock/gmock.h>

#include "apps/mjarm/commands/crane_test.hpp"
#include "apps/mjarm/commands/program_test.hpp"

namespace mjarm::app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// The one line of a refused command line; its exit code must be 2.
std::string refused_line(const std::vector<std::string>& words) {
  const support::ProgramResult result = mjarm(words);
  EXPECT_EQ(result.exit_code, 2) << ::testing::PrintToString(words) << result.err;
  return only_line(result);
}

TEST(CommandLineFaults, AMisspeltCommandIsToldBeforeItsOptions) {
  EXPECT_THAT(refused_line({"docter", "--json"}), HasSubstr("did you mean \"doctor\"?"));
  EXPECT_THAT(refused_line({"FK", "--robot", "ur5e"}), HasSubstr("unknown command \"FK\""));
  EXPECT_THAT(refused_line({"ki", "--robot", "ur5e"}), HasSubstr("(did you mean \"ik\"?)"));
  EXPECT_THAT(refused_line({"model", "inof", "--json"}), HasSubstr("did you mean \"info\"?"));
  EXPECT_THAT(refused_line({"demo", "elipse", "--headless"}), HasSubstr("\"ellipse\""));
}

TEST(CommandLineFaults, AnEmptyValueIsAMissingOne) {
  for (const char* robot : {"--robot=", "--robot"}) {
    EXPECT_THAT(refused_line({"fk", robot, "--q", "0,0,0,0,0,0"}),
                HasSubstr("--robot needs a value"));
  }
  EXPECT_THAT(refused_line({"fk", "--robot", "ur5e", "--q", "--out", "x"}),
              HasSubstr("--q needs a value"));
}

TEST(CommandLineFaults, TheNearestWordIsNeverTheWordItself) {
  EXPECT_THAT(refused_line({"fk", "--robot", "ur5e", "--", "--q", "0"}),
              HasSubstr("\"--q\" is not expected after \"mjarm fk\""));
}

TEST(CommandLineFaults, WordsOfOtherProgramsGetOurs) {
  EXPECT_THAT(refused_line({"ik", "--robot", "ur5e", "--pos", "0,0,0", "--rpy", "0,0,0"}),
              HasSubstr("did you mean \"--euler\"?"));
  EXPECT_THAT(refused_line({"doctor", "--lang", "cn"}), HasSubstr("did you mean \"zh-CN\"?"));
}

TEST(CommandLineFaults, LargeNumbersAreToldAsTheyAre) {
  EXPECT_THAT(refused_line({"ik", "--robot", "ur5e", "--pos", "0.3,0.3,0.3", "--quat", "1,0,0,0",
                            "--threads", "18446744073709551615"}),
              HasSubstr("--threads 18446744073709551615"));
}

TEST(CommandLineFaults, AFlagWithAValueIsToldInTheLanguageInUse) {
  EXPECT_THAT(refused_line({"doctor", "--json=maybe"}), HasSubstr("--json takes no value"));
  EXPECT_THAT(refused_line({"doctor", "--json=maybe", "--lang", "zh-CN"}),
              HasSubstr("--json 不带值"));
}

TEST(CommandLineFaults, OptionsAreNamedAsTheyWereWritten) {
  const std::vector<std::string> line{"path", "--robot",    "ur5e",    "--from",    "0.3,-0.4,0.4",
                                      "--to", "0,-0.4,0.4", "--euler", "180deg,0,0"};
  const auto with = [&](const char* option, const char* value) {
    std::vector<std::string> words = line;
    words.insert(words.end(), {option, value});
    return refused_line(words);
  };
  for (const char* wrong : {"0", "181deg"}) {
    EXPECT_THAT(with("--max-step", wrong), HasSubstr("--max-step must be above 0 and at most pi"));
  }
  EXPECT_THAT(with("--orientation-tol", "90deg"), HasSubstr("--orientation-tol must be"));
  EXPECT_THAT(refused_line({"view", "ur5e", "--camera", "1,2"}), HasSubstr("--camera: "));
  EXPECT_THAT(refused_line({"view", "ur5e", "--camera", "fornt"}), HasSubstr("--camera: "));
}

/// Degrees and millimetres that lack their unit, whatever takes them.
TEST(CommandLineFaults, DegreesAndMillimetresWithoutTheirUnitAreRefusedEverywhere) {
  const std::string ur5e = "ur5e", pos = "0.3,0.3,0.3";
  const std::pair<std::vector<std::string>, const char*> wrong[] = {
      {{"ik", "--robot", ur5e, "--pos", pos, "--euler", "180,0,90"}, "--euler: 180 "},
      {{"ik", "--robot", ur5e, "--pos", "300,0.3,0.3", "--quat", "1,0,0,0"}, "write 300mm"},
      {{"ik", "--robot", ur5e, "--pos", pos, "--quat", "1,0,0,0", "--seed-q", "90,0,0,0,0,0"},
       "write 90deg"},
      {{"fk", "--robot", ur5e, "--q", "0,-90,90,-90,-90,0"}, "write -90deg"},
      {{"path", "--robot", ur5e, "--from", pos, "--to", "300,0,0", "--quat", "1,0,0,0"}, "300mm"},
      {{"path", "--robot", ur5e, "--from", pos, "--to", "0,0.3,0.3", "--quat", "1,0,0,0", "--start",
        "0,-90,0,0,0,0"},
       "write -90deg"},
      {{"time", "--problem", "p2p", "--points", "0,0,0,0,0,0;90,0,0,0,0,0"}, "write 90deg"},
      {{"plan", "--robot", ur5e, "--goal", "0,-90,0,0,0,0"}, "write -90deg"},
      {{"plan", "--robot", ur5e, "--pos", "0,400,300", "--euler", "0,0,0"}, "write 400mm"},
      {{"render", ur5e, "--camera", "120,-20,2.5", "--out", "/proc/x.png"}, "write 120deg"},
      {{"view", ur5e, "--camera", "120,-20,2.5"}, "write 120deg"}};
  for (const auto& [words, says] : wrong) EXPECT_THAT(refused_line(words), HasSubstr(says));
}

TEST(CommandLineFaults, DegreesInFilesOfRequestsAreRefusedWithTheirLine) {
  const support::TempFolder folder;
  const auto in = folder.write("q.jsonl", "{\"q\":[0,0,0,0,0,0]}\n{\"q\":[0,-90,90,0,0,0]}\n");
  EXPECT_THAT(refused_line({"fk", "--robot", "ur5e", "--in", in.string()}),
              HasSubstr("q.jsonl:2: q: shoulder_lift_joint = -90 rad is far beyond its limits"));
}

TEST(CommandLineFaults, ProgramsTakeALengthForASlide) {
  const support::TempFolder folder;
  const std::string robot = write_crane(folder);
  const auto checked = [&](const std::string& joints) {
    const auto file = folder.write(
        "我的 模型/p.yaml", "robot: 起重机.xml\nprogram:\n  - movej: {joints: [" + joints + "]}\n");
    return mjarm({"check", file.string()});
  };
  EXPECT_EQ(checked("0.9, 0.3, 5cm").exit_code, 0) << checked("0.9, 0.3, 5cm").err;
  EXPECT_EQ(checked("50deg, 0.3, 5cm").exit_code, 0);
  const auto degrees = checked("0.9, 0.3, 5deg");
  EXPECT_EQ(degrees.exit_code, 2);
  EXPECT_THAT(only_line(degrees), HasSubstr("joint lift slides: a length is needed"));
  const auto bare = checked("90, 0.3, 0");
  EXPECT_EQ(bare.exit_code, 2);
  EXPECT_THAT(only_line(bare), HasSubstr("write 90deg"));
}

/// What a demo does not use is refused, and its help shows what it takes.
TEST(CommandLineFaults, DemosRefuseOptionsThatTheyDoNotUse) {
  const std::vector<std::string> unused[] = {
      {"reach", "--robot", "ur5e"}, {"reach", "--seconds", "3"}, {"point", "--control", "servo"},
      {"ellipse", "--text", "HI"},  {"ur5e", "--guide"},         {"car", "--robot", "ur5e"},
      {"car", "--tip", "x"},        {"flip", "--guide"},         {"avoid", "--meshes"}};
  for (std::vector<std::string> words : unused) {
    words.insert(words.begin(), "demo");
    words.insert(words.end(), {"--headless", "--out", "/proc/x"});
    const std::string line = refused_line(words);
    EXPECT_THAT(line, HasSubstr("does not use " + words[2] + "; it takes --out, --headless"));
  }
  // The order does not matter.
  EXPECT_THAT(refused_line({"demo", "--guide", "reach"}), HasSubstr("does not use --guide"));
  const auto help = mjarm({"demo", "reach", "--help"});
  EXPECT_THAT(help.out, HasSubstr("--headless"));
  EXPECT_THAT(help.out, Not(HasSubstr("--guide")));
  EXPECT_THAT(mjarm({"demo", "movel", "--help"}).out, HasSubstr("--guide"));
}

TEST(CommandLineFaults, CheckListsAllThatIsWrongWithAText) {
  const support::TempFolder folder;
  const auto file = folder.write("p.yaml",
                                 "robot: ur5e\nprogram:\n  - wayt: 1\n  - movell: up\n"
                                 "  - movej: {joints: [0, 0]}\n");
  const auto result = mjarm({"check", file.string()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(support::lines_of(result.out).size(), 3U) << result.out;
  EXPECT_THAT(only_line(result), HasSubstr("p.yaml:3:5: unknown instruction \"wayt\""));
  EXPECT_THAT(only_line(result), HasSubstr("(and 2 more)"));
  const auto told = nlohmann::json::parse(mjarm({"check", file.string(), "--json"}).out);
  EXPECT_EQ(told.at("ok"), false);
  EXPECT_EQ(told.at("faults").size(), 3U);
  EXPECT_EQ(told.at("faults").at(1).at("line"), 4);
}

/// How deep, and not how deep at the border; and what mends it, as `path` tells it.
TEST(CommandLineFaults, CheckTellsTheDepthAndTheRepairOfAClosedWay) {
  const support::TempFolder folder;
  const auto file = folder.write(
      "p.yaml",
      "robot: ur5e\nprogram:\n  - movej: {pos: [0.35, -0.05, 0.6], euler: [180deg, 0, 0]}\n"
      "  - movel: {pos: [-0.35, -0.05, 0.6], euler: [180deg, 0, 0]}\n");
  const auto result = mjarm({"check", file.string()});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_THAT(result.out, HasSubstr("cylinder round the base axis by 0.084 m"));
  EXPECT_THAT(result.out, HasSubstr("it works if you"));
  const auto told = nlohmann::json::parse(mjarm({"check", file.string(), "--json"}).out);
  EXPECT_TRUE(told.at("faults").at(0).contains("fix")) << told.dump();
}

}  // namespace
}  // namespace mjarm::app
