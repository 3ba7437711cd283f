// The panels, pressed with a mouse that is only told: drawn into a picture without a window, so
// this holds on machines without a display.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <cstdlib>

#include "mjarm/model/mujoco_guard.hpp"
#include "mjarm/render/gl_context.hpp"
#include "mjarm/view/gl_function_test.hpp"
#include "mjarm/view/interaction_internal.hpp"
#include "mjarm/view/panels_internal.hpp"

namespace mjarm::view {
namespace {

using Kind = RawInput::Kind;

/// Two hinges with limits and without, and a ball joint, which has no slider.
constexpr const char* kThreeJoints =
    R"(<mujoco><compiler angle="radian"/><worldbody><body><geom size="0.1"/>
  <joint name="pan" axis="0 0 1" range="-1 3" limited="true"/>
  <body pos="1 0 0"><geom size="0.1"/><joint name="lift" axis="0 1 0"/>
    <body pos="1 0 0"><geom size="0.1"/><joint type="ball"/></body></body>
</body></worldbody></mujoco>)";

class PanelTest : public ::testing::Test {
 protected:
  void SetUp() override {
    unsetenv("MUJOCO_GL");
    Result<render::GlContext> made = render::GlContext::create();
    if (!made) GTEST_SKIP() << made.error().what;
    gl_.emplace(std::move(*made));
    mjr_defaultContext(&context_);
    ASSERT_FALSE(
        call_mujoco([&] { mjr_makeContext(&scene_.model(), &context_, mjFONTSCALE_100); }).failed);
    mjr_setBuffer(mjFB_OFFSCREEN, &context_);
    font_.emplace(context_.charHeight, testing::gl_function);
    panels_.resize(1200, 3000);  // high enough for all items at once
  }
  void TearDown() override {
    if (gl_) mjr_freeContext(&context_);
  }
  void show(const std::vector<PanelSection>& sections = {}) {
    panels_.show(user_.settings, {.d = &scene_.data(), .paused = user_.paused(), .speed = 1},
                 sections, context_);
  }
  /// Presses and releases the left button at a share of an item's place, from its lower left.
  void click(bool left, int section, int item, double x = 0.5, double y = 0.5) {
    const std::optional<mjrRect> place = panels_.place(left, section, item);
    ASSERT_TRUE(place) << section << " " << item;
    for (const Kind kind : {Kind::press, Kind::release}) {
      user_.handle({.kind = kind,
                    .x = place->left + x * place->width,
                    .y = place->bottom + y * place->height,
                    .time = time_ += 1},
                   context_);
    }
  }
  template <class Event>
  std::optional<Event> event() {
    std::vector<ViewEvent> events = user_.take_events();
    if (events.size() != 1 || !std::holds_alternative<Event>(events[0])) return {};
    return std::get<Event>(events[0]);
  }

  Model model_ = Model::from_mjcf(kThreeJoints).value();
  render::Scene scene_{model_, render::RenderQuality::low};
  std::optional<render::GlContext> gl_;
  mjrContext context_{};
  std::optional<GlyphFont> font_;
  Panels panels_{scene_.model(), {0}, true, false};
  Interaction user_{scene_, panels_, {.reset = false}, false};
  double time_ = 0;
};

TEST_F(PanelTest, ThePictureGetsTheRoomThatThePanelsLeave) {
  show();
  EXPECT_EQ(panels_.view().width, 1200);
  panels_.toggle_left();
  show();
  const mjrRect with_left = panels_.view();
  EXPECT_GT(with_left.left, 100);
  EXPECT_EQ(with_left.left + with_left.width, 1200);
  panels_.toggle_right();
  show();
  EXPECT_EQ(panels_.view().left, with_left.left);
  EXPECT_LT(panels_.view().width, with_left.width);
  EXPECT_EQ(panels_.view().height, 3000);
  // A window that is narrower than its panels has none of the picture, and no negative room.
  panels_.resize(200, 100);
  EXPECT_GE(panels_.view().width, 0);
  EXPECT_EQ(panels_.view().height, 100);
}

TEST_F(PanelTest, EveryCheckboxOfTheSettingsTogglesItsOwnFlag) {
  panels_.toggle_left();
  show();
  const ViewSettings before = user_.settings;
  for (int i = 0; i < kViewFlags; ++i) {
    ViewSettings expected = before;
    const auto flag = static_cast<ViewFlag>(i);
    expected.set(flag, !before.shows(flag));
    click(true, 1, 2 + i);
    EXPECT_EQ(user_.settings, expected) << text(setting_rows()[static_cast<std::size_t>(i)].label);
    show();
    click(true, 1, 2 + i);
    EXPECT_EQ(user_.settings, before);
    show();
  }
  for (int i = 0; i < 2 * kViewGroups; ++i) {
    ViewSettings expected = before;
    auto& groups = i % 2 == 0 ? expected.geom_groups : expected.site_groups;
    groups[static_cast<std::size_t>(i / 2)] ^= true;
    click(true, 2, i);
    EXPECT_EQ(user_.settings, expected) << i;
    show();
    click(true, 2, i);
    show();
  }
  EXPECT_TRUE(user_.take_events().empty()) << "settings are the window's own";
}

TEST_F(PanelTest, ButtonsDoWhatTheirKeysDo) {
  panels_.toggle_left();
  show();
  click(true, 0, 0);
  const auto paused = event<PauseEvent>();
  ASSERT_TRUE(paused);
  EXPECT_TRUE(paused->paused);
  show();
  click(true, 0, 3);
  const auto step = event<StepEvent>();
  ASSERT_TRUE(step);
  EXPECT_EQ(step->steps, 1);
  click(true, 0, 5);
  const auto faster = event<SpeedEvent>();
  ASSERT_TRUE(faster);
  EXPECT_GT(faster->speed, 1);
  click(true, 0, 8);
  EXPECT_TRUE(user_.take_screenshot());
  // Reset is not allowed here: the button is grey and does nothing.
  click(true, 0, 6);
  EXPECT_TRUE(user_.take_events().empty());
  EXPECT_FALSE(user_.take_said());
  // A line of text is none to press.
  click(true, 0, 1);
  EXPECT_TRUE(user_.take_events().empty());
}

TEST_F(PanelTest, ASliderGoesWhereItIsPressedWithinTheLimitsOfItsJoint) {
  panels_.toggle_right();
  show();
  double before = -2;
  for (const double share : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    click(false, 0, 1, share);
    const auto moved = event<JointEvent>();
    ASSERT_TRUE(moved) << share;
    EXPECT_EQ(moved->joint, "pan");
    EXPECT_EQ(moved->dof, 0);
    EXPECT_GT(moved->value, before);
    EXPECT_NEAR(moved->value, -1 + 4 * share, 0.15);
    before = moved->value;
    show();
  }
  // The other joint is not to be moved, and the ball joint has no place at all.
  click(false, 0, 3);
  EXPECT_TRUE(user_.take_events().empty());
  EXPECT_FALSE(panels_.place(false, 0, 4));
}

TEST_F(PanelTest, SectionsOfTheApplicationTellTheirOwnNumbers) {
  panels_.toggle_right();
  std::vector<PanelSection> sections(1);
  sections[0].title = "Program";
  PanelList list{.lines = {}, .current = 50};
  for (int i = 0; i < 100; ++i) list.lines.push_back("line " + std::to_string(i));
  sections[0].items = {{41, "Run", PanelButton{}},
                       {42, "Loop", PanelCheckbox{true}},
                       {43, "Gain", PanelSlider{5, 0, 10}},
                       {44, "", PanelTimeline{0, 8}},
                       {45, "", list},
                       {46, "Off", PanelButton{}, false}};
  show(sections);
  const auto told = [&](int item, double x = 0.5, double y = 0.5) {
    click(false, 1, item, x, y);
    return event<PanelEvent>();
  };
  const auto run = told(0);
  ASSERT_TRUE(run);
  EXPECT_EQ(run->id, 41);
  EXPECT_EQ(run->value, 1);
  const auto loop = told(1);
  ASSERT_TRUE(loop);
  EXPECT_EQ(loop->id, 42);
  EXPECT_EQ(loop->value, 0) << "it was on";
  const auto time = told(3, 0.75);
  ASSERT_TRUE(time);
  EXPECT_EQ(time->id, 44);
  EXPECT_NEAR(time->value, 6, 0.4);
  // Thirty lines round the current one: the first that is seen is 15 before it.
  const auto first = told(4, 0.5, 1 - 0.5 / 30);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->id, 45);
  EXPECT_EQ(first->value, 35);
  show(sections);
  const auto last = told(4, 0.5, 0.5 / 30);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->value, 64);
  EXPECT_FALSE(told(5)) << "a grey button";
}

/// A title that is pressed folds its section away; when other sections come, it stays folded.
TEST_F(PanelTest, AFoldedSectionStaysFolded) {
  panels_.toggle_right();
  std::vector<PanelSection> sections(1);
  sections[0] = {"Program", {{1, "Run", PanelButton{}}}};
  show(sections);
  ASSERT_TRUE(panels_.place(false, 1, 0));
  click(false, 1, -1);
  EXPECT_FALSE(panels_.place(false, 1, 0));
  sections.push_back({"Target", {{2, "Show", PanelButton{}}}, false});
  show(sections);
  EXPECT_FALSE(panels_.place(false, 1, 0)) << "by the hand of the user";
  EXPECT_FALSE(panels_.place(false, 2, 0)) << "as the application asked";
  click(false, 2, -1);
  EXPECT_TRUE(panels_.place(false, 2, 0));
  EXPECT_TRUE(user_.take_events().empty());
}

/// More than there is room for, names in any script and numbers that are none: it is drawn.
TEST_F(PanelTest, TakesAnything) {
  panels_.toggle_right();
  std::vector<PanelSection> sections(20);
  for (PanelSection& section : sections) {
    section.title = "节 " + std::string(100, 'x');
    section.items.assign(30, {1, "名字" + std::string(100, 'y'), PanelText{"值"}});
  }
  sections[0].items = {{1, "a", PanelSlider{std::nan(""), 3, 3}},
                       {2, "b", PanelSlider{1, -INFINITY, INFINITY}},
                       {3, "", PanelTimeline{5, 0}},
                       {4, "c", PanelChoice{{}, 7}},
                       {5, "", PanelList{{}, -1}}};
  show(sections);
  EXPECT_TRUE(panels_.place(false, 0, -1));
  panels_.render(context_, *font_);
  show(sections);
  show({});
  EXPECT_FALSE(panels_.place(false, 1, -1));
}

}  // namespace
}  // namespace mjarm::view
