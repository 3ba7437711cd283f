// An arm that is sunk in what it stands on is planned for, verified, moved and checked without a
// word of the user; what blocks it all the same is told, and what could be carried away with it.
#include <gmock/gmock.h>

#include <string>

#include "apps/mjarm/commands/crane_test.hpp"
#include "apps/mjarm/commands/program_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// The crane on a block that its hub is sunk in. The lift meets the block where the crane is
/// folded.
std::string sunk_crane() {
  std::string xml = kCrane;
  xml.insert(xml.find("<body name=\"post\""),
             R"(<geom name="block" type="box" size="0.2 0.2 0.15" pos="0 0 0.15"/>)");
  xml.insert(xml.find("<geom name=\"post\""),
             R"(<geom name="hub" type="capsule" fromto="0 0 -0.1 0 0 0" size="0.04" mass="1"/>)");
  return xml;
}

/// A cup that the tool touches at home.
std::string with_cup(std::string xml) {
  xml.insert(xml.find("</worldbody>"), R"(<body name="cup" pos="0.3669 0.3498 0.27"><freejoint/>
    <geom name="cup_side" type="sphere" size="0.03" mass="0.1"/></body>)");
  const std::string home = "qpos=\"0.4 0.8 0";
  xml.insert(xml.find(home) + home.size(), " 0.3669 0.3498 0.27 1 0 0 0");
  return xml;
}

class OverlapByDesign : public ::testing::Test {
 protected:
  support::ProgramResult run(std::vector<std::string> words, const std::string& xml) {
    words.insert(words.end(), {"--robot", folder_.write("crane.xml", xml).string()});
    return mjarm(words, {.folder = folder_.path(), .input = {}, .environment = {}});
  }
  support::ProgramResult plan(const std::string& goal, const std::string& xml,
                              const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"plan", "--goal", goal, "--out", "path.json"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words, xml);
  }

  support::TempFolder folder_;
};

TEST_F(OverlapByDesign, IsNoContactToPlanAndVerify) {
  const auto planned = plan("-1.5,-1.2,-100mm", sunk_crane());
  ASSERT_EQ(planned.exit_code, 0) << planned.err;
  EXPECT_EQ(planned.err, "");
  const auto verified = run({"verify", "path.json", "--json"}, sunk_crane());
  EXPECT_EQ(verified.exit_code, 0) << verified.err;
  EXPECT_EQ(json::parse(verified.out).at("valid"), 1);
}

TEST_F(OverlapByDesign, WhatMeetsInSomePosturesOnlyStillCounts) {
  const auto folded = plan("0,2.2,-200mm", sunk_crane());
  EXPECT_EQ(folded.exit_code, 1);
  EXPECT_THAT(folded.err, AllOf(HasSubstr("link \"lift\""), HasSubstr("obstacle \"block\"")));
}

TEST_F(OverlapByDesign, IsNoContactToAMotion) {
  const auto drawn = run({"demo", "square", "--headless", "--out", "out"}, sunk_crane());
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_THAT(drawn.err, Not(HasSubstr("block")));
}

TEST_F(OverlapByDesign, IsToldByTheCheckOfTheModel) {
  folder_.write("crane.xml", sunk_crane());
  const auto checked = mjarm({"model", "check", "crane.xml", "--json"},
                             {.folder = folder_.path(), .input = {}, .environment = {}});
  EXPECT_THAT(checked.out, AllOf(HasSubstr("\"overlap_by_design\""), HasSubstr("\\\"block\\\""),
                                 Not(HasSubstr("home_contact"))));
}

TEST_F(OverlapByDesign, ATouchedThingThatIsMovableIsToldApart) {
  const std::string goal = "-1.5,-1.2,0";
  const std::string xml = with_cup(kCrane);
  const auto stuck = plan(goal, xml);
  EXPECT_EQ(stuck.exit_code, 1);
  const auto says = AllOf(HasSubstr("\"cup\" is movable"), HasSubstr("--hold cup"),
                          HasSubstr("--allow lift,cup"));
  EXPECT_THAT(stuck.err, says);
  EXPECT_THAT(json::parse(folder_.read("path.json")).front().at("reason").get<std::string>(), says);
  // Both repairs do what is said.
  EXPECT_EQ(plan(goal, xml, {"--hold", "cup"}).exit_code, 0);
  EXPECT_EQ(plan(goal, xml, {"--allow", "lift,cup"}).exit_code, 0);
  // What stands is not movable.
  std::string fixed = xml;
  fixed.replace(fixed.find("<freejoint/>"), 12, "");
  fixed.replace(fixed.find(" 0.3669 0.3498 0.27 1 0 0 0"), 27, "");
  const auto blocked = plan(goal, fixed);
  EXPECT_EQ(blocked.exit_code, 1);
  EXPECT_THAT(blocked.err, AllOf(HasSubstr("cup_side"), Not(HasSubstr("movable"))));
}

}  // namespace
}  // namespace mjarm::app
