#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/messages.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/episode/draw_scene.hpp"

// What the scenes of all tasks draw in the same way.
namespace mjarm::episode {

/// A number of a range.
[[nodiscard]] double drawn(Rng& rng, const DrawRange& range);

inline constexpr DrawRange kJointFromHome{"joint_from_home", "rad", -0.1, 0.1};
/// Ranges of looks, in dataset.json behind those of a task itself.
[[nodiscard]] std::vector<DrawRange> with_looks_ranges(std::vector<DrawRange> of_task);

/// Draws where the arm stands: near its home.
void draw_start(Rng& rng, const Arm& arm, DrawnScene& out);

/// A colour that can be asked for.
struct NamedColor {
  Msg name;
  std::array<double, 3> rgb;
};
/// Eight colours, of which each is drawn at most once.
class ColorBox {
 public:
  ColorBox();
  [[nodiscard]] const NamedColor& take(Rng& rng);

 private:
  std::vector<const NamedColor*> left_;
};
/// Gives an object that colour, each part of it a little off.
/// @param part  what the geom that shows it is named behind the object's name.
void paint(Rng& rng, const NamedColor& color, DrawnObject& object, LooksChange& looks,
           const char* part = "");
/// Each object gets another colour. @return the colour of the target.
const NamedColor& paint_all(Rng& rng, DrawnScene& out, const char* part = "");
/// Each geom gets a gray of its own.
void draw_grays(Rng& rng, std::span<const char* const> geoms, DrawnScene& out);
void draw_light(Rng& rng, DrawnScene& out);
/// Cameras near to these.
void draw_views(Rng& rng, std::span<const DrawnView> nominal, DrawnScene& out);

/// The text with its `{}` filled in order, in a language that need not be the one in use.
[[nodiscard]] std::string filled(std::string_view pattern, const std::vector<std::string>& words);
/// The task in words of both languages.
/// @param words  of a language, for the pattern's `{}`: a list of strings.
template <class Words>
void tell_task(Msg pattern, const Words& words, DrawnScene& out) {
  out.english = filled(pattern.in(Language::english), words(Language::english));
  out.chinese = filled(pattern.in(Language::chinese), words(Language::chinese));
}

}  // namespace mjarm::episode
