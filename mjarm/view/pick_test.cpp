#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <set>

#include "mjarm/view/camera_control_internal.hpp"
#include "mjarm/view/controls.hpp"
#include "mjarm/view/pick_internal.hpp"
#include "mjarm/view/ray.hpp"
#include "mjarm/view/settings_internal.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::view {
namespace {

/// A ball on a slide in the middle, resting on a floor at its lower end; a wall that is for show.
constexpr const char* kPickScene = R"(
<mujoco>
  <option gravity="0 0 -10"/>
  <statistic center="0 0 0" extent="2"/>
  <worldbody>
    <camera name="front" pos="0 -3 0" xyaxes="1 0 0 0 0 1"/>
    <camera name="side" pos="3 0 0" xyaxes="0 1 0 0 0 1"/>
    <geom name="floor" type="plane" size="2 2 0.1" pos="0 0 -0.4"/>
    <geom name="wall" type="box" size="0.1 0.1 0.1" pos="1 0 0.6" contype="0" conaffinity="0"/>
    <body name="ball" pos="0 0 0">
      <joint name="x" type="slide" axis="1 0 0"/><joint name="z" type="slide" axis="0 0 1"/>
      <geom name="skin" type="sphere" size="0.401" mass="2"/>
    </body>
  </worldbody>
</mujoco>)";

class PickTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(scene_.set_camera({.name = "front"}));
    scene_.update({});
  }
  static Model load() {
    const support::TempFolder folder;
    return Model::load(folder.write("scene.xml", kPickScene)).value();
  }
  Model model_ = load();
  render::Scene scene_{model_, render::RenderQuality::low};
  Picker picker_{scene_};
  const PicturePoint middle_{0.5, 0.5, 4.0 / 3};
};

TEST_F(PickTest, SelectsWhatIsInTheMiddleAndTellsOfIt) {
  const SelectEvent event = picker_.select(middle_);
  EXPECT_EQ(event.body, 1);
  EXPECT_EQ(event.body_name, "ball");
  EXPECT_EQ(event.geom_name, "skin");
  // The camera stands at y = -3 and looks along +y.
  EXPECT_NEAR((event.point_W - Eigen::Vector3d(0, -0.401, 0)).norm(), 0, 1e-6);
  const std::vector<Picker::Row> rows = picker_.describe();
  ASSERT_EQ(rows.size(), 5U);
  EXPECT_EQ(rows[0].value, "ball");
  EXPECT_EQ(rows[1].value, "skin");
  EXPECT_EQ(rows[2].value, "0.0000  0.0000  0.0000");
  EXPECT_EQ(rows[3].value, "1.0000  0.0000  0.0000  0.0000");
  EXPECT_EQ(rows[4].value, "floor - skin");
}

TEST_F(PickTest, TheFloorIsSelectedButCannotBePushed) {
  const SelectEvent event = picker_.select({0.5, 0.1, 4.0 / 3});
  EXPECT_EQ(event.body, 0);
  EXPECT_EQ(event.geom_name, "floor");
  EXPECT_EQ(picker_.body(), 0);
  EXPECT_FALSE(picker_.take_hold({0.5, 0.1, 4.0 / 3}, false));
  EXPECT_FALSE(picker_.push());
}

TEST_F(PickTest, TheSkyIsNothing) {
  (void)picker_.select(middle_);
  EXPECT_EQ(picker_.select({0.1, 0.95, 4.0 / 3}).body, -1);
  EXPECT_EQ(picker_.body(), -1);
  EXPECT_TRUE(picker_.describe().empty());
}

TEST_F(PickTest, PushesTheWayTheMouseGoesAndTwistsAboutTheView) {
  ASSERT_TRUE(picker_.take_hold(middle_, false));
  EXPECT_LT(picker_.push()->force_W.norm(), 1e-9);
  picker_.drag(0.1, 0);
  const PushEvent right = picker_.push().value();
  EXPECT_EQ(right.body, 1);
  EXPECT_EQ(right.name, "ball");
  EXPECT_GT(right.force_W.x(), 1);
  EXPECT_NEAR(right.force_W.z(), 0, 1e-9);
  // About the centre of mass: r x F.
  EXPECT_NEAR((right.point_W.cross(right.force_W) - right.torque_W).norm(), 0, 1e-9);
  picker_.drag(-0.1, 0.1);
  EXPECT_GT(picker_.push()->force_W.z(), 1);
  EXPECT_EQ(picker_.let_go()->body, 1);
  EXPECT_FALSE(picker_.push());
  EXPECT_FALSE(picker_.let_go());
  ASSERT_TRUE(picker_.take_hold(middle_, true));
  picker_.drag(0.1, 0);
  EXPECT_GT(picker_.push()->torque_W.norm(), 1e-3);
  EXPECT_EQ(picker_.push()->force_W.norm(), 0);
}

TEST_F(PickTest, SightLinesGoThroughWhatMuJoCoSelects) {
  for (const double x : {0.45, 0.5, 0.55}) {
    const PicturePoint point{x, 0.55, 4.0 / 3};
    const Ray line = ray_of_share(eye_of(scene_), point.aspect, point.x, point.y);
    const SelectEvent event = picker_.select(point);
    ASSERT_EQ(event.body, 1);
    const Eigen::Vector3d way = event.point_W - line.origin_W;
    EXPECT_LT(way.cross(line.direction_W).norm(), 1e-5);
    EXPECT_GT(way.dot(line.direction_W), 1);
  }
}

TEST_F(PickTest, SettingsArriveInTheSceneAndComeBack) {
  const ViewSettings before = settings_of(scene_);
  EXPECT_FALSE(needs_dynamics(before));
  for (const SettingRow& row : setting_rows()) {
    ViewSettings changed = before;
    changed.set(row.flag, !before.shows(row.flag));
    apply(changed, scene_);
    ViewSettings back = settings_of(scene_);
    if (row.flag == ViewFlag::collision_geoms) back.set(row.flag, changed.shows(row.flag));
    EXPECT_EQ(back, changed) << row.label.english;
  }
  ViewSettings changed = before;
  changed.geom_groups[4] = true;
  changed.site_groups[0] = false;
  changed.label = mjLABEL_BODY;
  changed.frame = mjFRAME_CONTACT;
  apply(changed, scene_);
  EXPECT_EQ(settings_of(scene_), changed);
  EXPECT_TRUE(needs_dynamics(changed));
}

TEST_F(PickTest, ContactsAreDrawnAndTheWallForShowIsNot) {
  const auto shown = [this](int type, const char* geom) {
    const int id = geom == nullptr ? -1 : mj_name2id(model_.raw(), mjOBJ_GEOM, geom);
    scene_.update({});
    int count = 0;
    for (int i = 0; i < scene_.raw().ngeom; ++i) {
      const mjvGeom& drawn = scene_.raw().geoms[i];
      count += id >= 0 ? drawn.objtype == mjOBJ_GEOM && drawn.objid == id : drawn.type == type;
    }
    return count;
  };
  ViewSettings settings = settings_of(scene_);
  const int cylinders = shown(mjGEOM_CYLINDER, nullptr);
  settings.set(ViewFlag::contact_points, true);
  apply(settings, scene_);
  scene_.set_dynamics(needs_dynamics(settings));
  EXPECT_GT(shown(mjGEOM_CYLINDER, nullptr), cylinders);
  EXPECT_EQ(shown(0, "wall"), 1);
  settings.set(ViewFlag::collision_geoms, true);
  apply(settings, scene_);
  EXPECT_EQ(shown(0, "wall"), 0);
  EXPECT_EQ(shown(0, "skin"), 1);
}

TEST_F(PickTest, CamerasGoRoundAndADragMakesAFreeOne) {
  CameraControl camera(scene_);
  camera.begin();
  const render::CameraView first = scene_.view();
  EXPECT_EQ(camera.name(), "");
  camera.cycle(1);
  EXPECT_EQ(camera.name(), "front");
  camera.cycle(1);
  EXPECT_EQ(camera.name(), "side");
  camera.cycle(1);
  EXPECT_EQ(camera.name(), "front");
  camera.cycle(-1);
  EXPECT_EQ(camera.name(), "side");
  const render::CameraView side = scene_.view();
  camera.zoom(1);
  EXPECT_EQ(camera.name(), "");
  EXPECT_NEAR(scene_.view().azimuth, side.azimuth, 1e-9);
  EXPECT_LT(scene_.view().distance, side.distance);
  camera.to_first_view();
  EXPECT_EQ(scene_.view().lookat_W, first.lookat_W);
  EXPECT_EQ(scene_.view().azimuth, first.azimuth);
}

/// No key does two things, each does what its row says, and all stand in the help.
TEST(ControlTable, EveryKeyDoesOneThing) {
  std::set<std::pair<int, KeyModifier>> taken;
  for (const ActionRow& row : action_rows()) {
    EXPECT_TRUE(taken.insert({row.key, row.modifier}).second) << text(row.shown);
    EXPECT_EQ(action_of(row.key, row.modifier == KeyModifier::control,
                        row.modifier == KeyModifier::shift),
              row.action)
        << text(row.shown);
  }
  int i = 0;
  for (const SettingRow& row : setting_rows()) {
    EXPECT_EQ(static_cast<int>(row.flag), i++);
    EXPECT_TRUE(taken.insert({row.key, KeyModifier::none}).second) << row.label.english;
    EXPECT_FALSE(action_of(row.key, false, false)) << row.label.english;
    EXPECT_LE(std::string(row.label.english).size(), 14U);
  }
  EXPECT_FALSE(action_of('B', true, false));
  EXPECT_EQ(action_of('=', false, true), ViewAction::faster);  // `+` is Shift and `=`
  EXPECT_EQ(control_help().size(), action_rows().size() + setting_rows().size() + 10);
  for (const ControlHelp& row : control_help()) {
    for (const char c : row.keys + row.about) EXPECT_TRUE(c >= 32 && c < 127);
  }
}

/// The keys are those of MuJoCo's own viewer.
TEST(ControlTable, SettingsHaveMuJoCosKeys) {
  const ViewFlag ours[] = {ViewFlag::contact_points, ViewFlag::contact_forces,
                           ViewFlag::transparent,    ViewFlag::joints,
                           ViewFlag::convex_hull,    ViewFlag::inertia};
  const int theirs[] = {mjVIS_CONTACTPOINT, mjVIS_CONTACTFORCE, mjVIS_TRANSPARENT,
                        mjVIS_JOINT,        mjVIS_CONVEXHULL,   mjVIS_INERTIA};
  for (std::size_t i = 0; i < std::size(ours); ++i) {
    EXPECT_EQ(setting_rows()[static_cast<std::size_t>(ours[i])].key, mjVISSTRING[theirs[i]][2][0]);
  }
  const ViewFlag effects[] = {ViewFlag::shadow, ViewFlag::wireframe, ViewFlag::reflection,
                              ViewFlag::skybox, ViewFlag::fog,       ViewFlag::haze};
  const int flags[] = {mjRND_SHADOW, mjRND_WIREFRAME, mjRND_REFLECTION,
                       mjRND_SKYBOX, mjRND_FOG,       mjRND_HAZE};
  for (std::size_t i = 0; i < std::size(effects); ++i) {
    EXPECT_EQ(setting_rows()[static_cast<std::size_t>(effects[i])].key,
              mjRNDSTRING[flags[i]][2][0]);
  }
}

}  // namespace
}  // namespace mjarm::view
