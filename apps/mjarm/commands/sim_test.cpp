// mjarm sim, as a user calls it; and mjarm render of a model that moves.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>

#include "apps/mjarm/commands/crane_test.hpp"
#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/core/csv.hpp"
#include "mjarm/core/os_child_input.hpp"

namespace mjarm::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class SimCommand : public ::testing::Test {
 protected:
  /// Runs mjarm sim into the folder `out`; it must end well.
  nlohmann::json run(const std::string& out, std::vector<std::string> words) {
    words.insert(words.begin(), "sim");
    words.insert(words.end(), {"--out", (folder_.path() / out).string()});
    last_ = mjarm(words);
    EXPECT_EQ(last_.exit_code, 0) << last_.err;
    for (const char* file : {"log.csv", "report.json"}) {
      EXPECT_TRUE(folder_.exists(out + "/" + file)) << file;
    }
    return support::load_json(folder_.path() / out / "report.json");
  }
  /// hello.xml with a joint added to its box, as the tutorial has it.
  [[nodiscard]] std::string hello_with(const std::string& joint) const {
    std::string text = support::read_data(model_file("hello.xml"));
    const std::string geom = "<geom name=\"box\"";
    text.insert(text.find(geom), joint + "\n      ");
    return folder_.write("hello_joint.xml", text).string();
  }
  /// A column of a log, by its title.
  std::vector<double> column(const std::string& file, const std::string& title) const {
    const auto lines = support::lines_of(folder_.read(file));
    const auto titles = csv_fields(lines.front());
    const auto at = std::ranges::find(titles, title);
    EXPECT_NE(at, titles.end()) << title << " in " << lines.front();
    std::vector<double> out;
    if (at == titles.end()) return out;
    for (std::size_t i = 1; i < lines.size(); ++i) {
      out.push_back(std::stod(csv_fields(lines[i])[static_cast<std::size_t>(at - titles.begin())]));
    }
    return out;
  }
  support::TempFolder folder_;
  support::ProgramResult last_;
};

TEST_F(SimCommand, WhatHasAJointFalls) {
  const std::string file = hello_with("<freejoint/>");
  const auto report = run("out", {file, "--seconds", "1.5"});
  EXPECT_EQ(report.at("ok"), true);
  EXPECT_EQ(report.at("steps"), 750);
  const auto z = column("out/log.csv", "qpos box z [m]");
  ASSERT_EQ(z.size(), 751U);
  // Free fall of Euler's steps of 2 ms until the floor, on which it lies at half its height.
  EXPECT_NEAR(z[200], 2 - 9.81 * 4e-6 * 200 * 201 / 2, 1e-9);
  EXPECT_NEAR(z.back(), 0.5, 0.01);
  EXPECT_THAT(last_.out, AllOf(HasSubstr("box z"), HasSubstr("-> "), HasSubstr("files in")));
  EXPECT_EQ(report.at("contacts_end").at(0).at("first"), "floor");
  EXPECT_TRUE(folder_.exists("out/plot.svg"));
  EXPECT_TRUE(folder_.exists("out/plot.png"));
}

TEST_F(SimCommand, AnArmThatNothingHoldsIsTold) {
  const std::string arm = folder_
                              .write("arm.xml", R"(<mujoco><worldbody><body name="base" pos="0 0 1">
    <freejoint/><geom size=".1"/><body name="link"><joint name="j" axis="0 1 0"/>
    <geom size=".05" pos="0 0 .2"/><site name="tool0"/></body></body></worldbody></mujoco>)")
                              .string();
  run("out", {arm, "--seconds", "0.1"});
  EXPECT_THAT(last_.err, HasSubstr("the arm's base \"base\" floats"));
}

TEST_F(SimCommand, WithoutAJointItSaysWhatIsMissing) {
  run("out", {"hello", "--seconds", "0.1"});
  EXPECT_THAT(last_.err, HasSubstr("nothing in hello can move: no body has a joint"));
}

TEST_F(SimCommand, ACarDrivesByItsCommand) {
  run("ahead", {"car", "--ctrl", "forward=1", "--seconds", "1"});
  EXPECT_GT(column("ahead/log.csv", "qpos car x [m]").back(), 0.1);
  EXPECT_EQ(column("ahead/log.csv", "ctrl forward").back(), 1);
  EXPECT_EQ(column("ahead/log.csv", "ctrl turn").back(), 0);
  run("back", {"car", "--ctrl", "forward=-0.5", "--ctrl", "turn=0.1", "--seconds", "1"});
  EXPECT_LT(column("back/log.csv", "qpos car x [m]").back(), -0.05);
  EXPECT_FALSE(column("back/log.csv", "sensor left_torque").empty());
}

TEST_F(SimCommand, ArmsStandOrGoWhereTheyAreSent) {
  const auto ur5e = run("ur5e", {"ur5e", "--seconds", "0.5"});
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(ur5e.at("qpos_end").at(i), ur5e.at("qpos_start").at(i), 0.05) << i;
  }
  run("panda", {"panda", "--seconds", "0.1"});
  const auto moved =
      run("moved", {"ur5e", "--seconds", "2", "--ctrl", "-90deg,-90deg,60deg,-90deg,-90deg,0"});
  EXPECT_NEAR(moved.at("qpos_end").at(2), M_PI / 3, 0.05);
  EXPECT_NEAR(moved.at("ctrl_end").at(2), M_PI / 3, 1e-12);
  // A URDF has motors; without a command the arm hangs loose.
  const auto urdf =
      run("urdf", {model_file("universal_robots_ur5e/ur5e.urdf"), "--seconds", "0.5"});
  EXPECT_GT(
      std::abs(urdf.at("qpos_end").at(1).get<double>() - urdf.at("qpos_start").at(1).get<double>()),
      0.2);
  const support::TempFolder chinese;
  EXPECT_EQ(mjarm({"sim", write_crane(chinese), "--seconds", "0.1", "--out",
                   (chinese.path() / "出").string()})
                .exit_code,
            0);
}

TEST_F(SimCommand, ALogIsReplayedToTheLastBit) {
  const auto commands =
      folder_.write("c.csv", "time,turn,forward\r\n0,0,0.4\r\n0.25,0.2,0.4\r\n0.5,-0.2,0.1\r\n");
  run("a", {"car", "--seconds", "0.8", "--ctrl-csv", commands.string(), "--no-timing"});
  run("b", {"car", "--seconds", "0.8", "--ctrl-csv", (folder_.path() / "a/log.csv").string(),
            "--no-timing"});
  for (const char* file : {"log.csv", "report.json", "plot.svg", "plot.png"}) {
    EXPECT_EQ(folder_.read(std::string("a/") + file), folder_.read(std::string("b/") + file))
        << file;
  }
  EXPECT_EQ(column("a/log.csv", "ctrl turn")[126], 0.2);
  EXPECT_THAT(folder_.read("a/report.json"), Not(HasSubstr("rtf")));
}

TEST_F(SimCommand, FaultsAreOneLine) {
  const auto table = folder_.write("c.csv", "time,forwrd\n0,1\n").string();
  const auto good = folder_.write("g.csv", "time,forward\n0,1\n").string();
  const struct {
    std::vector<std::string> words;
    const char* says;
  } cases[] = {
      {{}, "which model"},
      {{"ellipse.yaml"}, "mjarm run"},
      {{"caar"}, "\"car\""},
      {{"car", "--seconds", "1e9"}, "--seconds: 1e+09 s is out of range"},
      {{"car", "--seconds", "0"}, "--seconds: 0 s"},
      {{"car", "--seconds", "3m"}, "--seconds"},
      {{"car", "--ctrl", "forwrd=1"}, "did you mean \"forward\"?"},
      {{"car", "--ctrl", "forward=2"}, "from -1 to 1, not 2"},
      {{"car", "--ctrl", "forward=1,2"}, "\"2\" is not NAME=VALUE"},
      {{"car", "--ctrl", "forward=1,forward=1"}, "twice"},
      {{"car", "--ctrl", "1,0,0"}, "3 values where the model has 2"},
      {{"car", "--ctrl", "forward=1", "--ctrl-csv", good}, "both command \"forward\""},
      {{"car", "--ctrl-csv", table}, "c.csv:1: there is no actuator \"forwrd\""},
      {{"ur5e", "--ctrl", "elbow=90"}, "write 90deg"},
      {{"ur5e", "--ctrl", "elbow=9mm"}, "mm"},
      {{"ur5e", "--keyframe", "hoem"}, "\"home\""},
      {{"ur5e", "--keyframe", "home", "--qpos", "0,0,0,0,0,0"}, "exclude each other"},
      {{"ur5e", "--qpos", "0,0,0"}, "--qpos: 3 values where the model has 6"},
      {{"ur5e", "--qpos", "0,-90,0,0,0,0"}, "write -90deg"},
      {{"hello", "--ctrl", "box=1"}, "no actuators"},
  };
  for (const auto& [words, says] : cases) {
    std::vector<std::string> call = {"sim"};
    call.insert(call.end(), words.begin(), words.end());
    call.insert(call.end(), {"--out", (folder_.path() / "none").string()});
    const auto result = mjarm(call);
    EXPECT_EQ(result.exit_code, 2) << says << result.err;
    EXPECT_THAT(only_line(result), HasSubstr(says));
  }
  EXPECT_FALSE(folder_.exists("none"));
}

TEST_F(SimCommand, SpeaksChinese) {
  const auto help = mjarm({"sim", "--help", "--lang", "zh-CN"});
  EXPECT_THAT(help.out, AllOf(HasSubstr("仿真任意模型"), HasSubstr("--ctrl-csv")));
  const auto fault = mjarm({"sim", "car", "--ctrl", "forwrd=1", "--lang", "zh-CN"});
  EXPECT_THAT(only_line(fault), HasSubstr("没有名为“forwrd”的执行器"));
}

TEST_F(SimCommand, CtrlCLeavesWholeFiles) {
  const std::string out = (folder_.path() / "out").string();
  const std::string script = "(while ! ls -d '" + out +
                             "' 2>/dev/null; do sleep 0.05; done; sleep 0.5; kill -INT $$) "
                             ">/dev/null & exec '" +
                             std::string(MJARM_PROGRAM) + "' sim car --ctrl forward=0.1 --out '" +
                             out + "' --seconds 3600";
  const auto result = support::run_program("/bin/bash", {"-c", script});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("stopped by the user"));
  const auto report = support::load_json(folder_.path() / "out" / "report.json");
  EXPECT_EQ(report.at("reason"), "stopped");
  EXPECT_LT(report.at("duration"), 3600);
  EXPECT_EQ(column("out/log.csv", "time [s]").back(), report.at("duration"));
}

TEST_F(SimCommand, RenderShowsTheSameMotion) {
  const std::string file = hello_with("<freejoint name=\"fall\"/>");
  const auto picture = [&](const std::string& name, std::vector<std::string> more) {
    const std::string out = (folder_.path() / name).string();
    more.insert(more.begin(),
                {"render", file, "--out", out, "--size", "64x36", "--quality", "low"});
    const auto result = mjarm(more);
    if (result.exit_code == 1) return std::string();  // no OpenGL
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return folder_.read(name);
  };
  const std::string start = picture("start.png", {});
  if (start.empty()) GTEST_SKIP() << "no OpenGL on this machine";
  EXPECT_NE(picture("end.png", {"--seconds", "1"}), start);
  EXPECT_EQ(picture("low.png", {"--qpos", "2,0,2,1,0,0,0"}), start) << "where it stands anyway";
  EXPECT_NE(picture("up.png", {"--qpos", "2,0,3,1,0,0,0"}), start);
  if (find_program("ffmpeg").empty()) return;
  // A film of what falls has frames that differ; one that turns round what stands as well.
  const auto film = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"--seconds", "0.6", "--fps", "10"};
    words.insert(words.end(), more.begin(), more.end());
    return picture(name, words).size();
  };
  const std::size_t falls = film("falls.gif", {});
  const std::size_t turns = film("turns.gif", {"--turn"});
  EXPECT_GT(falls, 0U);
  EXPECT_GT(turns, 0U);
  EXPECT_NE(folder_.read("falls.gif"), folder_.read("turns.gif"));
  const auto sim = run("out", {file, "--seconds", "0.2", "--video"});
  EXPECT_TRUE(folder_.exists("out/video.mp4"));
}

}  // namespace
}  // namespace mjarm::app
