#pragma once

#include <vector>

#include "mjarm/view/device_input.hpp"

struct GLFWwindow;

namespace mjarm::view {

/// Something a user did, as the window system told it, with the mouse in pixels of the window's
/// picture, from its lower left.
struct RawInput {
  enum class Kind { press, release, move, scroll, key };
  Kind kind = Kind::move;
  double x = 0;
  double y = 0;
  double notches = 0;  ///< of the wheel, away from the user
  int button = 0;      ///< 0 = left, 1 = right, 2 = middle
  int key = 0;         ///< as GLFW numbers them
  bool control = false;
  bool shift = false;
  double time = 0;  ///< [s] when it was told
};

/// What happened in a window and was not acted on yet.
struct RawInputs {
  std::vector<RawInput> all = {};
  double x = 0;  ///< [screen units] where the mouse was told to be last, from the upper left
  double y = 0;
  KeyHook key_hook = {};  ///< is asked first, at once
};
/// Lets everything that happens in `window` gather in `inputs`, which outlives it. They are acted
/// on later, when OpenGL can be used.
void gather_inputs(GLFWwindow* window, RawInputs& inputs);

/// Tells `hook` of the first gamepad.
void look_at_gamepads(const GamepadHook& hook);

}  // namespace mjarm::view
