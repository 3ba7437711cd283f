#pragma once

#include <span>
#include <string>
#include <vector>

#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/execution/held_part.hpp"

namespace mjarm::app {

/// How well one part is held, at one time step.
struct HoldVerdict {
  std::string robot = {};
  std::string part = {};
  double timestep = 0;    ///< [s]
  bool own_step = false;  ///< it is that of the scene
  Creep rest = {};        ///< the arm stands
  Creep carried = {};     ///< to and fro, HeldPart::carry()
  /// [m] that it is from the tool a second after it was let go of where nothing has friction, at
  /// the scene's own time step: the control of what is measured.
  double fallen = 0;

  /// It is held: less than 0.1 mm at rest and 0.5 mm carried, and friction does it.
  [[nodiscard]] bool is_good() const;
};

/// How long parts are held.
struct HoldTimes {
  double rest = 60;                                        ///< [s] > 0
  [[nodiscard]] double carry() const { return rest / 6; }  ///< [s]
};

/// Cube, can and prism of the shipped scenes `hold.xml`, held at the time step of robots alone, at
/// that of scenes for picking, and at half of it.
/// @param robot  "ur5e" or "panda"; empty: both.
/// @return an error where the simulation breaks down, or the user stopped it.
[[nodiscard]] Result<std::vector<HoldVerdict>> measure_creep(const std::string& robot,
                                                             const HoldTimes& times);

/// The table in Markdown, without a line break at its end.
[[nodiscard]] std::string creep_table(std::span<const HoldVerdict> verdicts,
                                      const HoldTimes& times);
[[nodiscard]] JsonDoc creep_json(std::span<const HoldVerdict> verdicts);

}  // namespace mjarm::app
