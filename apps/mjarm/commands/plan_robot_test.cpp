#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "apps/mjarm/commands/program_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

constexpr const char* kWalled = "universal_robots_ur5e/wall.xml";
// Before and behind the wall, the tool pointing down.
constexpr const char* kBefore = "-4.375,-1.2456,1.9905,-2.3157,-1.5708,0";
constexpr const char* kBehind = "-5.551,-1.2456,1.9905,-2.3157,-1.5708,0";
constexpr const char* kPlaceBehind = "-0.3,-0.45,0.2";

class PlanRobot : public ::testing::Test {
 protected:
  using Words = std::vector<std::string>;

  std::string paths() const { return (folder_.path() / "path.json").string(); }
  support::ProgramResult plan(const Words& more, const char* robot = kWalled) {
    Words words{"plan", "--robot", robot, "--out", paths()};
    words.insert(words.end(), more.begin(), more.end());
    return mjarm(words);
  }
  json answer() const { return json::parse(folder_.read("path.json")).front(); }
  support::ProgramResult verify(const char* robot = kWalled) {
    return mjarm({"verify", paths(), "--robot", robot, "--json"});
  }

  support::TempFolder folder_;
};

TEST_F(PlanRobot, GoesRoundTheWallAndIsVerifiedWithExactGeometry) {
  const auto planned = plan({"--start", kBefore, "--goal", kBehind});
  ASSERT_EQ(planned.exit_code, 0) << planned.err;
  const json path = answer();
  EXPECT_GT(path.at("path").size(), 2u);
  EXPECT_FALSE(path.contains("tilt"));
  const auto verified = verify();
  EXPECT_EQ(verified.exit_code, 0) << verified.err;
  EXPECT_EQ(json::parse(verified.out).at("valid"), 1);
}

TEST_F(PlanRobot, AStraightWayThroughTheWallIsNotVerified) {
  folder_.write("path.json", std::string("{\"straight\":[[") + kBefore + "],[" + kBehind + "]]}");
  const auto verified = verify();
  EXPECT_EQ(verified.exit_code, 1);
  const json faults = json::parse(verified.out).at("paths").at("straight").at("faults");
  std::vector<std::string> kinds;
  for (const json& fault : faults) kinds.push_back(fault.at("kind"));
  EXPECT_EQ(kinds, (std::vector<std::string>{"hit", "contact"}));
  EXPECT_NE(faults[1].at("what").get<std::string>().find("\"wall\""), std::string::npos);
}

TEST_F(PlanRobot, KeepsTheClearanceThatIsAskedAndSaysWhatIsPossible) {
  const Words way{"--start", kBefore, "--goal", kBehind};
  const auto with = [&](const char* clearance) {
    Words words = way;
    words.insert(words.end(), {"--clearance", clearance});
    return words;
  };
  ASSERT_EQ(plan(way).exit_code, 0);
  EXPECT_EQ(answer().at("clearance"), 0.005) << "preferred where nothing is asked";
  ASSERT_EQ(plan(with("30mm")).exit_code, 0);
  const json clear = answer();
  EXPECT_EQ(clear.at("clearance"), 0.03);
  for (const json& edge : clear.at("certificate")) {
    EXPECT_EQ(edge.at("kept"), 0.03);
    EXPECT_GE(edge.at("clearance").get<double>(), 0.03 - 1e-6);
  }
  EXPECT_EQ(verify().exit_code, 0);
  // More than is true is found out.
  json file = json::parse(folder_.read("path.json"));
  for (json& edge : file.front()["certificate"]) edge["kept"] = 0.3;
  folder_.write("path.json", file.dump());
  const auto wrong = verify();
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_NE(wrong.err.find("stated to keep 0.3 m"), std::string::npos) << wrong.err;
  // What no path keeps.
  const auto none = plan(with("350mm"));
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(only_line(none).find("no path keeps a clearance of 350 mm"), std::string::npos);
  const double possible = answer().at("possible_clearance");
  EXPECT_GT(possible, 0.03);
  EXPECT_LT(possible, 0.35);
  ASSERT_EQ(plan(with("0")).exit_code, 0);
  EXPECT_FALSE(answer().contains("clearance"));
  const auto unknown = plan(with("600mm"));
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(only_line(unknown).find("--clearance"), std::string::npos);
}

TEST_F(PlanRobot, KeepsTheToolUprightAndSaysByHowMuch) {
  const Words way{"--start", kBefore, "--goal", kBehind, "--keep-upright"};
  Words words = way;
  words.push_back("5deg");
  ASSERT_EQ(plan(words).exit_code, 0);
  const json path = answer();
  const double five = 5 * std::numbers::pi / 180;
  EXPECT_NEAR(path.at("tilt").at("limit"), five, 1e-12);
  EXPECT_LE(path.at("tilt").at("largest"), five);
  EXPECT_EQ(verify().exit_code, 0);
  // A smaller one than is true is found out.
  const json sound = json::parse(folder_.read("path.json"));
  json file = sound;
  file.front()["tilt"]["largest"] = 1e-4;
  file.front().erase("certificate");
  folder_.write("path.json", file.dump());
  const auto verified = verify();
  EXPECT_EQ(verified.exit_code, 1);
  EXPECT_NE(verified.err.find("leans"), std::string::npos) << verified.err;
  // What cannot be is no input.
  const std::pair<const char*, json> wrong[] = {
      {"/tilt/tool", {0, 0, 0}}, {"/tilt/world", {0, 0, 2}}, {"/tilt/largest", 0.2},
      {"/tilt/limit", 2},        {"/tilt/limit", nullptr},   {"/hold", "rod"},
      {"/allow", {1, 2}}};
  for (const auto& [place, value] : wrong) {
    file = sound;
    file.front()[json::json_pointer(place)] = value;
    folder_.write("path.json", file.dump());
    const auto refused = verify();
    EXPECT_EQ(refused.exit_code, 2) << place;
    EXPECT_NE(only_line(refused).find("path.json"), std::string::npos) << place;
  }
}

TEST_F(PlanRobot, ARegionIsReachedWhereThePoseIsNot) {
  const Words far{"--pos", "-0.95,-0.3,0.2", "--euler", "180deg,0,0"};
  const auto none = plan(far);
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(only_line(none).find("out of reach"), std::string::npos);
  EXPECT_EQ(answer().at("ok"), false);
  Words near = far;
  near.insert(near.end(), {"--within", "400mm,0,0", "--turn", "180deg"});
  ASSERT_EQ(plan(near).exit_code, 0);
  EXPECT_EQ(verify().exit_code, 0);
}

TEST_F(PlanRobot, RegionsInWordsAreGoalsStartsAndWhatIsKept) {
  // A grasp of an upright thing behind the wall from any side, or what is out of reach.
  const std::string far = "pos=0,0,3", side =
                                           "frame=wall pos=-0.25,0.05,0 tool-pos=-0.1,0,0 "
                                           "tool-euler=0,90deg,0 yaw=free z=3cm";
  ASSERT_EQ(plan({"--start", kBefore, "--goal-region", far, "--goal-region", side}).exit_code, 0);
  EXPECT_EQ(answer().at("goal_region"), 1);
  EXPECT_FALSE(answer().contains("start_region"));
  EXPECT_EQ(verify().exit_code, 0);
  ASSERT_EQ(plan({"--start-region", side, "--goal", kBefore}).exit_code, 0);
  EXPECT_EQ(answer().at("start_region"), 0);
  // A line of the tool, which the file tells and a proof keeps.
  ASSERT_EQ(plan({"--start", kBefore, "--goal-region", "frame=start x=-15cm..-10cm",
                  "--keep-within", "frame=start y=1cm z=-1cm..2cm lean=3deg"})
                .exit_code,
            0);
  const json kept = answer().at("within");
  EXPECT_EQ(kept.at("min")[0], nullptr);
  EXPECT_EQ(kept.at("min")[1], -0.01);
  EXPECT_EQ(kept.at("max")[2], 0.02);
  EXPECT_GE(kept.at("room").at("place"), -1e-9);
  EXPECT_EQ(verify().exit_code, 0);
  json file = json::parse(folder_.read("path.json"));
  file.front()["within"]["max"][1] = 1e-4;
  file.front()["within"]["min"][1] = -1e-4;
  folder_.write("path.json", file.dump());
  const auto wrong = verify();
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_NE(wrong.err.find("within the region"), std::string::npos) << wrong.err;
}

TEST_F(PlanRobot, ADoorIsOpenedByAHandThatTurnsInItsHandle) {
  const std::string door =
      "pos=10cm,-72cm,30cm tool-euler=90deg,0,0 hinge-pos=40cm,-95cm,0 axis=0,0,2 ";
  const std::string kept = "hinge=-80deg..2deg x=1cm y=1cm z=1cm roll=3deg pitch=3deg ";
  const Words words{"--start",       "-68.5deg,-124.2deg,-72.8deg,-163deg,-68.5deg,0",
                    "--goal-region", door + "hinge=-77deg..-75deg yaw=50deg",
                    "--keep-within", door + kept + "yaw=50deg"};
  const auto opened = plan(words);
  ASSERT_EQ(opened.exit_code, 0) << opened.err;
  const json mechanism = answer().at("within").at("mechanism");
  EXPECT_EQ(mechanism.at("type"), "hinge");
  EXPECT_EQ(mechanism.at("axis"), json({0, 0, 1}));
  EXPECT_NEAR(mechanism.at("pos")[1], -0.95, 1e-12);
  EXPECT_NEAR(mechanism.at("min"), -80 * std::numbers::pi / 180, 1e-12);
  EXPECT_EQ(verify().exit_code, 0);
  json file = json::parse(folder_.read("path.json"));
  file.front()["within"]["mechanism"]["min"] = -1;
  folder_.write("path.json", file.dump());
  const auto stops = verify();
  EXPECT_EQ(stops.exit_code, 1);
  EXPECT_NE(stops.err.find("within the region"), std::string::npos) << stops.err;
  file.front()["within"]["mechanism"]["type"] = "hinges";
  folder_.write("path.json", file.dump());
  const auto wrong = verify();
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("\"mechanism\" must have"), std::string::npos) << wrong.err;
  // What holds fast cannot.
  Words fast = words;
  fast[3] = door + "hinge=-77deg..-75deg yaw=3deg";
  fast[5] = door + kept + "yaw=3deg";
  EXPECT_EQ(plan(fast).exit_code, 1);
}

TEST_F(PlanRobot, TheAnswerAndTheLineTellTheSamePostureThatCanBeReached) {
  // The upper arm would have to pass through the floor.
  const auto none = plan({"--start", "-1.5708,-1.5708,1.5708,-1.5708,-1.5708,0", "--goal",
                          "-1.5708,5.0832,1.5708,-1.5708,-1.5708,0", "--samples", "2000"},
                         "ur5e");
  EXPECT_EQ(none.exit_code, 1);
  const std::string reason = answer().at("reason");
  EXPECT_NE(reason.find("same posture"), std::string::npos) << reason;
  EXPECT_NE(only_line(none).find(reason), std::string::npos);
  EXPECT_NEAR(answer().at("same_posture").at(1), 5.0832 - 2 * std::numbers::pi, 1e-9);
}

TEST_F(PlanRobot, SevenAxesAndAToolWhoseTurnIsFree) {
  ASSERT_EQ(plan({"--pos", "0.4,-0.3,0.4", "--task", "position"}, "panda").exit_code, 0);
  EXPECT_EQ(verify("panda").exit_code, 0);
  ASSERT_EQ(
      plan({"--pos", "0.4,-0.3,0.4", "--euler", "180deg,0,0", "--task", "axis"}, "panda").exit_code,
      0);
  EXPECT_EQ(verify("panda").exit_code, 0);
}

TEST_F(PlanRobot, SaysWhatIsHitAtTheGoal) {
  const auto result = plan({"--pos", "0,-0.45,0.2", "--euler", "180deg,0,0"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(only_line(result).find("every goal is in collision"), std::string::npos);
}

TEST_F(PlanRobot, SameBytesEveryTime) {
  const Words words{"--pos", kPlaceBehind,  "--euler", "180deg,0,0", "--keep-upright",
                    "10deg", "--no-timing", "--start", kBefore};
  ASSERT_EQ(plan(words).exit_code, 0);
  const std::string first = folder_.read("path.json");
  ASSERT_EQ(plan(words).exit_code, 0);
  EXPECT_EQ(folder_.read("path.json"), first);
}

/// The walled UR5e with a rod that stands where the tool begins.
std::string with_rod(const support::TempFolder& folder) {
  const std::string file = model_file("universal_robots_ur5e/wall.xml");
  return folder
      .write("rod.xml", "<mujoco><include file=\"" + file + R"("/><worldbody>
        <body name="rod" pos="0.3 -0.45 0.06"><freejoint/>
          <geom name="rod" type="capsule" size="0.01 0.04"/></body>
        </worldbody></mujoco>)")
      .string();
}

TEST_F(PlanRobot, CarriesWhatItHoldsOverTheWall) {
  const std::string robot = with_rod(folder_);
  Words words{"--start", kBefore, "--goal", kBehind, "--allow-outside"};
  ASSERT_EQ(plan(words, robot.c_str()).exit_code, 0);
  const std::string bare = folder_.read("path.json");
  words.insert(words.end(), {"--hold", "rod"});
  ASSERT_EQ(plan(words, robot.c_str()).exit_code, 0);
  EXPECT_NE(folder_.read("path.json"), bare);
  // The file says what was held.
  EXPECT_EQ(answer().at("hold"), json({"rod"}));
  const auto held = mjarm({"verify", "--robot", robot, "--allow-outside", paths()});
  EXPECT_EQ(held.exit_code, 0) << held.err;
  json forgotten = json::parse(folder_.read("path.json"));
  forgotten.front().erase("hold");
  folder_.write("path.json", forgotten.dump());
  EXPECT_EQ(mjarm({"verify", "--robot", robot, "--allow-outside", paths()}).exit_code, 1);
  const auto told =
      mjarm({"verify", "--robot", robot, "--allow-outside", "--hold", "rod", paths()});
  EXPECT_EQ(told.exit_code, 0) << told.err;

  words.back() = "rood";
  const auto wrong = plan(words, robot.c_str());
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(only_line(wrong).find("--hold: there is no body \"rood\""), std::string::npos);
  words[words.size() - 2] = "--allow";
  const auto lone = plan(words, robot.c_str());
  EXPECT_EQ(lone.exit_code, 2);
  EXPECT_NE(only_line(lone).find("--allow"), std::string::npos);
}

TEST_F(PlanRobot, WrongWordsGetOneLine) {
  const std::pair<Words, const char*> wrong[] = {
      {{}, "exactly one of --goal, --pos and --goal-region"},
      {{"--goal", "1,2"}, "--goal: 6 values"},
      {{"--goal", "0,0,0,0,0,0", "--within", "1,1,1"}, "--goal and --within exclude"},
      {{"--pos", "1,2,3"}, "--euler and --quat"},
      {{"--pos", "1,2,3", "--task", "pos"}, "--task"},
      {{"--pos", "1,2,3", "--task", "position", "--within", "0,0,-1"}, "--within"},
      {{"--pos", "1,2,3", "--task", "position", "--lean", "181deg"}, "--lean"},
      {{"--goal", "0,0,0,0,0,0", "--keep-upright", "90deg"}, "--keep-upright"},
      {{"--goal", "0,0,0,0,0,0", "--keep-upright", "0"}, "--keep-upright"},
      {{"--goal", "0,0,0,0,0,nan"}, "--goal"},
      {{"--goal", "0,0,0,0,0,0", "--problem", "x"}, "--robot and --problem"},
      {{"--goal", "0,0,0,0,0,0", "--hold", "wall"}, "--hold: the body \"wall\" has no free joint"},
      {{"--goal", "0,0,0,0,0,0", "--allow", "wall"}, "--allow"},
      {{"--goal", "0,0,0,0,0,0", "--allow", "wall,flor"}, "\"floor\""},
      {{"--pos", "1,2,3", "--task", "position", "--keep-upright", "5deg"}, "--task axis"},
      {{"--goal-region", "z=1cm yaww=free"},
       "--goal-region: there is no \"yaww\" (did you mean \"yaw\"?)"},
      {{"--goal-region", "z=1cm z=2cm"}, "\"z\" needs one value"},
      {{"--goal-region", "frame=wal"}, "(did you mean \"wall\"?)"},
      {{"--goal-region", "x=3..1"}, "bounds go from least to largest"},
      {{"--goal-region", "x=5mn"}, "--goal-region: x: "},
      {{"--goal-region", "hing=70deg"}, "(did you mean \"hinge\"?)"},
      {{"--goal-region", "hinge=70deg slide=1cm"}, "hinge and slide exclude"},
      {{"--goal-region", "slide=1cm hinge-pos=0,0,0"}, "\"hinge-pos\" needs one of these"},
      {{"--goal-region", "axis=0,0,1"}, "\"axis\" needs one of these beside it: hinge, slide"},
      {{"--goal-region", "hinge=70deg axis=0,0,0"}, "axis is a direction"},
      {{"--goal-region", "hinge=70deg axis=0,0"}, "--goal-region: axis: "},
      {{"--goal-region", "hinge=50deg..40deg"}, "hinge and slide go from least to largest"},
      {{"--goal-region", "slide=0..free"}, "--goal-region: slide: "},
      {{"--goal-region", "slide=0.."}, "hinge and slide go from least to largest"},
      {{"--goal-region", "z=0", "--lean", "5deg"}, "--goal-region and --lean exclude"},
      {{"--start-region", "z=0", "--hold", "wall", "--pos", "1,2,3"}, "--start-region and --hold"},
      {{"--start-region", "frame=start"}, "frame=start needs one start"},
      {{"--goal", "0,0,0,0,0,0", "--keep-within", "z=0"},
       "--keep-within: what the tool shall keep"},
      {{"--goal", "0,0,0,0,0,0", "--in", "x.json"}, "--in and --robot"},
      {{"--goal", "0,0,0,0,0,0", "--threads", "2"}, "--robot and --threads exclude"},
      {{"--goal", kBehind, "--picture", "p.png", "--camera", "nose"}, "no camera \"nose\""}};
  for (const auto& [words, says] : wrong) {
    const auto result = plan(words);
    EXPECT_EQ(result.exit_code, 2) << says;
    EXPECT_NE(only_line(result).find(says), std::string::npos) << result.err;
  }
  const auto both = mjarm({"verify", paths(), "--robot", "ur5e", "--in", "x.json"});
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_NE(only_line(both).find("--in and --robot"), std::string::npos);
  // Nothing that was asked for is left out without a word.
  for (const Words& more :
       {Words{"--hold", "cup"}, Words{"--allow", "a,b"}, Words{"--within", "1,1,1"}}) {
    Words words{"plan", "--in", "x.json"};
    words.insert(words.end(), more.begin(), more.end());
    const auto result = mjarm(words);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(only_line(result).find("--in and --robot"), std::string::npos) << result.err;
  }
  const auto held = mjarm({"verify", "x.json", "--in", "y.json", "--hold", "cup"});
  EXPECT_EQ(held.exit_code, 2);
  EXPECT_NE(only_line(held).find("--in and --hold"), std::string::npos);
}

}  // namespace
}  // namespace mjarm::app
