#pragma once

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

/// Draws a legend into the lower left corner of a picture, on a pale ground; as large as the
/// picture allows. Pictures too small for it stay as they are.
void add_legend(Image& image, std::span<const LegendEntry> entries);

}  // namespace mjarm::render
