#include "mjarm/episode/draw_scene.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string_view>
#include <utility>

#include "mjarm/core/messages/episode.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm::episode {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTableTop = 0.2, kTrayFloor = 0.206;  // [m] heights in scenes/pick_table.xml
constexpr double kApart = 0.12;                        // [m] between the middles of two objects
constexpr int kMaxDraws = 10000;                       // of a place beside the others
constexpr std::size_t kTurns = 8;                      // of the tool that are tried

/// What is drawn, in the order of draw_ranges().
enum Drawn : std::size_t {
  kObjectX,
  kObjectY,
  kObjectYaw,
  kPlaceX,
  kPlaceY,
  kJoint,
  kTint,
  kTableShade,
  kLightAzimuth,
  kLightElevation,
  kLightStrength,
  kLightWarmth,
  kCameraLookat,
  kCameraDistance,
  kCameraAngle,
};

constexpr DrawRange kRanges[] = {
    {"object_x", "m", 0.36, 0.62},
    {"object_y", "m", 0.03, 0.32},
    {"object_yaw", "rad", -kPi, kPi},
    {"place_x", "m", 0.44, 0.56},
    {"place_y", "m", -0.34, -0.18},
    {"joint_from_home", "rad", -0.1, 0.1},
    {"tint_of_color", "1", -0.06, 0.06},
    {"table_shade", "1", 0.35, 0.9},
    {"light_azimuth", "rad", -kPi, kPi},
    {"light_elevation", "rad", 0.7, 1.4},
    {"light_strength", "1", 0.35, 0.8},
    {"light_warmth", "1", -0.1, 0.1},
    {"camera_lookat_shift", "m", -0.02, 0.02},
    {"camera_distance_factor", "1", 0.95, 1.05},
    {"camera_angle_shift", "rad", -0.08, 0.08},
};

double drawn(Rng& rng, Drawn what) { return rng.uniform(kRanges[what].lower, kRanges[what].upper); }

struct NamedColor {
  Msg name;
  std::array<double, 3> rgb;
};
constexpr NamedColor kColors[] = {
    {msg::episode_red, {0.82, 0.15, 0.13}},    {msg::episode_orange, {0.93, 0.50, 0.10}},
    {msg::episode_yellow, {0.93, 0.84, 0.15}}, {msg::episode_green, {0.18, 0.62, 0.22}},
    {msg::episode_blue, {0.13, 0.33, 0.82}},   {msg::episode_purple, {0.52, 0.20, 0.68}},
    {msg::episode_white, {0.93, 0.93, 0.93}},  {msg::episode_black, {0.07, 0.07, 0.08}},
};

/// An object of the table and the height of its frame above what it stands on.
struct TableObject {
  const char* body;
  Msg name;
  double height;  // [m]
};
constexpr TableObject kObjects[] = {{"box", msg::episode_box, 0.03},
                                    {"can", msg::episode_can, 0.05},
                                    {"house", msg::episode_house, 0.03}};

/// The text with its `{}` filled in order, in a language that need not be the one in use.
std::string filled(std::string_view pattern, std::string_view first, std::string_view second) {
  std::string out(pattern);
  for (const std::string_view word : {first, second}) {
    if (const std::size_t at = out.find("{}"); at != std::string::npos) out.replace(at, 2, word);
  }
  return out;
}

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

float shade(double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); }

/// Each object gets another colour. @return the colour of the target.
const NamedColor& draw_colors(Rng& rng, DrawnScene& out) {
  std::vector<const NamedColor*> left;
  for (const NamedColor& color : kColors) left.push_back(&color);
  const NamedColor* of_target = left.front();
  for (std::size_t i = 0; i < out.objects.size(); ++i) {
    const std::size_t k = rng.below(left.size());
    const NamedColor* color = std::exchange(left[k], left.back());
    left.pop_back();
    if (i == out.target) of_target = color;
    DrawnObject& object = out.objects[i];
    object.color = color->name.in(Language::english);
    object.rgba[3] = 1;
    for (std::size_t c = 0; c < 3; ++c) object.rgba[c] = shade(color->rgb[c] + drawn(rng, kTint));
    out.looks.geoms.push_back({object.name, object.rgba});
  }
  const auto gray = [&] { return drawn(rng, kTableShade); };
  for (const char* geom : {"table_top", "tray_floor", "fence"}) {
    const double base = gray();
    LooksChange::Geom look{.name = geom};
    for (std::size_t c = 0; c < 3; ++c) look.rgba[c] = shade(base + drawn(rng, kTint));
    out.looks.geoms.push_back(look);
  }
  return *of_target;
}

void draw_light(Rng& rng, DrawnScene& out) {
  const double azimuth = drawn(rng, kLightAzimuth), elevation = drawn(rng, kLightElevation);
  const double strength = drawn(rng, kLightStrength), warmth = drawn(rng, kLightWarmth);
  out.looks.lights.push_back(
      {.name = "key",
       .direction_W = {-std::cos(elevation) * std::cos(azimuth),
                       -std::cos(elevation) * std::sin(azimuth), -std::sin(elevation)},
       .diffuse = {strength * (1 + warmth), strength, strength * (1 - warmth)}});
}

void draw_views(Rng& rng, DrawnScene& out) {
  // Both see the table, the tray and the hand: one from before the arm, one from its side.
  const DrawnView nominal[] = {
      {"front",
       {.lookat_W = {0.42, 0.02, 0.32}, .distance = 1.25, .azimuth = kPi, .elevation = -0.6}},
      {"side",
       {.lookat_W = {0.42, 0.0, 0.3}, .distance = 1.3, .azimuth = -1.9, .elevation = -0.65}}};
  for (DrawnView one : nominal) {
    for (int i = 0; i < 3; ++i) one.view.lookat_W[i] += drawn(rng, kCameraLookat);
    one.view.distance *= drawn(rng, kCameraDistance);
    one.view.azimuth += drawn(rng, kCameraAngle);
    one.view.elevation += drawn(rng, kCameraAngle);
    out.views.push_back(std::move(one));
  }
}

}  // namespace

std::vector<DrawRange> draw_ranges() { return {std::begin(kRanges), std::end(kRanges)}; }

DrawnScene draw_scene(const Robot& robot, const EpisodeOptions& options, std::uint64_t number) {
  Rng rng(options.seed, 2 * number), looks(options.seed, 2 * number + 1);
  DrawnScene out;
  draw_objects(rng, out);
  out.target = rng.below(out.objects.size());
  const double x = drawn(rng, kPlaceX), y = drawn(rng, kPlaceY);
  out.X_WB_place.p = {x, y, kTrayFloor + kObjects[out.target].height};
  for (std::size_t i = 0; i < kTurns; ++i) out.turns.push_back(drawn(rng, kObjectYaw));
  JointVec q = robot.arm.home;
  for (double& value : q) value += drawn(rng, kJoint);
  q = clamp_to_limits(robot.arm, as_span(q));
  out.q.assign(q.data(), q.data() + q.size());

  const NamedColor& color = draw_colors(looks, out);
  draw_light(looks, out);
  draw_views(looks, out);
  const Msg pattern = options.task == "reach" ? msg::episode_reach : msg::episode_put;
  const auto words = [&](Language language) {
    return filled(pattern.in(language), color.name.in(language),
                  kObjects[out.target].name.in(language));
  };
  out.english = words(Language::english);
  out.chinese = words(Language::chinese);
  return out;
}

}  // namespace mjarm::episode
