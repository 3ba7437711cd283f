#include "mjarm/serve/live_messages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "mjarm/core/json.hpp"
#include "mjarm/model/shipped_test.hpp"
#include "mjarm/render/overlay_shapes.hpp"
#include "mjarm/serve/live_feed.hpp"

namespace mjarm::serve {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

JsonObject message_of(const std::string& text) {
  Result<JsonObject> object = parse_json_object(text);
  EXPECT_TRUE(object) << text << (object ? "" : object.error().what);
  return std::move(*object);
}

template <class T>
T at(const std::string& bytes, std::size_t place) {
  T value{};
  EXPECT_LE(place + sizeof(T), bytes.size());
  std::memcpy(&value, bytes.data() + place, sizeof(T));
  return value;
}

TEST(FrameMessage, HasThePosesThatTheSimulationHas) {
  const auto robot = mjarm::testing::shipped_arm("ur5e");
  Sim sim(robot.model);
  sim.place(robot.arm, as_span(robot.arm.home));
  BodyPoses poses(robot.model);
  ASSERT_TRUE(poses.set(sim.snapshot()));
  const std::string bytes = frame_message(poses, 1.5, true, 77);
  const auto bodies = static_cast<std::size_t>(poses.size());
  ASSERT_EQ(bytes.size(), 16 + 28 * bodies + 4 * poses.qpos().size());
  EXPECT_EQ(bytes[0], 1);
  EXPECT_EQ(bytes[1], 1);
  EXPECT_EQ(at<std::uint32_t>(bytes, 4), 77U);
  EXPECT_EQ(at<double>(bytes, 8), 1.5);
  for (std::size_t body = 0; body < bodies; ++body) {
    const Pose X_WB = sim.body_pose(static_cast<int>(body));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(at<float>(bytes, 16 + 28 * body + 4 * i), X_WB.p[static_cast<int>(i)], 1e-6);
    }
  }
  EXPECT_NEAR(at<float>(bytes, 16 + 28 * bodies), sim.qpos()[0], 1e-6);
}

TEST(OverlayMessage, LeavesOutWhatIsNoNumber) {
  const Model model = mjarm::testing::shipped("ur5e");
  BodyPoses poses(model);
  render::Overlay overlay;
  overlay.spheres = {{{0, 0, kNaN}}, {{1, 2, 3}, 0.5}};
  overlay.lines = {{{{0, 0, 0}, {kNaN, 0, 0}, {1, 0, 0}}}, {{{0, 0, 0}}}};
  overlay.segments = {{{{0, 0, 0}, {0, 0, 1}, {0, kNaN, 0}, {0, 0, 1}}}};
  overlay.arrows.emplace_back();
  overlay.frames.emplace_back();
  overlay.labels = {{{0, 0, 1}, "quote \" and \xff"}};
  overlay.ellipsoids.emplace_back();
  overlay.boxes.emplace_back();
  overlay.capsules.emplace_back();
  overlay.capsules.emplace_back().radius = kNaN;
  const JsonObject message = message_of(overlay_message(overlay, poses));
  const JsonValue& items = *message->find("items");
  std::string kinds;
  for (const JsonValue& item : items) kinds += item.find("kind")->string() + " ";
  EXPECT_EQ(kinds, "sphere line segments arrow frame label ellipsoid box capsule ");
  EXPECT_EQ(items[1].find("points")->size(), 2U);
  EXPECT_EQ(items[2].find("ends")->size(), 2U);
}

TEST(OverlayMessage, TellsWhenALineCameToItsPoints) {
  const Model model = mjarm::testing::shipped("ur5e");
  BodyPoses poses(model);
  render::Overlay overlay;
  const std::vector<Eigen::Vector3d> points = {{0, 0, 0}, {kNaN, 0, 0}, {1, 0, 0}};
  overlay.lines = {{.points_W = points, .times = {0.5, 1, 1.5}},
                   {.points_W = points, .times = {1}}};
  const JsonObject message = message_of(overlay_message(overlay, poses));
  const JsonValue& items = *message->find("items");
  const JsonValue* const times = items[0].find("times");
  ASSERT_NE(times, nullptr);
  ASSERT_EQ(times->size(), 2U);
  EXPECT_EQ((*times)[1].number(), 1.5);
  EXPECT_EQ(items[1].find("times"), nullptr);  // not one a point
}

TEST(OverlayMessage, AGhostIsWhereItsJointsPutIt) {
  const auto robot = mjarm::testing::shipped_arm("ur5e");
  BodyPoses poses(robot.model);
  JointVec q = robot.arm.home;
  q[0] += 0.3;
  Sim sim(robot.model);
  sim.place(robot.arm, as_span(robot.arm.home));
  ASSERT_TRUE(poses.set(sim.snapshot()));
  render::Overlay overlay;
  overlay.ghosts = {render::ghost_of(robot.arm, as_span(q)),
                    render::ghost_of(robot.arm, as_span(robot.arm.home))};
  const JsonObject message = message_of(overlay_message(overlay, poses));
  const JsonValue& items = *message->find("items");
  ASSERT_EQ(items.size(), 1U);  // the other stands in the robot itself
  EXPECT_EQ(items[0].find("item")->number(), -1);
  Sim there(robot.model);
  there.place(robot.arm, as_span(q));
  for (const JsonValue& body : *items[0].find("bodies")) {
    ASSERT_EQ(body.size(), 8U);
    const Pose X_WB = there.body_pose(static_cast<int>(body[0].number()));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(body[i + 1].number(), X_WB.p[static_cast<int>(i)], 1e-5);
    }
  }
  overlay.ghosts = {{{0, 1}, {kNaN, 0}}, {{0}, {1, 2}}, {{-1, 999}, {1, 1}}};
  EXPECT_EQ(message_of(overlay_message(overlay, poses))->find("items")->size(), 0U);
}

TEST(OverlayMessage, OfVeryManyPointsSomeAreLeftOut) {
  const Model model = mjarm::testing::shipped("ur5e");
  BodyPoses poses(model);
  render::Overlay overlay;
  overlay.lines.emplace_back().points_W.assign(300'000, {0.123456789, 1, 2});
  overlay.spheres.resize(300'000);
  EXPECT_LT(overlay_message(overlay, poses).size(), 5'000'000U);
}

TEST(PlotsMessage, IsThinnedAndKeepsGaps) {
  view::LivePlot plot{.title = "t", .x_label = "x"};
  view::LiveSeries series{.name = "long", .style = render::LineStyle::dashed};
  for (int i = 0; i < 50'000; ++i) {
    series.x.push_back(i);
    series.y.push_back(i == 30'001 ? kNaN : i / 3.0);
  }
  plot.series = {series, {.name = "empty"}, {.x = {1, kNaN}, .y = {kNaN, 1}}};
  const std::string text = plots_message({&plot, 1});
  EXPECT_LT(text.size(), 50'000U);
  const JsonObject message = message_of(text);
  const JsonValue& sent = *(*message->find("plots"))[0].find("series");
  const JsonValue& x = *sent[0].find("x");
  const JsonValue& y = *sent[0].find("y");
  EXPECT_LE(x.size(), kMaxSeriesPoints);
  EXPECT_GT(x.size(), kMaxSeriesPoints / 2);
  ASSERT_EQ(x.size(), y.size());
  EXPECT_EQ(x[x.size() - 1].number(), 49'999);
  int gaps = 0;
  for (const JsonValue& value : y) gaps += value.is_null() ? 1 : 0;
  EXPECT_EQ(gaps, 1);
  EXPECT_EQ(sent[0].find("style")->string(), "dashed");
  EXPECT_EQ(sent[1].find("x")->size(), 0U);
  EXPECT_EQ(sent[2].find("x")->size(), 1U);
}

TEST(PanelsMessage, HasEveryKind) {
  const view::PanelSection section{"Title",
                                   {{1, "a", view::PanelButton{}},
                                    {2, "b", view::PanelCheckbox{true}},
                                    {3, "c", view::PanelSlider{kNaN, -1, 1}},
                                    {4, "d", view::PanelText{"v"}},
                                    {5, "e", view::PanelChoice{{"x", "y"}, 1}},
                                    {6, "f", view::PanelList{{"l"}, 0}},
                                    {7, "g", view::PanelTimeline{1, 2}, false}},
                                   false};
  const JsonObject message = message_of(panels_message({&section, 1}));
  const JsonValue& sent = (*message->find("sections"))[0];
  EXPECT_FALSE(sent.find("open")->boolean());
  const JsonValue& items = *sent.find("items");
  std::string kinds;
  for (const JsonValue& item : items) kinds += item.find("kind")->string() + " ";
  EXPECT_EQ(kinds, "button checkbox slider text choice list timeline ");
  EXPECT_EQ(items[2].find("value")->number(), 0);
  EXPECT_EQ(items[4].find("current")->number(), 1);
  EXPECT_FALSE(items[6].find("enabled")->boolean());
}

TEST(TargetMessage, HasAxesOnlyWhereTheyAreNotItsOwn) {
  view::TargetLook look{.shown = true, .number = 9};
  look.X_WT.p = {0.1, 0.2, 0.3};
  JsonObject message = message_of(target_message(look, false));
  EXPECT_TRUE(message->find("axes")->is_null());
  EXPECT_FALSE(message->find("turns")->boolean());
  EXPECT_EQ(message->find("number")->number(), 9);
  EXPECT_EQ((*message->find("pos"))[2].number(), 0.3);
  look.R_WG = Eigen::Matrix3d::Identity();
  (*look.R_WG)(0, 1) = 5;
  message = message_of(target_message(look, true));
  EXPECT_EQ((*message->find("axes"))[1].number(), 5);  // row by row
  look.X_WT.p.x() = kNaN;
  EXPECT_FALSE(message_of(target_message(look, true))->find("shown")->boolean());
}

class Feed : public ::testing::Test {
 protected:
  void post(double time) {
    view::ViewFrame frame;
    frame.snapshot = Sim(robot_.model).snapshot();
    frame.snapshot.time = time;
    frame.status = "line";
    frame.panels = {{"s", {{1, "b", view::PanelButton{}}}}};
    link_.frames.post(frame);
  }
  std::uint64_t version(LiveKind kind) { return feed_.message(kind).version; }

  mjarm::testing::TestArm robot_ = mjarm::testing::shipped_arm("ur5e");
  DrawnModel drawn_ = drawn_model(robot_.model);
  SceneFacts facts_{.can_target = true};
  view::ViewLink link_;
  view::TargetLink target_;
  LiveFeed feed_{robot_.model, drawn_, facts_, link_, &target_, false};
  PageHold hold_;
};

TEST_F(Feed, SendsAgainOnlyWhatChanged) {
  feed_.refresh(0);
  EXPECT_EQ(version(LiveKind::frame), 0U);
  post(1);
  feed_.refresh(1);
  for (const LiveKind kind : {LiveKind::frame, LiveKind::overlay, LiveKind::plots, LiveKind::panels,
                              LiveKind::status, LiveKind::target}) {
    EXPECT_EQ(version(kind), 1U);
  }
  post(2);
  feed_.refresh(2);
  EXPECT_EQ(version(LiveKind::frame), 2U);
  EXPECT_EQ(version(LiveKind::overlay), 1U);
  EXPECT_EQ(version(LiveKind::panels), 1U);
}

TEST_F(Feed, NoFrameIsTakenSoonerThanItMayBeSent) {
  post(1);
  feed_.refresh(1);
  post(2);
  feed_.refresh(1.005);
  EXPECT_EQ(version(LiveKind::frame), 1U);
  EXPECT_FALSE(link_.frames.is_empty());
  feed_.refresh(1.02);
  EXPECT_EQ(version(LiveKind::frame), 2U);
}

TEST_F(Feed, WhatAVanishedPageHeldIsLetGoOf) {
  post(1);
  feed_.refresh(1);
  ASSERT_TRUE(feed_.handle(R"({"type":"push","body":4,"point":[0,0,0],"force":[0,0,1]})", hold_));
  ASSERT_TRUE(feed_.handle(
      R"({"type":"drag","pos":[0,0,1],"quat":[1,0,0,0],"held":true,"number":3})", hold_));
  EXPECT_EQ(link_.events.take().size(), 1U);
  EXPECT_EQ(target_.drags.take().size(), 1U);
  feed_.let_go(hold_);
  feed_.let_go(hold_);
  const auto events = link_.events.take();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(std::get<view::ReleaseEvent>(events[0]).body, 4);
  const auto drags = target_.drags.take();
  ASSERT_EQ(drags.size(), 1U);
  EXPECT_FALSE(drags[0].held);
}

TEST_F(Feed, PausedIsInTheFrameAndRoomIsBounded) {
  post(1);
  feed_.refresh(1);
  EXPECT_EQ((*feed_.message(LiveKind::frame).bytes)[1], 0);
  ASSERT_TRUE(feed_.handle(R"({"type":"pause","paused":true})", hold_));
  feed_.refresh(2);
  EXPECT_EQ((*feed_.message(LiveKind::frame).bytes)[1], 1);
  EXPECT_TRUE(feed_.has_room());
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(feed_.handle(R"({"type":"reset"})", hold_));
  EXPECT_FALSE(feed_.has_room());
  EXPECT_FALSE(link_.events.take().empty());
  EXPECT_TRUE(feed_.has_room());
}

}  // namespace
}  // namespace mjarm::serve
