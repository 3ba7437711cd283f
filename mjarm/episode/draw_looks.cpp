#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mjarm/core/messages/episode.hpp"
#include "mjarm/episode/draw_looks_internal.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm::episode {
namespace {

constexpr DrawRange kTint{"tint_of_color", "1", -0.06, 0.06};
constexpr DrawRange kTableShade{"table_shade", "1", 0.35, 0.9};
constexpr DrawRange kLightAzimuth{"light_azimuth", "rad", -std::numbers::pi, std::numbers::pi};
constexpr DrawRange kLightElevation{"light_elevation", "rad", 0.7, 1.4};
constexpr DrawRange kLightStrength{"light_strength", "1", 0.35, 0.8};
constexpr DrawRange kLightWarmth{"light_warmth", "1", -0.1, 0.1};
constexpr DrawRange kCameraLookat{"camera_lookat_shift", "m", -0.02, 0.02};
constexpr DrawRange kCameraDistance{"camera_distance_factor", "1", 0.95, 1.05};
constexpr DrawRange kCameraAngle{"camera_angle_shift", "rad", -0.08, 0.08};

constexpr NamedColor kColors[] = {
    {msg::episode_red, {0.82, 0.15, 0.13}},    {msg::episode_orange, {0.93, 0.50, 0.10}},
    {msg::episode_yellow, {0.93, 0.84, 0.15}}, {msg::episode_green, {0.18, 0.62, 0.22}},
    {msg::episode_blue, {0.13, 0.33, 0.82}},   {msg::episode_purple, {0.52, 0.20, 0.68}},
    {msg::episode_white, {0.93, 0.93, 0.93}},  {msg::episode_black, {0.07, 0.07, 0.08}},
};

float shade(double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); }

}  // namespace

double drawn(Rng& rng, const DrawRange& range) { return rng.uniform(range.lower, range.upper); }

std::vector<DrawRange> with_looks_ranges(std::vector<DrawRange> of_task) {
  of_task.insert(of_task.end(),
                 {kJointFromHome, kTint, kTableShade, kLightAzimuth, kLightElevation,
                  kLightStrength, kLightWarmth, kCameraLookat, kCameraDistance, kCameraAngle});
  return of_task;
}

void draw_start(Rng& rng, const Arm& arm, DrawnScene& out) {
  JointVec q = arm.home;
  for (double& value : q) value += drawn(rng, kJointFromHome);
  q = clamp_to_limits(arm, as_span(q));
  out.q.assign(q.data(), q.data() + q.size());
}

ColorBox::ColorBox() {
  for (const NamedColor& color : kColors) left_.push_back(&color);
}

const NamedColor& ColorBox::take(Rng& rng) {
  const std::size_t k = rng.below(left_.size());
  const NamedColor* color = std::exchange(left_[k], left_.back());
  left_.pop_back();
  return *color;
}

void paint(Rng& rng, const NamedColor& color, DrawnObject& object, LooksChange& looks,
           const char* part) {
  object.color = color.name.in(Language::english);
  object.rgba = {0, 0, 0, 1};
  for (std::size_t c = 0; c < 3; ++c) object.rgba[c] = shade(color.rgb[c] + drawn(rng, kTint));
  looks.geoms.push_back({object.name + part, object.rgba});
}

const NamedColor& paint_all(Rng& rng, DrawnScene& out, const char* part) {
  ColorBox box;
  const NamedColor* of_target = nullptr;
  for (std::size_t i = 0; i < out.objects.size(); ++i) {
    const NamedColor& color = box.take(rng);
    if (i == out.target) of_target = &color;
    paint(rng, color, out.objects[i], out.looks, part);
  }
  return *of_target;
}

void draw_grays(Rng& rng, std::span<const char* const> geoms, DrawnScene& out) {
  for (const char* geom : geoms) {
    const double base = drawn(rng, kTableShade);
    LooksChange::Geom look{.name = geom};
    for (std::size_t c = 0; c < 3; ++c) look.rgba[c] = shade(base + drawn(rng, kTint));
    out.looks.geoms.push_back(look);
  }
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

void draw_views(Rng& rng, std::span<const DrawnView> nominal, DrawnScene& out) {
  for (DrawnView one : nominal) {
    for (int i = 0; i < 3; ++i) one.view.lookat_W[i] += drawn(rng, kCameraLookat);
    one.view.distance *= drawn(rng, kCameraDistance);
    one.view.azimuth += drawn(rng, kCameraAngle);
    one.view.elevation += drawn(rng, kCameraAngle);
    out.views.push_back(std::move(one));
  }
}

std::string filled(std::string_view pattern, const std::vector<std::string>& words) {
  std::string out(pattern);
  for (const std::string& word : words) {
    if (const std::size_t at = out.find("{}"); at != std::string::npos) out.replace(at, 2, word);
  }
  return out;
}

}  // namespace mjarm::episode
