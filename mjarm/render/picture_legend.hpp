#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mjarm/render/image.hpp"
#include "mjarm/render/overlay.hpp"

namespace mjarm::render {

/// A line of a legend: what is drawn in these colours.
struct LegendEntry {
  std::vector<Rgba> colors = {};  ///< one or a few; more of them are a scale
  std::string text = {};
};

/// A corner of a picture.
struct Corner {
  bool right = false;
  bool top = false;
};
/// Draws a legend into a corner of a picture, on a pale ground; as large as the picture allows.
/// Pictures too small for it stay as they are.
/// @param corner  none = where it hides least of what has a colour.
/// @return the corner; for all pictures of a film.
Corner add_legend(Image& image, std::span<const LegendEntry> entries,
                  std::optional<Corner> corner = {});

}  // namespace mjarm::render
