#include "mjarm/serve/page_messages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/model/shipped_test.hpp"

namespace mjarm::serve {
namespace {

using ::testing::HasSubstr;
using view::PanelItem;

/// A UR5e of which everything may be done, with a panel of one item of each kind.
class FromPage : public ::testing::Test {
 protected:
  FromPage() {
    for (const ArmJoint& joint : robot_.arm.joints) facts_.jog_dofs.push_back(joint.dof);
    panels_ = {{"Items",
                {{1, "button", view::PanelButton{}},
                 {2, "box", view::PanelCheckbox{}},
                 {3, "slider", view::PanelSlider{0, -1, 2}},
                 {4, "text", view::PanelText{"said"}},
                 {5, "choice", view::PanelChoice{{"a", "b", "c"}, 0}},
                 {6, "list", view::PanelList{{"x", "y"}, 0}},
                 {7, "time", view::PanelTimeline{0, 9}},
                 {8, "grey", view::PanelButton{}, false}}}};
  }
  Result<PageMessage> read(const std::string& text) {
    return read_page_message(text, {drawn_, facts_, poses_, panels_});
  }
  /// The event of a text that is understood.
  template <class Event>
  Event event(const std::string& text) {
    const Result<PageMessage> message = read(text);
    EXPECT_TRUE(message) << text << ": " << (message ? "" : message.error().what);
    if (!message) return {};
    const auto* any = std::get_if<view::ViewEvent>(&*message);
    EXPECT_TRUE(any != nullptr && std::holds_alternative<Event>(*any)) << text;
    return any == nullptr ? Event{} : std::get<Event>(*any);
  }
  void refused(const std::string& text, const std::string& part) {
    const Result<PageMessage> message = read(text);
    ASSERT_FALSE(message) << text;
    EXPECT_EQ(message.error().code, Errc::bad_input);
    EXPECT_THAT(message.error().what, HasSubstr(part)) << text;
  }

  mjarm::testing::TestArm robot_ = mjarm::testing::shipped_arm("ur5e");
  DrawnModel drawn_ = drawn_model(robot_.model);
  SceneFacts facts_{.can_target = true};
  BodyPoses poses_{robot_.model};
  std::vector<view::PanelSection> panels_;
};

TEST_F(FromPage, SimpleEventsAreRead) {
  EXPECT_TRUE(event<view::PauseEvent>(R"({"type":"pause","paused":true})").paused);
  EXPECT_EQ(event<view::StepEvent>(R"({"type":"step","steps":-3})").steps, -3);
  EXPECT_EQ(event<view::StepEvent>(R"({"steps":1.0,"type":"step"})").steps, 1);
  EXPECT_EQ(event<view::SpeedEvent>(R"({"type":"speed","speed":0.25})").speed, 0.25);
  (void)event<view::ResetEvent>(R"({"type":"reset"})");
  (void)event<view::TargetEvent>(R"({"type":"target"})");
  EXPECT_EQ(event<view::ReleaseEvent>(R"({"type":"release","body":2})").body, 2);
}

TEST_F(FromPage, ASliderIsTheJointOfThatName) {
  const ArmJoint& joint = robot_.arm.joints[2];
  const auto moved = event<view::JointEvent>(R"({"type":"joint","dof":)" +
                                             std::to_string(joint.dof) + R"(,"value":0.5})");
  EXPECT_EQ(moved.dof, joint.dof);
  EXPECT_EQ(moved.joint, joint.name);
  EXPECT_EQ(moved.value, 0.5);
  refused(R"({"type":"joint","dof":99,"value":0})", "99");
  refused(R"({"type":"joint","dof":-1,"value":0})", "dof");
  refused(R"({"type":"joint","dof":1.5,"value":0})", "whole");
}

TEST_F(FromPage, APushTurnsTheBodyAboutItsCentreOfMass) {
  int body = 0;
  while (!drawn_.bodies[static_cast<std::size_t>(body)].moves) ++body;
  const Eigen::Vector3d p_WC =
      poses_.pose(body) * drawn_.bodies[static_cast<std::size_t>(body)].p_BC;
  const auto number = [](double value) { return std::to_string(value); };
  const std::string text = R"({"type":"push","body":)" + std::to_string(body) + R"(,"point":[)" +
                           number(p_WC.x() + 0.5) + "," + number(p_WC.y()) + "," +
                           number(p_WC.z()) + R"(],"force":[0,0,10]})";
  const auto push = event<view::PushEvent>(text);
  EXPECT_EQ(push.body, body);
  EXPECT_EQ(push.force_W, Eigen::Vector3d(0, 0, 10));
  // Half a metre along x, up: about -y.
  EXPECT_NEAR((push.torque_W - Eigen::Vector3d(0, -5, 0)).norm(), 0, 1e-4);
  refused(R"({"type":"push","body":0,"point":[0,0,0],"force":[0,0,1]})", "body");
  refused(R"({"type":"push","body":1,"point":[0,0],"force":[0,0,1]})", "point");
  facts_.can_push = false;
  refused(text, "push");
}

TEST_F(FromPage, ADragIsAPoseWithAUnitQuaternion) {
  const auto message = read(
      R"({"type":"drag","pos":[0.1,0.2,0.3],"quat":[0.7071,0,0,0.7071],"held":true,"number":7})");
  ASSERT_TRUE(message) << message.error().what;
  const auto& drag = std::get<view::TargetDrag>(*message);
  EXPECT_EQ(drag.X_WT.p, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_NEAR((drag.X_WT.R.transpose() * drag.X_WT.R - Eigen::Matrix3d::Identity()).norm(), 0,
              1e-12);
  EXPECT_TRUE(drag.held);
  EXPECT_EQ(drag.number, 7);
  const std::string rest = R"(,"held":true,"number":7})";
  refused(R"({"type":"drag","pos":[0,0,0],"quat":[0,0,0,0])" + rest, "quaternion");
  refused(R"({"type":"drag","pos":[0,0,0],"quat":[2,0,0,0])" + rest, "quaternion");
  refused(R"({"type":"drag","pos":[0,0,0],"quat":[1,0,0])" + rest, "quat");
  refused(R"({"type":"drag","pos":[0,0,1e9],"quat":[1,0,0,0])" + rest, "pos");
  refused(R"({"type":"drag","pos":[0,0,0],"quat":[1,0,0,0],"held":1,"number":7})", "held");
  refused(R"({"type":"drag","pos":[0,0,0],"quat":[1,0,0,0],"held":true,"number":-1})", "number");
  facts_.can_target = false;
  refused(R"({"type":"drag","pos":[0,0,0],"quat":[1,0,0,0])" + rest, "drag");
}

TEST_F(FromPage, ALeadIsClampedAndOnlyWhereItIsFollowed) {
  const std::string lead = R"({"type":"lead","linear":[0.5,-2,0],"angular":[0,0,1],"grip":-1})";
  refused(lead, "lead");
  facts_.can_lead = true;
  const auto read = event<view::LeadEvent>(lead);
  EXPECT_EQ(read.linear, Eigen::Vector3d(0.5, -1, 0));
  EXPECT_EQ(read.angular, Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(read.grip, -1);
  refused(R"({"type":"lead","linear":[0,0],"angular":[0,0,0],"grip":0})", "linear");
  refused(R"({"type":"lead","linear":[0,0,0],"angular":[0,0,0],"grip":2})", "grip");
  refused(R"({"type":"lead","linear":[0,0,0],"angular":[0,0,0]})", "grip");
}

TEST_F(FromPage, ASelectionHasNamesAndNumbersOfTheModel) {
  const DrawnGeom& geom = drawn_.geoms.back();
  const auto chosen = event<view::SelectEvent>(
      R"({"type":"select","body":)" + std::to_string(geom.body) + R"(,"geom":)" +
      std::to_string(drawn_.geoms.size() - 1) + R"(,"point":[1,2,3]})");
  EXPECT_EQ(chosen.geom, geom.id);
  EXPECT_EQ(chosen.body_name, drawn_.bodies[static_cast<std::size_t>(geom.body)].name);
  EXPECT_EQ(
      event<view::SelectEvent>(R"({"type":"select","body":-1,"geom":-1,"point":[0,0,0]})").body,
      -1);
  refused(R"({"type":"select","body":0,"geom":)" + std::to_string(drawn_.geoms.size()) +
              R"(,"point":[0,0,0]})",
          "geom");
  refused(R"({"type":"select","body":999,"geom":-1,"point":[0,0,0]})", "body");
}

TEST_F(FromPage, ValuesOfPanelsAreWithinTheirItem) {
  const auto used = [this](int id, const std::string& value) {
    return event<view::PanelEvent>(R"({"type":"panel","id":)" + std::to_string(id) +
                                   R"(,"value":)" + value + "}")
        .value;
  };
  const auto wrong = [this](int id, const std::string& value) {
    refused(R"({"type":"panel","id":)" + std::to_string(id) + R"(,"value":)" + value + "}", "");
  };
  EXPECT_EQ(used(1, "1"), 1);
  EXPECT_EQ(used(2, "0"), 0);
  EXPECT_EQ(used(3, "1.5"), 1.5);
  EXPECT_EQ(used(3, "17"), 2);  // moved beyond its end
  EXPECT_EQ(used(5, "2"), 2);
  EXPECT_EQ(used(6, "1"), 1);
  EXPECT_EQ(used(7, "1e3"), 9);
  wrong(1, "2");
  wrong(2, "0.5");
  wrong(4, "1");
  wrong(5, "3");
  wrong(5, "-1");
  wrong(5, "1e300");
  wrong(6, "2");
  wrong(77, "1");
  // One that was enabled a moment ago is no fault of the page.
  const Result<PageMessage> grey = read(R"({"type":"panel","id":8,"value":1})");
  ASSERT_TRUE(grey);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(*grey));
}

TEST_F(FromPage, WhatIsNoMessageIsRefused) {
  refused("", "");
  refused("null", "");
  refused("[]", "");
  refused("{", "");
  refused("{}", "type");
  refused(R"({"type":1})", "type");
  refused(R"({"type":"shoot"})", "shoot");
  refused(R"({"type":"pause"})", "paused");
  refused(R"({"type":"pause","paused":"yes"})", "paused");
  refused(R"({"type":"pause","paused":true,"now":1})", "now");
  refused(R"({"type":"reset","type":"pause"})", "type");
  refused(R"({"type":"reset","x":[[[[[[]]]]]]})", "");
  refused(R"({"type":"speed","speed":NaN})", "");
  refused(R"({"type":"speed","speed":1e999})", "");
  refused(R"({"type":"speed","speed":0})", "speed");
  refused(R"({"type":"speed","speed":-1})", "speed");
  refused(R"({"type":"speed","speed":101})", "speed");
  refused(R"({"type":"speed","speed":null})", "speed");
  refused(R"({"type":"step","steps":2.5})", "whole");
  refused(R"({"type":"step","steps":2147483648})", "steps");
  refused(R"({"type":"release","body":1000})", "body");
  refused(R"({"type":"select","body":1,"geom":0,"point":[0,0,"a"]})", "point");
  refused(R"({"type":"select","body":1,"geom":0,"point":[0,0,1e7]})", "point");
  refused(R"({"type":")" + std::string(70'000, 'a') + R"("})", "");
  facts_.can_step = facts_.can_reset = false;
  refused(R"({"type":"step","steps":1})", "step");
  refused(R"({"type":"reset"})", "reset");
}

TEST_F(FromPage, ChangedTextsNeverDoHarm) {
  const std::string texts[] = {
      R"({"type":"push","body":3,"point":[0.1,0.2,0.3],"force":[1,2,3]})",
      R"({"type":"drag","pos":[0.1,0.2,0.3],"quat":[1,0,0,0],"held":true,"number":12})",
      R"({"type":"select","body":3,"geom":4,"point":[0.1,0.2,0.3]})",
      R"({"type":"panel","id":5,"value":2})",
      R"({"type":"joint","dof":2,"value":-0.25})",
  };
  const std::string pieces[] = {"1e308", "-",       "[",    "]", "{", "}",    "\"", ":",
                                ",",     "\\u0000", "null", "9", ".", "\xff", "e",  "true"};
  Rng rng(3);
  int understood = 0;
  for (int i = 0; i < 10'000; ++i) {
    std::string text = texts[rng.below(std::size(texts))];
    for (std::uint64_t n = rng.below(3); n < 3; ++n) {
      const std::size_t at = rng.below(text.size());
      text.replace(at, rng.below(3), pieces[rng.below(std::size(pieces))]);
    }
    const Result<PageMessage> message = read(text);
    if (!message) continue;
    ++understood;
    if (const auto* drag = std::get_if<view::TargetDrag>(&*message)) {
      EXPECT_TRUE(drag->X_WT.p.allFinite()) << text;
      EXPECT_LE(drag->X_WT.p.cwiseAbs().maxCoeff(), kMaxPageNumber) << text;
    }
  }
  EXPECT_LT(understood, 5'000);
}

}  // namespace
}  // namespace mjarm::serve
