#include "mjarm/session/teleop_devices.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mjarm/core/messages/teleop.hpp"
#include "mjarm/core/os.hpp"

namespace mjarm::session {
namespace {

/// A key that moves while it is held: axes 0 to 2 along, 3 to 5 about x, y and z.
struct MoveKey {
  int key;  ///< as GLFW numbers keys
  int axis;
  double way;
};
constexpr int kKeyRight = 262, kKeyLeft = 263, kKeyDown = 264, kKeyUp = 265;
constexpr int kKeyLeftShift = 340, kKeyRightShift = 344;
constexpr MoveKey kMoveKeys[] = {{'W', 0, 1},       {'S', 0, -1},     {'A', 1, 1},
                                 {'D', 1, -1},      {'Q', 2, 1},      {'E', 2, -1},
                                 {'J', 3, 1},       {'L', 3, -1},     {kKeyUp, 4, 1},
                                 {kKeyDown, 4, -1}, {kKeyLeft, 5, 1}, {kKeyRight, 5, -1}};

/// A key that acts once, as does a button of a gamepad.
struct ActionKey {
  int key;
  int button;  ///< of GamepadState; -1: none
  TeleopAction action;
};
constexpr ActionKey kActionKeys[] = {
    {' ', 0, TeleopAction::gripper}, {'F', 1, TeleopAction::frame}, {'P', 7, TeleopAction::pause},
    {'R', 3, TeleopAction::record},  {'Z', 2, TeleopAction::redo},  {'X', 6, TeleopAction::discard},
    {'K', 8, TeleopAction::keep}};

constexpr double kSlowShare = 0.25;
constexpr double kDeadZone = 0.125;
constexpr double kFullSpaceMouse = 350;

double of_stick(double value) {
  const double way = std::clamp((std::abs(value) - kDeadZone) / (1 - kDeadZone), 0.0, 1.0);
  return std::copysign(way * way, value);
}

bool is_taken(int key) {
  return std::ranges::any_of(kMoveKeys, [&](const MoveKey& one) { return one.key == key; }) ||
         std::ranges::any_of(kActionKeys, [&](const ActionKey& one) { return one.key == key; });
}

}  // namespace

bool TeleopKeys::handle(const view::KeyInput& input) {
  const bool is_shift = input.key == kKeyLeftShift || input.key == kKeyRightShift;
  if (input.key < 0) held_.clear();
  if (input.key >= 0 && !is_shift) {
    if (!is_taken(input.key) || (input.control && input.pressed)) return false;
    for (const ActionKey& one : kActionKeys) {
      if (one.key == input.key && input.pressed && !input.repeat) desk_.act(one.action);
    }
    if (input.pressed) {
      held_.insert(input.key);
    } else {
      held_.erase(input.key);
    }
  }
  // While Shift itself goes down or up, its flag tells how it was before.
  const bool slow = is_shift ? input.pressed : input.shift;
  HandInput hand;
  for (const MoveKey& one : kMoveKeys) {
    if (!held_.contains(one.key)) continue;
    (one.axis < 3 ? hand.linear : hand.angular)[one.axis % 3] +=
        slow ? kSlowShare * one.way : one.way;
  }
  desk_.set(TeleopDesk::keys, hand);
  return !is_shift;
}

std::vector<view::ControlHelp> teleop_help() {
  std::vector<view::ControlHelp> rows = {
      {"W S", text(msg::teleop_key_x)},
      {"A D", text(msg::teleop_key_y)},
      {"Q E", text(msg::teleop_key_z)},
      {"J L", text(msg::teleop_key_turn_x)},
      {text(msg::teleop_up_down), text(msg::teleop_key_turn_y)},
      {text(msg::teleop_left_right), text(msg::teleop_key_turn_z)},
      {text(msg::teleop_shift), text(msg::teleop_key_slow)},
      {text(msg::teleop_space), text(msg::teleop_key_gripper)},
      {"F", text(msg::teleop_key_frame)},
      {"P", text(msg::teleop_key_pause)},
      {"R", text(msg::teleop_key_record)},
      {"Z", text(msg::teleop_key_redo)},
      {"X", text(msg::teleop_key_discard)},
      {"K", text(msg::teleop_key_keep)}};
  std::vector<int> taken;
  for (const MoveKey& one : kMoveKeys) taken.push_back(one.key);
  for (const ActionKey& one : kActionKeys) taken.push_back(one.key);
  const std::vector<view::ControlHelp> window = view::control_help(taken);
  rows.insert(rows.end(), window.begin(), window.end());
  return rows;
}

HandInput hand_of(const view::GamepadState& state) {
  const auto between = [&](std::size_t plus, std::size_t minus) {
    return (state.buttons[plus] ? 1.0 : 0.0) - (state.buttons[minus] ? 1.0 : 0.0);
  };
  HandInput out;
  out.linear = {-of_stick(state.axes[1]), -of_stick(state.axes[0]), -of_stick(state.axes[3])};
  out.angular = {between(4, 5), between(11, 13), -of_stick(state.axes[2])};
  // Triggers rest at -1.
  out.grip = 0.5 * (state.axes[5] - state.axes[4]);
  if (std::abs(out.grip) < kDeadZone) out.grip = 0;
  return out;
}

void TeleopGamepad::handle(const view::GamepadState* state) {
  desk_.set(TeleopDesk::gamepad, state == nullptr ? HandInput() : hand_of(*state));
  if (state != nullptr && last_) {
    for (const ActionKey& one : kActionKeys) {
      if (one.button < 0) continue;
      const auto at = static_cast<std::size_t>(one.button);
      if (state->buttons[at] && !last_->buttons[at]) desk_.act(one.action);
    }
  }
  last_ = state == nullptr ? std::nullopt : std::optional(*state);
}

HandInput hand_of_space_mouse(const std::array<int, 6>& moved) {
  const auto share = [&](std::size_t i) {
    return std::clamp(moved[i] / kFullSpaceMouse, -1.0, 1.0);
  };
  HandInput out;
  out.linear = {share(2), -share(0), share(1)};
  out.angular = {share(5), -share(3), share(4)};
  return out;
}

Result<SpaceMouse> SpaceMouse::open() {
  Result<void*> library = open_library("libspnav.so.0");
  if (!library) return fail(Errc::not_available, text(msg::teleop_no_spnav));
  Calls calls;
  calls.open = reinterpret_cast<int (*)()>(library_symbol(*library, "spnav_open"));
  calls.close = reinterpret_cast<int (*)()>(library_symbol(*library, "spnav_close"));
  calls.poll = reinterpret_cast<int (*)(void*)>(library_symbol(*library, "spnav_poll_event"));
  const bool complete = calls.open != nullptr && calls.close != nullptr && calls.poll != nullptr;
  if (!complete) return fail(Errc::not_available, text(msg::teleop_no_spnav));
  if (calls.open() < 0) return fail(Errc::not_available, text(msg::teleop_no_spacenavd));
  return SpaceMouse(calls);
}

SpaceMouse::SpaceMouse(SpaceMouse&& other) noexcept : calls_(std::exchange(other.calls_, {})) {}

SpaceMouse::~SpaceMouse() {
  if (calls_.close != nullptr) (void)calls_.close();
}

void SpaceMouse::poll(TeleopDesk& desk) {
  // spnav_event, a union of structs that begin with the kind: 1 = moved, then six numbers; 2 = a
  // button, then whether it is down and its number. Newer kinds are longer.
  constexpr int kMoved = 1, kButton = 2;
  std::array<int, 64> event{};
  while (calls_.poll(event.data()) != 0) {
    if (event[0] == kMoved) {
      desk.set(TeleopDesk::space_mouse,
               hand_of_space_mouse({event[1], event[2], event[3], event[4], event[5], event[6]}));
    } else if (event[0] == kButton && event[1] != 0) {
      desk.act(event[2] == 0 ? TeleopAction::gripper : TeleopAction::frame);
    }
  }
}

}  // namespace mjarm::session
