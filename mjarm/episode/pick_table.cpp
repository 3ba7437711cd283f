#include <algorithm>
#include <numbers>
#include <utility>

#include "mjarm/core/messages/episode.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/episode/draw_looks_internal.hpp"
#include "mjarm/episode/pick_table_internal.hpp"

namespace mjarm::episode {
namespace {

constexpr double kTableTop = 0.2, kTrayFloor = 0.206;  // [m] heights in scenes/pick_table.xml
constexpr double kApart = 0.12;                        // [m] between the middles of two objects
constexpr int kMaxDraws = 10000;                       // of a place beside the others
constexpr std::size_t kTurns = 8;                      // of the tool that are tried

constexpr DrawRange kObjectX{"object_x", "m", 0.36, 0.62};
constexpr DrawRange kObjectY{"object_y", "m", 0.03, 0.32};
constexpr DrawRange kObjectYaw{"object_yaw", "rad", -std::numbers::pi, std::numbers::pi};
constexpr DrawRange kPlaceX{"place_x", "m", 0.44, 0.56};
constexpr DrawRange kPlaceY{"place_y", "m", -0.34, -0.18};

/// An object of the table and the height of its frame above what it stands on.
struct TableObject {
  const char* body;
  Msg name;
  double height;  // [m]
};
constexpr TableObject kObjects[] = {{"box", msg::episode_box, 0.03},
                                    {"can", msg::episode_can, 0.05},
                                    {"house", msg::episode_house, 0.03}};

Pose somewhere(Rng& rng, double height) {
  const double x = drawn(rng, kObjectX), y = drawn(rng, kObjectY);
  return {.p = {x, y, kTableTop + height}, .R = from_euler({0, 0, drawn(rng, kObjectYaw)})};
}

void draw_objects(Rng& rng, DrawnScene& out) {
  for (const TableObject& object : kObjects) {
    const auto is_apart = [&](const Pose& pose) {
      return std::ranges::all_of(out.objects, [&](const DrawnObject& other) {
        return (other.X_WB.p - pose.p).head<2>().norm() >= kApart;
      });
    };
    Pose pose = somewhere(rng, object.height);
    for (int i = 1; i < kMaxDraws && !is_apart(pose); ++i) pose = somewhere(rng, object.height);
    out.objects.push_back({object.body, pose, {}, {}});
  }
}

/// Both see the table, the tray and the hand: one from before the arm, one from its side.
void draw_table_views(Rng& rng, DrawnScene& out) {
  const DrawnView nominal[] = {
      {"front",
       {.lookat_W = {0.42, 0.02, 0.32},
        .distance = 1.25,
        .azimuth = std::numbers::pi,
        .elevation = -0.6}},
      {"side",
       {.lookat_W = {0.42, 0.0, 0.3}, .distance = 1.3, .azimuth = -1.9, .elevation = -0.65}}};
  draw_views(rng, nominal, out);
}

}  // namespace

PickTable draw_pick_table(const Robot& robot, EpisodeRng& rng, Msg pattern) {
  PickTable out;
  DrawnScene& scene = out.scene;
  draw_objects(rng.scene, scene);
  scene.target = rng.scene.below(scene.objects.size());
  const double x = drawn(rng.scene, kPlaceX), y = drawn(rng.scene, kPlaceY);
  out.p_place = {x, y, kTrayFloor + kObjects[scene.target].height};
  for (std::size_t i = 0; i < kTurns; ++i) out.turns.push_back(drawn(rng.scene, kObjectYaw));
  draw_start(rng.scene, robot.arm, scene);

  const NamedColor& color = paint_all(rng.looks, scene);
  constexpr const char* kFurniture[] = {"table_top", "tray_floor", "fence"};
  draw_grays(rng.looks, kFurniture, scene);
  draw_light(rng.looks, scene);
  draw_table_views(rng.looks, scene);
  const Msg object = kObjects[scene.target].name;
  tell_task(
      pattern,
      [&](Language language) {
        return std::vector<std::string>{std::string(color.name.in(language)),
                                        std::string(object.in(language))};
      },
      scene);
  return out;
}

std::vector<DrawRange> object_ranges() { return {kObjectX, kObjectY, kObjectYaw}; }
std::vector<DrawRange> place_ranges() { return {kPlaceX, kPlaceY}; }

}  // namespace mjarm::episode
