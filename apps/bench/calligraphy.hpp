#pragma once

#include <functional>
#include <vector>

#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// A sheet that a pen writes on, other than the plan has it.
struct Sheet {
  double tilt = 0;     ///< [rad]
  double payload = 0;  ///< [kg] at the pen, which the controller does not know
};

/// What was written on one, with a force of 1 N.
struct SheetResult {
  Sheet sheet;
  int characters = 0;
  int strokes = 0;
  int missed = 0;      ///< strokes on which the pen met nothing
  double ink_max = 0;  ///< [m] of the pen from where the stroke has it just then, across the pen
  double ink_rms = 0;  ///< [m]
  double least = 0, most = 0;  ///< [N] force on strokes
  double landing = 0;          ///< [N] greatest while the pen comes to rest on the sheet
};

/// Writes the first `count` of a hundred common characters on each sheet, 60 mm high.
/// @param advance  called after each character.
/// @return not_available where their strokes are not installed.
[[nodiscard]] Result<std::vector<SheetResult>> write_characters(
    int count, const std::function<void()>& advance);

/// How many of write_characters() there are, and how many times `advance` is called for each.
inline constexpr int kCharacters = 100;
[[nodiscard]] int sheet_count();

}  // namespace mjarm::app
