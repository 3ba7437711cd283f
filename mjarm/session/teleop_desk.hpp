#pragma once

#include <Eigen/Core>
#include <array>
#include <chrono>
#include <mutex>
#include <optional>
#include <vector>

namespace mjarm::session {

/// What one device asks of an arm, in shares of the full speed, each from -1 to 1.
struct HandInput {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();
  double grip = 0;  ///< 1: the gripper closes; -1: it opens

  [[nodiscard]] bool operator==(const HandInput&) const = default;
};

/// What is asked for once.
enum class TeleopAction {
  gripper,  ///< closes it where it is open, else opens it
  frame,    ///< the other axes
  pause,
  reset,
  record,   ///< begins, pauses and goes on
  redo,     ///< the last seconds once more
  discard,  ///< what was recorded
  keep,     ///< likewise
};

/// What all devices ask for; devices and simulation use it from threads of their own.
class TeleopDesk {
 public:
  enum Device { keys, gamepad, space_mouse, page, devices };
  using Clock = std::chrono::steady_clock;

  /// [s] A page that says nothing for so long has let go: it may be gone.
  static constexpr double kPagePatience = 0.5;

  /// A device asks for this from now on.
  void set(Device device, const HandInput& hand);
  void act(TeleopAction action);

  /// What there is to do.
  struct Taken {
    HandInput hand;  ///< the sum of all, each within -1 and 1
    std::vector<TeleopAction> actions;
    std::optional<Clock::time_point> since;  ///< of the first change since the last call
  };
  [[nodiscard]] Taken take();

 private:
  void changed();

  std::mutex mutex_;
  std::array<HandInput, devices> hands_;
  std::vector<TeleopAction> actions_;
  Clock::time_point heard_;  ///< of the page, the last time
  std::optional<Clock::time_point> since_;
};

}  // namespace mjarm::session
