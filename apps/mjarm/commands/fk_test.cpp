#include "apps/mjarm/commands/oracle_test.hpp"
#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

const std::string kGoodLine = "{\"q\":[0.1,-1.2,1.3,-1.4,-1.5,0.6]}\n";

TEST(Fk, OneRequestWithUnits) {
  const auto radians = mjarm({"fk", "--robot", "ur5e", "--q",
                              "-1.5707963267948966,-1.5707963267948966,"
                              "1.5707963267948966,-1.5707963267948966,-1.5707963267948966,0"});
  ASSERT_EQ(radians.exit_code, 0) << radians.err;
  const auto objects = json_lines(radians.out);
  ASSERT_EQ(objects.size(), 1u);
  const Pose X_WT = pose_of(objects[0]);
  EXPECT_LT((X_WT.p - Eigen::Vector3d(-0.134, 0.492, 0.488)).norm(), 1e-9);
  const auto degrees =
      mjarm({"fk", "--robot", "ur5e", "--q", "-90deg, -90 deg, 90deg, -90deg, -90deg, 0"});
  EXPECT_EQ(degrees.out, radians.out);
}

TEST(Fk, FilesMatchMujocoLineByLine) {
  const support::TempFolder folder;
  Rng rng(1);
  std::string input;
  std::vector<std::vector<double>> qs;
  for (int i = 0; i < 500; ++i) {
    std::vector<double> q(6);
    for (double& value : q) value = rng.uniform(-6.28, 6.28);
    input += json({{"q", q}, {"note", "other members are ignored"}}).dump() + "\n";
    qs.push_back(q);
  }
  folder.write("q.jsonl", input);
  const auto result = mjarm({"fk", "--robot", "ur5e", "--in", "q.jsonl", "--out", "x.jsonl"},
                            {.folder = folder.path(), .input = {}, .environment = {}});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err, "");
  const auto answers = json_lines(folder.read("x.jsonl"));
  ASSERT_EQ(answers.size(), qs.size());
  Oracle oracle(kUr5eScene, "attachment_site");
  for (std::size_t i = 0; i < qs.size(); ++i) {
    const Pose expected = oracle.fk(qs[i]), got = pose_of(answers[i]);
    ASSERT_LT((expected.p - got.p).norm(), 1e-12);
    ASSERT_LT(angle_between(expected.R, got.R), 1e-12);
  }
}

void expect_ground_truth(const std::filesystem::path& file, const std::vector<std::string>& robot,
                         std::size_t dof) {
  const json data = support::load_json(file);
  std::string input;
  for (const json& entry : data.at("cases")) {
    std::vector<double> q = numbers(entry.at("q"));
    q.resize(dof);
    input += json({{"q", q}}).dump() + "\n";
  }
  std::vector<std::string> arguments = {"fk", "--in", "-"};
  arguments.insert(arguments.end(), robot.begin(), robot.end());
  const auto result = mjarm(arguments, {.folder = {}, .input = input, .environment = {}});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto answers = json_lines(result.out);
  ASSERT_EQ(answers.size(), data.at("cases").size());
  ASSERT_GE(answers.size(), 100u);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const Pose expected = pose_of(data.at("cases")[i]), got = pose_of(answers[i]);
    EXPECT_LT((expected.p - got.p).norm(), 1e-9) << i;
    EXPECT_LT(angle_between(expected.R, got.R), 1e-9) << i;
  }
}

TEST(Fk, Ur5eMatchesGroundTruth) {
  MJARM_TEST_FILE(file, "ground_truth/ur5e_menagerie.json.gz");
  expect_ground_truth(file, {"--robot", "ur5e"}, 6);
}

TEST(Fk, PandaMatchesGroundTruth) {
  MJARM_TEST_FILE(file, "ground_truth/panda_menagerie.json.gz");
  expect_ground_truth(file, {"--robot", "panda", "--tip", "hand"}, 7);
}

TEST(Fk, AnyWorkingDirectoryAndStandardStreams) {
  const support::TempFolder folder;
  const support::RunOptions there{.folder = folder.path(), .input = kGoodLine, .environment = {}};
  const auto by_name = mjarm({"fk", "--robot", "ur5e", "--in", "-", "--out", "-"}, there);
  ASSERT_EQ(by_name.exit_code, 0) << by_name.err;
  EXPECT_EQ(by_name.out, mjarm({"fk", "--robot", kUr5eScene, "--in", "-"}, there).out);
  EXPECT_EQ(json_lines(by_name.out).size(), 1u);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Fk, BlankLinesCarriageReturnsAndByteOrderMarkAreFine) {
  const std::string line = kGoodLine.substr(0, kGoodLine.size() - 1);
  const std::string input = "\xEF\xBB\xBF" + line + "\r\n\n  \t\n\r\n" + line;
  const auto result = mjarm({"fk", "--robot", "ur5e", "--in", "-"},
                            {.folder = {}, .input = input, .environment = {}});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json_lines(result.out).size(), 2u);
  const auto empty = mjarm({"fk", "--robot", "ur5e", "--in", "-"},
                           {.folder = {}, .input = "\n\n", .environment = {}});
  EXPECT_EQ(empty.exit_code, 0);
  EXPECT_EQ(empty.out, "");
}

TEST(Fk, MalformedLinesNameFileAndLineAndWriteNothing) {
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"{\"q\":[1,2,3,4,5,6]", "not valid JSON"},
      {"nonsense", "not valid JSON at column"},
      {"{\"q\":[1,2,3,4,5,NaN]}", "not valid JSON"},
      {"{\"q\":[1,2,3,4,5,Infinity]}", "not valid JSON"},
      {"{\"q\":[1,2,3,4,5,1e999]}", "beyond the range"},
      {"{\"q\":[1,2,3,4,5]}", "\"q\" must have 6 numbers, it has 5"},
      {"{\"q\":[1,2,3,4,5,6,7]}", "\"q\" must have 6 numbers, it has 7"},
      {"{\"q\":[1,2,3,4,5,\"6\"]}", "entry 5 of \"q\" is not a number"},
      {"{\"q\":[1,2,null,4,5,6]}", "entry 2 of \"q\" is not a number"},
      {"{\"q\":[true,2,3,4,5,6]}", "entry 0 of \"q\" is not a number"},
      {"{\"q\":1}", "must be a list of 6 numbers"},
      {"{\"Q\":[1,2,3,4,5,6]}", "the key \"Q\" is not known here (did you mean \"q\"?)"},
      {"{}", "\"q\" is missing"},
      {"[1,2,3,4,5,6]", "a JSON object"},
      {"42", "a JSON object"},
      {"{\"q\":[1,2,3,4,5,6]} {}", "not valid JSON"},
      {std::string(500000, '['), "nested too deeply"},
      {"{\"q\":" + std::string(100000, '[') + std::string(100000, ']') + "}", "nested too deeply"},
      {"{\"q\":[\"" + std::string(2000000, 'x') + "\"]}", "longer than"},
      {std::string("{\"q\":[1,2,3,4,5,6]\0}", 20), "not valid JSON"},
      {"{\"q\":[\"\xff\xfe\"]}", "not valid JSON"},
  };
  for (const auto& [line, says] : bad) {
    SCOPED_TRACE(line.substr(0, 60));
    const support::TempFolder folder;
    folder.write("q.jsonl", kGoodLine + "\n" + line + "\n" + kGoodLine);
    const auto result = mjarm({"fk", "--robot", "ur5e", "--in", "q.jsonl", "--out", "x.jsonl"},
                              {.folder = folder.path(), .input = {}, .environment = {}});
    EXPECT_EQ(result.exit_code, 2);
    const std::string message = only_line(result);
    EXPECT_EQ(message.rfind("q.jsonl:3: ", 0), 0u) << message;
    EXPECT_NE(message.find(says), std::string::npos) << message;
    EXPECT_EQ(result.out, "");
    EXPECT_FALSE(folder.exists("x.jsonl"));
  }
}

TEST(Fk, AFailedRunKeepsTheOldResult) {
  const support::TempFolder folder;
  folder.write("q.jsonl", kGoodLine + "bad\n");
  folder.write("x.jsonl", "old");
  const auto result = mjarm({"fk", "--robot", "ur5e", "--in", "q.jsonl", "--out", "x.jsonl"},
                            {.folder = folder.path(), .input = {}, .environment = {}});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(folder.read("x.jsonl"), "old");
}

TEST(Fk, BadFilesAndValues) {
  const support::TempFolder folder;
  folder.write("robot.xml", "<mujoco><worldbody/>");
  folder.write("q.jsonl", kGoodLine);
  const std::vector<std::pair<std::vector<std::string>, int>> cases = {
      {{"--robot", "ur5e", "--in", "missing.jsonl"}, 2},
      {{"--robot", "ur5e", "--in", "."}, 2},
      {{"--robot", "ur5f", "--in", "q.jsonl"}, 2},
      {{"--robot", "robot.xml", "--in", "q.jsonl"}, 2},
      {{"--robot", "q.jsonl", "--in", "q.jsonl"}, 2},
      {{"--robot", "ur5e", "--tip", "nowhere", "--in", "q.jsonl"}, 2},
      {{"--robot", "ur5e", "--in", "q.jsonl", "--out", "no/such/folder"}, 1},
      {{"--robot", "ur5e", "--in", "q.jsonl", "--out", "."}, 2},
      {{"--robot", "ur5e", "--q", "1,2,3"}, 2},
      {{"--robot", "ur5e", "--q", "1,2,3,4,5,6mm"}, 2},
      {{"--robot", "ur5e", "--q", "1,2,3,4,5,nan"}, 2},
      {{"--robot", "ur5e", "--q", "1,2,3,4,5,"}, 2},
  };
  for (const auto& [arguments, code] : cases) {
    std::vector<std::string> all = {"fk"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const auto result = mjarm(all, {.folder = folder.path(), .input = {}, .environment = {}});
    SCOPED_TRACE(::testing::PrintToString(arguments));
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_FALSE(only_line(result).empty());
    EXPECT_EQ(result.out, "");
  }
}

}  // namespace
}  // namespace mjarm::app
