#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "apps/bench/pick.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// A placement of an object that gave no pose, or a wrong one.
struct SeenFault {
  std::uint64_t placement = 0;
  std::string what;  ///< one line for people
};

/// How well one object is seen over many placements, known in one way, at one noise of depth. All
/// errors are up to its symmetry where it is known by its shape, and against the simulation.
struct SeenErrors {
  std::string object;
  bool by_tag = false;
  double depth_sigma = 0;             ///< [m] of depth 0.5 m away
  int placements = 0;                 ///< in which it was there
  std::vector<double> position = {};  ///< [m] of each pose that was given
  std::vector<double> rotation = {};  ///< [rad] likewise
  std::vector<SeenFault> wrong =
      {};  ///< poses off by more than the goal, or of nothing that is there
  std::vector<SeenFault> missed = {};

  [[nodiscard]] double position_goal() const { return by_tag ? 2e-3 : 3e-3; }  // [m]
  [[nodiscard]] double rotation_goal() const;                                  // [rad]
};

/// Looks at the shipped scene `scenes/look_table.xml`: box, can and step so often each, with the
/// camera's noise and without; the box also by its tag where AprilTag is built in.
/// @return an error where the camera cannot draw, or the user stopped it.
[[nodiscard]] Result<std::vector<SeenErrors>> measure_seen(const SceneNumbers& placements,
                                                           std::uint64_t seed);

/// The table and what is below it, in Markdown, without a line break at its end.
[[nodiscard]] std::string seen_table(std::span<const SeenErrors> errors);
[[nodiscard]] JsonDoc seen_json(std::span<const SeenErrors> errors);

}  // namespace mjarm::app
