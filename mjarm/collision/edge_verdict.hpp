#pragma once

namespace mjarm {

/// What is known of a straight edge between two configurations.
enum class EdgeVerdict {
  free,       ///< proved: no configuration of the edge is in collision
  hit,        ///< some configuration is
  outside,    ///< an end is outside of the limits, or no number
  undecided,  ///< neither proved nor refuted: too near for the resolution, or too much work
};

}  // namespace mjarm
