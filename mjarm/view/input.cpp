#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>

#include "mjarm/view/input_internal.hpp"

namespace mjarm::view {
namespace {

RawInputs& inputs_of(GLFWwindow* window) {
  return *static_cast<RawInputs*>(glfwGetWindowUserPointer(window));
}

bool is_down(GLFWwindow* window, int left_key, int right_key) {
  return glfwGetKey(window, left_key) == GLFW_PRESS || glfwGetKey(window, right_key) == GLFW_PRESS;
}

/// With all that is the same for every kind.
RawInput& add_input(GLFWwindow* window, RawInput::Kind kind) {
  RawInputs& inputs = inputs_of(window);
  RawInput& input = inputs.all.emplace_back();
  input.kind = kind;
  input.time = glfwGetTime();
  input.control = is_down(window, GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
  input.shift = is_down(window, GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
  int width = 0, height = 0, pixels_wide = 0, pixels_high = 0;
  input.x = inputs.x;
  input.y = inputs.y;
  glfwGetWindowSize(window, &width, &height);
  glfwGetFramebufferSize(window, &pixels_wide, &pixels_high);
  if (width > 0 && height > 0) {
    input.x *= static_cast<double>(pixels_wide) / width;
    input.y = pixels_high - input.y * pixels_high / height;
  }
  return input;
}

void on_button(GLFWwindow* window, int button, int action, int modifiers) {
  if (button > GLFW_MOUSE_BUTTON_MIDDLE) return;
  RawInput& input =
      add_input(window, action == GLFW_PRESS ? RawInput::Kind::press : RawInput::Kind::release);
  input.button = button;
  input.control = (modifiers & GLFW_MOD_CONTROL) != 0;
  input.shift = (modifiers & GLFW_MOD_SHIFT) != 0;
}

void on_move(GLFWwindow* window, double x, double y) {
  inputs_of(window).x = x;
  inputs_of(window).y = y;
  add_input(window, RawInput::Kind::move);
}

void on_scroll(GLFWwindow* window, double, double notches) {
  add_input(window, RawInput::Kind::scroll).notches = notches;
}

void on_key(GLFWwindow* window, int key, int, int action, int modifiers) {
  const KeyHook& hook = inputs_of(window).key_hook;
  if (hook && hook({.key = key,
                    .pressed = action != GLFW_RELEASE,
                    .repeat = action == GLFW_REPEAT,
                    .control = (modifiers & GLFW_MOD_CONTROL) != 0,
                    .shift = (modifiers & GLFW_MOD_SHIFT) != 0})) {
    return;
  }
  if (action == GLFW_RELEASE) return;
  // Held down, only the keys that step go on.
  if (action == GLFW_REPEAT && key != GLFW_KEY_RIGHT && key != GLFW_KEY_LEFT) return;
  RawInput& input = add_input(window, RawInput::Kind::key);
  input.key = key;
  input.control = (modifiers & GLFW_MOD_CONTROL) != 0;
  input.shift = (modifiers & GLFW_MOD_SHIFT) != 0;
}

void on_focus(GLFWwindow* window, int focused) {
  const KeyHook& hook = inputs_of(window).key_hook;
  if (hook && focused == GLFW_FALSE) (void)hook({.key = -1, .pressed = false});
}

}  // namespace

void look_at_gamepads(const GamepadHook& hook) {
  for (int id = GLFW_JOYSTICK_1; id <= GLFW_JOYSTICK_LAST; ++id) {
    GLFWgamepadstate raw;
    if (glfwJoystickIsGamepad(id) == GLFW_FALSE || glfwGetGamepadState(id, &raw) == GLFW_FALSE) {
      continue;
    }
    GamepadState state;
    state.name = glfwGetGamepadName(id);
    std::copy(std::begin(raw.axes), std::end(raw.axes), state.axes.begin());
    std::transform(std::begin(raw.buttons), std::end(raw.buttons), state.buttons.begin(),
                   [](unsigned char button) { return button == GLFW_PRESS; });
    hook(&state);
    return;
  }
  hook(nullptr);
}

void gather_inputs(GLFWwindow* window, RawInputs& inputs) {
  // Later it would be where the mouse is by then, and not where it was when a button was pressed.
  glfwGetCursorPos(window, &inputs.x, &inputs.y);
  glfwSetWindowUserPointer(window, &inputs);
  glfwSetMouseButtonCallback(window, on_button);
  glfwSetCursorPosCallback(window, on_move);
  glfwSetScrollCallback(window, on_scroll);
  glfwSetKeyCallback(window, on_key);
  glfwSetWindowFocusCallback(window, on_focus);
}

}  // namespace mjarm::view
