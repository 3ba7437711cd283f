#pragma once

#include <array>
#include <functional>
#include <string>

namespace mjarm::view {

/// A key of a window that went down or up.
struct KeyInput {
  int key = 0;          ///< as GLFW numbers keys; -1: the window lost the keyboard, all are up
  bool pressed = true;  ///< it is down now
  bool repeat = false;  ///< it was before, and is held
  bool control = false;
  bool shift = false;
};

/// Sees every key first, at once when the window system tells of it, in the main thread.
/// @return true where it uses the key: then the window does not act on it.
using KeyHook = std::function<bool(const KeyInput& input)>;

/// A gamepad as GLFW's table of mappings has it (that of SDL), in the layout of an Xbox pad.
struct GamepadState {
  std::string name;
  /// Left stick x, y (down is positive), right stick x, y, left and right trigger; -1 to 1.
  std::array<double, 6> axes = {};
  /// A, B, X, Y, left and right bumper, back, start, guide, left and right stick, up, right, down,
  /// left.
  std::array<bool, 15> buttons = {};
};

/// Gets the state of the first gamepad whenever the window looks for input; null: there is none.
using GamepadHook = std::function<void(const GamepadState* state)>;

}  // namespace mjarm::view
