#include <cmath>
#include <filesystem>

#include "apps/mjarm/learn/learn_test.hpp"
#include "mjarm/program/load_program.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

class Learn : public testing::LearnTest {};

TEST_F(Learn, ListsNinePages) {
  const auto english = run({});
  EXPECT_EQ(english.exit_code, 0) << english.err;
  EXPECT_EQ(support::lines_of(english.out).size(), 11u) << english.out;
  EXPECT_NE(english.out.find("2. MJCF: "), std::string::npos) << english.out;
  EXPECT_NE(english.out.find("09_learning.md"), std::string::npos) << english.out;
  const auto chinese = run({"--lang", "zh-CN"});
  EXPECT_NE(chinese.out.find("5. 逆运动学："), std::string::npos) << chinese.out;
  EXPECT_NE(chinese.out.find("09_learning.zh-CN.md"), std::string::npos) << chinese.out;
  EXPECT_EQ(json::parse(run({"--json"}).out).at("pages").size(), 9u);
}

TEST_F(Learn, SaysWhereThePagesAre) {
  std::filesystem::create_directories(folder_.path() / "docs" / "learn");
  folder_.write("docs/learn/01_set_up.md", "# 1. Set up\n");
  std::filesystem::create_directory_symlink(MJARM_MODELS, folder_.path() / "models");
  support::RunOptions options;
  options.environment = {{"MJARM_MODELS", (folder_.path() / "models").string()}};
  const auto result = mjarm({"learn"}, options);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find((folder_.path() / "docs" / "learn").string() + ":"), std::string::npos)
      << result.out;
}

TEST_F(Learn, UsageIsToldInOneLine) {
  expect_refused(run({"check"}), "1 to 9");
  expect_refused(run({"check", "0"}), "1 to 9");
  expect_refused(run({"check", "10"}), "1 to 9");
  expect_refused(run({"check", "two"}), "two");
  expect_refused(run({"check", "2", "x.xml", "--robot", "ur5e"}), "--robot");
  expect_refused(run({"check", "2", "x.xml", "--python", "python3"}), "--python");
}

TEST_F(Learn, MissingFilesNameTheExercise) {
  const std::pair<const char*, const char*> cases[] = {
      {"1", "mine"},       {"2", "falls.xml"},         {"3", "moving.json"},
      {"4", "turn.jsonl"}, {"5", "answers.jsonl"},     {"6", "own.yaml"},
      {"7", "can.yaml"},   {"9", "second/report.json"}};
  for (const auto& [page, file] : cases) {
    expect_refused(check(page, ""), file);
    if (std::string(page) != "9") expect_refused(check(page, ""), std::string("page ") + page);
  }
  expect_refused(check("8", "none.py"), "none.py");
}

TEST_F(Learn, HostileFilesAreRefusedInOneLine) {
  const std::string deep(100000, '['), zeros(5000, '\0');
  for (const std::string& content : {std::string(), deep, zeros, std::string("{\"q\":")}) {
    expect_refused(check_text("2", "a.xml", content), "a.xml");
    expect_refused(check_text("3", "a.json", content), "a.json");
    expect_refused(check_text("4", "a.jsonl", content), "a.jsonl");
    expect_refused(check_text("5", "a.jsonl", content), "a.jsonl");
    if (!content.empty()) expect_refused(check_text("6", "a.yaml", content), "a.yaml");
  }
  expect_refused(check_text("3", "a.json", "{\"q\": [0, 0, 0, 0, 0, 0],\n \"pos\": [NaN, 0, 0]}"),
                 "a.json:2:");
  expect_refused(check_text("3", "a.json", R"({"q":["a",0,0,0,0,0],"pos":[0,0,0]})"), "\"q\"");
  expect_refused(check_text("3", "a.json", R"({"q":[0,0,0],"pos":[0,0,0]})"), "\"q\"");
  expect_refused(check_text("3", "a.json", R"({"q":[0,0,0,0,0,0],"pos":[1e999,0,0]})"), "a.json");
  expect_refused(check_text("4", "a.jsonl", "{\"quat\":[1,0,0,0]}\n{\"quat\":[1,0]}\n"),
                 "a.jsonl:2:");
  expect_refused(check_text("4", "a.jsonl", "{\"quat\":[1,0,0,0]}\n"), "at least 2");
  expect_refused(check_text("5", "a.jsonl", R"({"pos":[0,0,0],"quat":[1,0,0,0],"q":7})"),
                 "a.jsonl:1:");
  expect_refused(check("3", folder_.path().string()), folder_.path().string());
}

TEST_F(Learn, Page1LooksAtTheEllipse) {
  std::filesystem::create_directory(folder_.path() / "mine");
  const json good = {{"name", "ellipse"},
                     {"ok", true},
                     {"cycle_time", 4.68},
                     {"path_error_max", 9.6e-08},
                     {"coverage", 1.0}};
  const auto with = [&](const json& change) {
    json report = good;
    report.update(change);
    folder_.write("mine/report.json", report.dump());
    return check("1", "mine");
  };
  expect_refused(check("1", "mine"), "holds no report.json");
  expect_right(with(json::object()), "0.096 um, 100.0 %");
  expect_right(with({{"speed_dips", {{{"least", 0.1}, {"joint", "elbow"}, {"limit", "jerk"}}}}}),
               "0.1 m/s, because elbow is at its limit of jerk");
  expect_wrong(with({{"name", "movel"}}), "report of movel");
  expect_wrong(with({{"ok", false}, {"detail", "out of reach"}, {"coverage", 0.25}}),
               "25.0 % was drawn: out of reach");
  const auto shipped = program::load_program("ellipse");
  ASSERT_TRUE(shipped) << shipped.error().what;
  expect_wrong(with({{"cycle_time", shipped->plan.duration()}}), "comes with the demo");
  expect_refused(with({{"ok", "yes"}}), "no report of a demo");
  expect_refused(with({{"cycle_time", "long"}}), "no report of a demo");
  folder_.write("mine/report.json", "[1]");
  expect_refused(check("1", "mine"), "report.json");
}

/// The file of page 2 with `joint` in the body of the box.
std::string box_with(const std::string& joint, const std::string& name = "box") {
  return R"(<mujoco><compiler angle="radian"/><worldbody>
    <geom name="floor" type="plane" size="5 5 0.1"/>
    <body name=")" +
         name + R"(" pos="0 0 2">)" + joint + R"(
      <geom type="box" size="0.5 0.5 0.5" density="500"/></body></worldbody></mujoco>)";
}

TEST_F(Learn, Page2SaysWhatTheBoxCanDo) {
  const auto with = [&](const std::string& joint) {
    return check_text("2", "falls.xml", box_with(joint));
  };
  expect_right(with("<freejoint/>"), "fell 1.500 m, touched after 0.55 s");
  expect_right(with(R"(<joint axis="0 1 0" pos="-1 0 0"/>)"), "lever of 1.000 m");
  // As the page's own program measures it.
  expect_right(with(R"(<joint axis="0 1 0" pos="-1 0 0"/>)"), "z = 1.149 m");
  expect_right(with(R"(<joint type="slide" axis="0 0 1"/>)"), "slides along (0, 0, 1)");
  expect_wrong(with(""), "no joint");
  expect_wrong(with(R"(<joint axis="0 1 0"/>)"), "through the middle of mass");
  expect_wrong(with(R"(<joint axis="0 1 0" pos="0 0 1"/>)"), "straight above or below");
  expect_wrong(with(R"(<joint axis="0 0 1" pos="-1 0 0"/>)"), "vertical hinge");
  expect_wrong(with(R"(<joint type="slide" axis="1 0 0"/>)"), "level");
  expect_wrong(check_text("2", "falls.xml", box_with("<freejoint/>", "bax")), "no body \"box\"");
  expect_refused(with("<freejoint/><freejoint/>"), "falls.xml");
}

TEST_F(Learn, Page2KnowsAnglesReadInDegrees) {
  std::string model = box_with("<freejoint/>");
  model.replace(model.find("pos=\"0 0 2\""), 0, "euler=\"0.5 0.3 0\" ");
  EXPECT_EQ(check_text("2", "falls.xml", model).out.find("tilted"), std::string::npos);
  model.erase(model.find(" angle=\"radian\""), 15);
  const auto result = check_text("2", "falls.xml", model);
  expect_right(result, "tilted by 0.58 deg only");
}

TEST_F(Learn, SpeaksChinese) {
  const auto result =
      check_text("2", "falls.xml", box_with(R"(<joint axis="0 1 0"/>)"), {"--lang", "zh-CN"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.out.find("要改  它能转动，但重力没有力臂"), std::string::npos) << result.out;
  EXPECT_NE(only_line(result).find("第 2 页：还不对"), std::string::npos) << result.err;
}

TEST_F(Learn, TellsTheSameAsJson) {
  const auto result = check_text("2", "falls.xml", box_with(""), {"--json"});
  EXPECT_EQ(result.exit_code, 1);
  const json report = json::parse(result.out);
  EXPECT_EQ(report.at("page"), 2);
  EXPECT_EQ(report.at("ok"), false);
  EXPECT_EQ(report.at("findings")[0].at("kind"), "wrong");
}

}  // namespace
}  // namespace mjarm::app
