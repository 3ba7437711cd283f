// Pictures of planned paths, and what a window shows of them.
#include "mjarm/session/plan_drawing.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "mjarm/collision/cover.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/render/framing.hpp"
#include "mjarm/render/offscreen.hpp"
#include "mjarm/session/plan_player.hpp"
#include "mjarm/session/plan_view.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::session {
namespace {

/// The shipped UR5e on both sides of its wall, planned once.
class WallPlan : public ::testing::Test {
 protected:
  struct World {
    Model model;
    Arm arm;
    ModelCover cover;
    FastChecker checker;
    PlannedPath path;
  };
  static const World& world() {
    static const World made = [] {
      auto [model, arm] = load_robot("universal_robots_ur5e/wall.xml").value();
      ModelCover cover = cover_model(model, arm).value();
      FastChecker checker =
          FastChecker::create(FastRobot::create(arm, cover.spheres).value(), cover.scene).value();
      const std::array start{1.9084251652,  -1.2456136770, 1.9904811714,
                             -2.3156638212, -1.5707963268, 3.4792213440},
          goal{0.7324199581,  -1.2456136770, 1.9904811714,
               -2.3156638212, -1.5707963268, 2.3032162849};
      PlannedPath path =
          plan_path(checker, start, std::vector{joint_vec(goal)}, {.keep_trees = true}).value();
      return World{std::move(model), std::move(arm), std::move(cover), std::move(checker),
                   std::move(path)};
    }();
    return made;
  }
  static const PlanSubject& subject() {
    static const PlanSubject made{world().model,       world().arm,  world().checker,
                                  world().cover.scene, world().path, "wall"};
    return made;
  }
  static PlanDrawing& drawing() {
    static PlanDrawing made(subject());
    return made;
  }
  static PlanLook tightest() { return drawing().look(drawing().way().at(drawing().tightest())); }
};

TEST_F(WallPlan, TheWayIsThePathByItsLength) {
  const PathWay& way = drawing().way();
  const PlannedPath& path = world().path;
  ASSERT_GT(path.q.size(), 2U);
  EXPECT_NEAR(way.length(), path.cost, 1e-12);
  EXPECT_EQ(way.at(0), path.q.front());
  EXPECT_EQ(way.at(-1), path.q.front());
  EXPECT_EQ(way.at(way.length() + 1), path.q.back());
  double s = 0;
  for (std::size_t i = 0; i + 1 < path.q.size(); ++i) {
    const double length = (path.q[i + 1] - path.q[i]).norm();
    EXPECT_EQ(way.edge_at(s + 0.5 * length), i);
    EXPECT_LT((way.at(s + 0.5 * length) - 0.5 * (path.q[i] + path.q[i + 1])).norm(), 1e-12);
    s += length;
  }
  // Nowhere on the path is the checker's clearance much below that of the tightest place.
  const double least = world().checker.clearance(as_span(way.at(drawing().tightest()))).distance;
  for (int k = 0; k <= 300; ++k) {
    EXPECT_GT(world().checker.clearance(as_span(way.at(way.length() * k / 300))).distance,
              least - 0.02);
  }
}

TEST_F(WallPlan, EveryLayerAddsWhatItSays) {
  const PlanLook look = tightest();
  const PlanLayers none{false, false, false, false, false, false};
  const render::Overlay empty = drawing().overlay(none, look);
  EXPECT_EQ(shapes_of(empty), 0U);
  PlanLayers layers = none;
  layers.spheres = true;
  EXPECT_EQ(drawing().overlay(layers, look).spheres.size(), world().cover.spheres.size());
  layers = none;
  layers.pair = true;
  const render::Overlay pair = drawing().overlay(layers, look);
  ASSERT_EQ(pair.labels.size(), look.obstacle_pair ? 2U : 1U);
  EXPECT_NE(pair.labels[0].text.find(" mm"), std::string::npos);
  layers = none;
  layers.path = true;
  const render::Overlay path = drawing().overlay(layers, look);
  EXPECT_EQ(path.spheres.size(), world().path.q.size());
  EXPECT_EQ(path.spheres.front().p_W, fk(world().arm, as_span(world().path.q.front())).p);
  layers = none;
  layers.tree = true;
  const render::Overlay tree = drawing().overlay(layers, look);
  ASSERT_EQ(tree.segments.size(), 2U);
  std::size_t edges = 0, pieces = 0;
  for (const SearchTree& one : world().path.trees) edges += one.q.size() - 1;
  for (const render::OverlaySegments& segments : tree.segments)
    pieces += segments.ends_W.size() / 2;
  EXPECT_GT(pieces, edges);
  layers = none;
  layers.ends = true;
  EXPECT_EQ(drawing().overlay(layers, look).capsules.size(), 2U * 6);  // rods of six joints
  layers = none;
  layers.corners = true;
  EXPECT_EQ(drawing().overlay(layers, look).capsules.size(),
            6 * std::min<std::size_t>(world().path.q.size() - 2, 8));
}

TEST_F(WallPlan, TheTightestPlaceIsToldByName) {
  const PlanLook look = tightest();
  ASSERT_TRUE(look.pair);
  EXPECT_GT(look.pair->distance, 0);
  const std::string line = pair_line(*look.pair);
  EXPECT_NE(line.find(" - "), std::string::npos) << line;
  EXPECT_NE(line.find(" mm"), std::string::npos) << line;
  {
    const LanguageScope chinese(Language::chinese);
    EXPECT_NE(pair_line(*look.pair).find("："), std::string::npos) << pair_line(*look.pair);
  }
  if (look.obstacle_pair) {
    EXPECT_GE(look.obstacle_pair->distance, look.pair->distance);
  }
}

/// Spheres that stick out are not what is told of a model: at the tightest place they overlap.
TEST_F(WallPlan, OfAModelItsOwnDistancesAreTold) {
  const FastChecker closer = world().checker.looking_closer(world().cover.solids);
  const PlanSubject model{world().model,       world().arm,  closer,
                          world().cover.scene, world().path, ""};
  PlanDrawing drawn(model);
  const PlanLook look = drawn.look(drawn.way().at(drawn.tightest()));
  EXPECT_TRUE(look.placed.empty());
  ASSERT_TRUE(look.pair);
  const double spheres = tightest().pair->distance;
  EXPECT_GT(look.pair->distance, spheres);
  EXPECT_LT(look.pair->distance, spheres + 0.06);  // twice what spheres stick out by, and more
  for (int k = 0; k <= 100; ++k) {
    const PlanLook other = drawn.look(drawn.way().at(drawn.way().length() * k / 100));
    ASSERT_TRUE(other.pair) << k;
    EXPECT_GT(other.pair->distance, look.pair->distance - 0.005) << k;
  }
  EXPECT_NE(pair_line(*look.pair).find("wall: "), std::string::npos) << pair_line(*look.pair);
}

TEST(PlanColors, GoFromRedToBlue) {
  EXPECT_EQ(clearance_color(-1), clearance_color(0));
  EXPECT_EQ(clearance_color(0.3), clearance_color(5));
  EXPECT_GT(clearance_color(0).r, clearance_color(0).g);
  EXPECT_GT(clearance_color(0.1).g, clearance_color(0.1).r);
  EXPECT_GT(clearance_color(1).b, clearance_color(1).r);
}

/// Where a point is in a picture [px].
Eigen::Vector2d pixel_of(const Model& model, const render::CameraView& from,
                         const Eigen::Vector3d& p_W, int width, int height) {
  const Eigen::Vector3d forward = (from.lookat_W - render::camera_place(from)).normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  const Eigen::Vector3d up = right.cross(forward), p = p_W - render::camera_place(from);
  const double tangent = std::tan(0.5 * model.raw()->vis.global.fovy * std::numbers::pi / 180);
  const double scale = 0.5 * height / (tangent * p.dot(forward));
  return {0.5 * width + scale * p.dot(right), 0.5 * height - scale * p.dot(up)};
}

/// All of the arm on its way is in the picture, and large.
TEST_F(WallPlan, TheViewFramesTheWay) {
  const render::CameraView from = plan_view(subject(), drawing(), 1.5);
  double low = 1e9, high = -1e9;
  for (int k = 0; k <= 50; ++k) {
    const JointVec q = drawing().way().at(drawing().way().length() * k / 50);
    for (const PlacedSphere& sphere : place_spheres(world().checker.robot(), as_span(q))) {
      const Eigen::Vector2d pixel = pixel_of(world().model, from, sphere.p_W, 600, 400);
      EXPECT_GT(pixel.x(), -20);
      EXPECT_LT(pixel.x(), 620);
      EXPECT_GT(pixel.y(), -20);
      EXPECT_LT(pixel.y(), 420);
      low = std::min(low, pixel.y());
      high = std::max(high, pixel.y());
    }
  }
  EXPECT_GT(high - low, 100);
}

/// The wall, which the path goes round, is in the picture with all its corners.
TEST_F(WallPlan, TheViewHoldsWhatThePathGoesRound) {
  for (const double aspect : {1.0, 1.5, 2.5}) {
    const render::CameraView from = plan_view(subject(), drawing(), aspect);
    for (const double x : {-0.02, 0.02}) {
      for (const double y : {-0.72, -0.28}) {
        for (const double z : {0.0, 0.4}) {
          const int width = static_cast<int>(400 * aspect);
          const Eigen::Vector2d pixel = pixel_of(world().model, from, {x, y, z}, width, 400);
          EXPECT_GT(pixel.x(), 0) << aspect;
          EXPECT_LT(pixel.x(), width) << aspect;
          EXPECT_GT(pixel.y(), 0) << aspect;
          EXPECT_LT(pixel.y(), 400) << aspect;
        }
      }
    }
  }
}

class WallPicture : public WallPlan {
 protected:
  static constexpr int kWidth = 480, kHeight = 320;
  void SetUp() override {
    Result<render::OffscreenRenderer> opened = render::OffscreenRenderer::create(
        world().model, {.width = kWidth, .height = kHeight, .quality = render::RenderQuality::low});
    if (!opened) GTEST_SKIP() << opened.error().what;
    renderer_.emplace(std::move(*opened));
    from_ = plan_view(subject(), drawing(), static_cast<double>(kWidth) / kHeight);
    Sim sim(world().model);
    sim.place(world().arm, as_span(drawing().way().at(drawing().tightest())));
    standing_ = sim.snapshot();
  }
  render::Image draw(const PlanLayers& layers) {
    return renderer_->draw(standing_, {.view = from_}, drawing().overlay(layers, tightest()))
        .value();
  }
  std::optional<render::OffscreenRenderer> renderer_;
  render::CameraView from_;
  Snapshot standing_;
};

TEST_F(WallPicture, SpheresAreWhereTheRobotIsAndNowhereElse) {
  const PlanLayers none{false, false, false, false, false, false};
  PlanLayers spheres = none;
  spheres.spheres = true;
  const render::Image without = draw(none), with = draw(spheres);
  std::vector<std::pair<Eigen::Vector2d, double>> disks;  // [px]
  for (const PlacedSphere& sphere : tightest().placed) {
    const Eigen::Vector2d middle = pixel_of(world().model, from_, sphere.p_W, kWidth, kHeight);
    const Eigen::Vector3d side =
        (from_.lookat_W - render::camera_place(from_)).cross(Eigen::Vector3d::UnitZ()).normalized();
    const Eigen::Vector2d edge =
        pixel_of(world().model, from_, sphere.p_W + sphere.radius * side, kWidth, kHeight);
    disks.emplace_back(middle, (edge - middle).norm());
  }
  int changed = 0, elsewhere = 0, missing = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto a = with.pixel(x, y), b = without.pixel(x, y);
      const bool differs =
          std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]) > 20;
      const auto within = [&](double share, double more) {
        return std::ranges::any_of(disks, [&](const auto& disk) {
          return (Eigen::Vector2d(x + 0.5, y + 0.5) - disk.first).norm() <
                 share * disk.second + more;
        });
      };
      changed += differs ? 1 : 0;
      elsewhere += differs && !within(1.1, 2) ? 1 : 0;
      missing += !differs && within(0.7, 0) ? 1 : 0;  // behind the wall, or of much the same colour
    }
  }
  EXPECT_GT(changed, 2000);
  EXPECT_LT(elsewhere, changed / 100);
  EXPECT_LT(missing, changed / 3);
}

TEST_F(WallPicture, StartAndGoalHaveTheirColours) {
  PlanLayers layers{false, false, true, false, false, false};
  const render::Image image = draw(layers);
  const auto& q = world().path.q;
  // How much more of one colour than of the others there is at most, near the tool at a corner.
  const auto most_of = [&](std::size_t color, const JointVec& corner) {
    constexpr int kNear = 8;  // [pixels]
    const Eigen::Vector2d at =
        pixel_of(world().model, from_, fk(world().arm, as_span(corner)).p, kWidth, kHeight);
    int most = -255;
    for (int y = -kNear; y <= kNear; ++y) {
      for (int x = -kNear; x <= kNear; ++x) {
        const auto pixel = image.pixel(static_cast<int>(at.x()) + x, static_cast<int>(at.y()) + y);
        const int other = std::max(pixel[(color + 1) % 3], pixel[(color + 2) % 3]);
        most = std::max(most, pixel[color] - other);
      }
    }
    return most;
  };
  EXPECT_GT(most_of(1, q.front()), 60);  // green
  EXPECT_LT(most_of(2, q.front()), 60);
  EXPECT_GT(most_of(2, q.back()), 60);  // blue; the way there may be green
}

class PlanWindow : public WallPlan {
 protected:
  view::ViewFrame frame() {
    view::ViewFrame out;
    player_.fill(out);
    return out;
  }
  std::vector<double> positions() {
    Sim sim(world().model);
    EXPECT_TRUE(sim.restore(frame().snapshot));
    return {sim.qpos().begin(), sim.qpos().end()};
  }
  JointVec arm_at() {
    const std::vector<double> qpos = positions();
    JointVec q(world().arm.dof());
    for (int k = 0; k < world().arm.dof(); ++k) {
      q[k] = qpos[static_cast<std::size_t>(world().arm.joints[static_cast<std::size_t>(k)].qpos)];
    }
    return q;
  }
  PlanPlayer player_{subject(), drawing()};
};

TEST_F(PlanWindow, TheArmGoesBackAndForth) {
  EXPECT_LT((arm_at() - world().path.q.front()).norm(), 1e-9);
  const double length = drawing().way().length();
  double max = 0, turns = 0, before = 0;
  bool up = true;
  const int steps = static_cast<int>(3.5 * length / world().model.timestep());
  for (int i = 0; i < steps; ++i) {
    player_.step();
    max = std::max(max, player_.place());
    if ((player_.place() > before) != up) {
      up = !up;
      turns += 1;
    }
    before = player_.place();
    ASSERT_GE(before, 0);
    ASSERT_LE(before, length);
  }
  EXPECT_NEAR(max, length, 1e-2);
  EXPECT_EQ(turns, 3);
  EXPECT_LT((arm_at() - drawing().way().at(player_.place())).norm(), 1e-9);
}

TEST_F(PlanWindow, TheUserGoesToAPlace) {
  player_.handle(view::PanelEvent{kPlanTime, 1});
  EXPECT_EQ(player_.place(), 1);
  player_.handle(view::StepEvent{-5});
  EXPECT_NEAR(player_.place(), 1 - 5 * world().model.timestep(), 1e-12);
  player_.handle(view::PanelEvent{kPlanTightest, 1});
  EXPECT_EQ(player_.place(), drawing().tightest());
  EXPECT_NE(frame().status.find(" mm"), std::string::npos);
  player_.handle(view::PanelEvent{kPlanTime, 1e9});
  EXPECT_EQ(player_.place(), drawing().way().length());
  player_.handle(view::PanelEvent{kPlanTime, std::nan("")});
  EXPECT_EQ(player_.place(), drawing().way().length());
  player_.handle(view::ResetEvent{});
  EXPECT_EQ(player_.place(), 0);
}

TEST_F(PlanWindow, CheckBoxesChoose) {
  const render::Overlay all = frame().overlay;
  for (const PlanItem item : {kPlanSpheres, kPlanPair, kPlanPath, kPlanTree, kPlanEnds}) {
    player_.handle(view::PanelEvent{item, 0});
    const render::Overlay fewer = frame().overlay;
    EXPECT_LT(shapes_of(fewer), shapes_of(all)) << item;
    player_.handle(view::PanelEvent{item, 1});
    EXPECT_EQ(shapes_of(frame().overlay), shapes_of(all));
  }
  player_.handle(view::PanelEvent{kPlanCorners, 1});
  EXPECT_GT(frame().overlay.capsules.size(), all.capsules.size());
  ASSERT_EQ(frame().panels.size(), 3U);
}

TEST(PlanTool, IsBetweenTheOutermostSpheresWhereNoneIsNamed) {
  Arm arm;
  arm.joints.resize(2);
  const SphereSet set{{{"arm", 0, {{{5, 0, 0}, 0.1}}},
                       {"hand", 1, {{{0, 0, 0.1}, 0.1}}},
                       {"fingers", 1, {{{0, 0.04, 0.2}, 0.01}, {{0, -0.04, 0.2}, 0.01}}}},
                      {}};
  EXPECT_LT((with_tool(arm, set).X_JT.p - Eigen::Vector3d(0, 0, 0.2)).norm(), 1e-12);
  arm.tip = "tool0";
  EXPECT_EQ(with_tool(arm, set).X_JT.p, Eigen::Vector3d::Zero());
}

/// A cart that the keyframe has driven away, and a box on it.
TEST(PlaceSubject, WhatIsNotTheArmStandsAtHome) {
  const support::TempFolder folder;
  const std::string file = folder.write("cart.xml", R"(
<mujoco>
  <worldbody>
    <body name="cart" pos="0 0 0.1"><freejoint/><geom type="box" size="0.2 0.2 0.1" mass="9"/>
      <body name="link" pos="0 0 0.2"><joint name="turn" axis="0 0 1" range="-3 3"/>
        <geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.03"/><site name="tcp" pos="0.3 0 0"/>
      </body></body>
    <body name="box" pos="0 0 1"><freejoint/><geom type="box" size="0.05 0.05 0.05"/></body>
  </worldbody>
  <actuator><position joint="turn" kp="100" kv="10"/></actuator>
  <keyframe><key name="home" qpos="5 -3 0.1 1 0 0 0  0.5  4 4 0.05 1 0 0 0"/></keyframe>
</mujoco>)");
  const Robot robot = load_robot(file).value();
  PlannedPath path;
  path.q = {robot.arm.home};
  const ModelCover cover = cover_model(robot.model, robot.arm).value();
  const FastChecker checker =
      FastChecker::create(FastRobot::create(robot.arm, cover.spheres).value(), cover.scene).value();
  Sim sim(robot.model);
  place_subject(sim, {robot.model, robot.arm, checker, cover.scene, path, ""}, robot.arm.home);
  const std::vector<double> expected{5, -3, 0.1, 1, 0, 0, 0, 0.5, 4, 4, 0.05, 1, 0, 0, 0};
  EXPECT_EQ(std::vector<double>(sim.qpos().begin(), sim.qpos().end()), expected);
}

}  // namespace
}  // namespace mjarm::session
