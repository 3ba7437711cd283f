// What a file of JSON says is never dropped without a word: keys that stand twice, that are
// misspelt, that contradict others; and nothing of it is obeyed by a terminal.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/planning/crane_problems_test.hpp"

namespace mjarm::app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class StrictInput : public ::testing::Test {
 protected:
  /// The one line with which a command refuses a file of this content.
  std::string refused(std::vector<std::string> command, const std::string& content,
                      const std::string& name = "in.jsonl") {
    command.insert(command.end(), {"--in", folder_.write(name, content).string()});
    const auto result = mjarm(command);
    EXPECT_EQ(result.exit_code, 2) << content << result.err;
    EXPECT_THAT(result.err, HasSubstr(name));
    return only_line(result);
  }

  support::TempFolder folder_;
};

TEST_F(StrictInput, KeysThatStandTwiceAreRefused) {
  const std::string q = "[0,-1.5,1.5,0,0,0]";
  EXPECT_THAT(refused({"fk", "--robot", "ur5e"}, "{\"q\":" + q + ",\"q\":[0,0,0,0,0,0]}"),
              HasSubstr("in.jsonl:1: the key \"q\" stands twice"));
  EXPECT_THAT(refused({"ik", "--robot", "ur5e"},
                      R"({"pos":[0.3,0.2,0.4],"quat":[1,0,0,0],"pos":[0.3,0.2,0.5]})"),
              HasSubstr("\"pos\" stands twice"));
  const std::string paths =
      folder_.write("paths.json", R"({"a":{"path":[[0,0,0]],"path":[[9,9,9]]}})").string();
  const std::string problems =
      folder_.write("problems.json", testing::crane_problems().dump()).string();
  const auto verified = mjarm({"verify", paths, "--in", problems});
  EXPECT_EQ(verified.exit_code, 2);
  EXPECT_THAT(only_line(verified), HasSubstr("paths.json: the key \"path\" stands twice"));
}

TEST_F(StrictInput, MisspeltOptionalKeysAreRefusedWithTheOneThatIsMeant) {
  EXPECT_THAT(refused({"ik", "--robot", "ur5e"},
                      R"({"pos":[0.3,0.2,0.4],"quat":[1,0,0,0],"sed":[0,0,0,0,0,0]})"),
              HasSubstr("\"sed\" is not known here (did you mean \"seed\"?)"));
  const std::string line =
      R"({"type":"line","from":{"pos":[0.3,0.2,0.4],"quat":[1,0,0,0]},"to":{"pos":[0.3,0.2,0.5],)"
      R"("quat":[1,0,0,0]},)";
  EXPECT_THAT(refused({"path", "--robot", "ur5e"}, line + R"("maxstep":0.1})"),
              HasSubstr("\"max_step\""));
  EXPECT_THAT(refused({"path", "--robot", "ur5e"}, line + R"("sped":0.1})"),
              HasSubstr("\"speed\""));
  EXPECT_THAT(
      refused({"time", "--problem", "p2p"}, R"({"limits":{"v":[1],"a":[5],"j":[20]},)"
                                            R"("cases":[{"id":1,"q0":[0],"q1":[1],"V0":[0.5]}]})"),
      HasSubstr("cases[0]: the key \"V0\" is not known here (did you mean \"v0\"?)"));
}

TEST_F(StrictInput, KeysOfObjectsWithinAreLookedAtAsWell) {
  const std::string pose = R"({"pos":[0.3,0.2,0.4],"quat":[1,0,0,0])",
                    note = R"(,"qaut":[0,1,0,0]})";
  const std::string meant = R"(the key "qaut" is not known here (did you mean "quat"?))";
  EXPECT_THAT(refused({"path", "--robot", "ur5e"},
                      R"({"type":"line","from":)" + pose + "},\"to\":" + pose + note + "}"),
              HasSubstr("in.jsonl:1: to: " + meant));
  EXPECT_THAT(refused({"path", "--robot", "ur5e"},
                      R"({"type":"poses","poses":[)" + pose + "}," + pose + note + "]}"),
              HasSubstr("in.jsonl:1: poses[1]: " + meant));
  const auto misspelt = [&](const char* place, const char* key) {
    nlohmann::json file = testing::crane_problems();
    file[nlohmann::json::json_pointer(place)][key] = {1, 2, 3};
    return refused({"plan"}, file.dump(), "p.json");
  };
  EXPECT_THAT(misspelt("/robot", "lowr"), HasSubstr("robot: the key \"lowr\""));
  EXPECT_THAT(misspelt("/robot/joints/0", "limit"), HasSubstr("joints[0]: the key \"limit\""));
  EXPECT_THAT(misspelt("/robot/spheres/0", "centre"), HasSubstr("did you mean \"center\"?"));
  EXPECT_THAT(misspelt("", "problem"), HasSubstr("did you mean \"problems\"?"));
  EXPECT_THAT(
      refused({"time", "--problem", "p2p"}, R"({"limits":{"v":[1],"a":[5],"j":[20],"J":[9]},)"
                                            R"("cases":[{"id":1,"q0":[0],"q1":[1]}]})"),
      HasSubstr("limits: the key \"J\" is not known here (did you mean \"j\"?)"));
}

TEST_F(StrictInput, WhatOthersWriteBesideItIsTaken) {
  const auto result =
      mjarm({"fk", "--robot", "ur5e", "--in",
             folder_.write("q.jsonl", R"({"ok":true,"q":[0,-1.5,1.5,0,0,0],"us":3.5})").string()});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(StrictInput, NothingInAMessageIsObeyedByATerminal) {
  const auto plan =
      refused({"plan", "--problem", "\x1b[31m\a\xff"}, testing::crane_problems().dump(), "p.json");
  EXPECT_THAT(plan, HasSubstr("\\x1b[31m\\x07\\xff"));
  EXPECT_THAT(plan, Not(HasSubstr("\x1b")));
}

TEST_F(StrictInput, NamesOfFilesInTablesAreObeyedByNoTerminal) {
  // ESC [ as XML and YAML can have it: the one character U+009B.
  const auto model = folder_.write("m.xml",
                                   "<mujoco><worldbody><body name=\"b\xc2\x9b"
                                   "1m\"><joint name=\"j\xc2\x9b"
                                   "1m\"/>"
                                   "<geom size=\".1\"/></body></worldbody></mujoco>");
  const auto program = folder_.write(
      "p.yaml",
      "robot: ur5e\nprogram:\n  - wait: 1\n  - {comment: \"\\e[1m\\x9b1m\"}\n  - \"\\e[1m\": 1\n");
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{"model", "tree", model.string()},
                                             {"model", "info", model.string()},
                                             {"model", "check", model.string()},
                                             {"model", "tree", model.string(), "--json"},
                                             {"model", "info", model.string(), "--json"},
                                             {"check", program.string()},
                                             {"check", program.string(), "--json"}}) {
    const auto result = mjarm(command);
    EXPECT_NE(result.out, "") << command[0] << command[1];
    EXPECT_THAT(result.out + result.err, Not(HasSubstr("\x1b"))) << command[0] << command[1];
    EXPECT_THAT(result.out + result.err, Not(HasSubstr("\xc2\x9b"))) << command[0] << command[1];
  }
  EXPECT_THAT(mjarm({"model", "tree", model.string()}).out, HasSubstr("b\\x9b"
                                                                      "1m"));
}

}  // namespace
}  // namespace mjarm::app
