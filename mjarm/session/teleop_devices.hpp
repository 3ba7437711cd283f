#pragma once

#include <array>
#include <optional>
#include <set>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/session/teleop_desk.hpp"
#include "mjarm/view/controls.hpp"
#include "mjarm/view/device_input.hpp"

namespace mjarm::session {

/// The keys of a window that lead an arm: those that are held move it, with Shift at a quarter of
/// the speed; others act once.
class TeleopKeys {
 public:
  explicit TeleopKeys(TeleopDesk& desk) : desk_(desk) {}
  /// @return whether it is one of them.
  bool handle(const view::KeyInput& input);

 private:
  TeleopDesk& desk_;
  std::set<int> held_;
};
/// The help of a window in which an arm is led: these keys, and those of the window beside them.
[[nodiscard]] std::vector<view::ControlHelp> teleop_help();

/// Leads an arm by a gamepad: left stick forwards and sideways, right stick up and about the
/// vertical, cross and bumpers about the other axes, triggers and A the gripper.
class TeleopGamepad {
 public:
  explicit TeleopGamepad(TeleopDesk& desk) : desk_(desk) {}
  /// @param state  null: there is none.
  void handle(const view::GamepadState* state);

 private:
  TeleopDesk& desk_;
  std::optional<view::GamepadState> last_;
};
/// What a gamepad asks for: nothing within an eighth of the middle of a stick, from there on with
/// the square of its way.
[[nodiscard]] HandInput hand_of(const view::GamepadState& state);

/// A SpaceMouse, by the library libspnav and its daemon, found at run time.
class SpaceMouse {
 public:
  /// @return not_available where the library is not installed or no daemon answers.
  [[nodiscard]] static Result<SpaceMouse> open();
  ~SpaceMouse();
  SpaceMouse(SpaceMouse&& other) noexcept;
  SpaceMouse& operator=(SpaceMouse&&) = delete;

  /// Hands over what was moved and pressed since the last call.
  void poll(TeleopDesk& desk);

 private:
  struct Calls {
    int (*open)() = nullptr;
    int (*close)() = nullptr;
    int (*poll)(void* event) = nullptr;
  };
  explicit SpaceMouse(const Calls& calls) : calls_(calls) {}
  Calls calls_;
};
/// What its six numbers ask for: it moves as the cap is moved, seen from behind the arm's base;
/// full speed at 350.
/// @param moved  x (right), y (up), z (away), and turns about them.
[[nodiscard]] HandInput hand_of_space_mouse(const std::array<int, 6>& moved);

}  // namespace mjarm::session
