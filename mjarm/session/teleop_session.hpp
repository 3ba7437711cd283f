#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mjarm/episode/led_episode.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/session/teleop_desk.hpp"
#include "mjarm/session/teleop_devices.hpp"
#include "mjarm/sim/sim.hpp"
#include "mjarm/teleop/input_file.hpp"
#include "mjarm/teleop/teleop.hpp"
#include "mjarm/view/playback.hpp"
#include "mjarm/view/view_link.hpp"

namespace mjarm::session {

/// How an arm is led in a session. Every default is usable as is.
struct TeleopSessionOptions {
  TeleopOptions teleop = {};
  TwistFrame frame = TwistFrame::world;
  int fps = 20;  ///< [1/s] rows of a recording, 1 to 100
  /// Keeps a recording. @return where, for people. Empty: nothing can be recorded.
  std::function<Result<std::string>(const std::vector<episode::LedSample>& rows)> keep = {};
};

/// How long it took from what a user did until the arm's commands were written.
struct TeleopLatency {
  std::size_t count = 0;
  double mean = 0, p99 = 0, max = 0;  ///< [s]
};

/// A robot that somebody leads: what a window or a page shows of it, and what it does; knows
/// neither of them. One thread at a time uses it, but for its desk; see `simulate_world`.
class TeleopSession {
 public:
  static constexpr double kRedo = 3;  ///< [s] that TeleopAction::redo goes back

  /// @return Teleop::create()'s errors.
  [[nodiscard]] static Result<TeleopSession> create(const Robot& robot,
                                                    TeleopSessionOptions options = {});

  /// What devices ask for.
  [[nodiscard]] TeleopDesk& desk() noexcept { return *desk_; }
  /// Asked before every period.
  void set_space_mouse(SpaceMouse mouse) { space_mouse_.emplace(std::move(mouse)); }

  void handle(const view::ViewEvent& event);
  [[nodiscard]] int steps_due();
  /// One period of control.
  void step();
  void fill(view::ViewFrame& frame);

  [[nodiscard]] const Sim& sim() const noexcept { return sim_; }
  [[nodiscard]] TeleopState state() const { return teleop_.state(); }
  [[nodiscard]] TwistFrame frame() const noexcept { return frame_; }
  [[nodiscard]] double period() const noexcept { return teleop_.period(); }  ///< [s]
  [[nodiscard]] TeleopLatency latency() const;
  /// All that was asked for so far, of at most an hour; after a redo without what was done again.
  [[nodiscard]] const std::vector<TimedInput>& inputs() const noexcept { return inputs_; }
  /// Recorded and not yet kept [s].
  [[nodiscard]] double recorded() const;

 private:
  /// What can be gone back to.
  struct Past {
    TeleopMoment moment;
    double close_to = 0;
  };
  enum class Tape { empty, running, resting };

  TeleopSession(const Robot& robot, TeleopSessionOptions options, Teleop teleop);
  void act(TeleopAction action);
  void reset();
  void redo();
  void keep();
  void record();
  void remember(const TeleopInput& input);
  [[nodiscard]] std::string status() const;
  [[nodiscard]] view::PanelSection section() const;
  [[nodiscard]] view::PanelSection record_section() const;

  Robot robot_;
  TeleopSessionOptions options_;
  Teleop teleop_;
  Sim sim_;
  std::unique_ptr<TeleopDesk> desk_;
  std::optional<SpaceMouse> space_mouse_;
  view::Playback playback_;
  TwistFrame frame_;
  double close_to_ = 0;  ///< where the gripper goes
  std::deque<Past> past_;
  std::vector<TimedInput> inputs_;
  Tape tape_ = Tape::empty;
  std::vector<episode::LedSample> rows_;
  double next_row_ = 0;  ///< [s]
  std::string said_;     ///< what came of the last action
  std::vector<double> latencies_;
};

}  // namespace mjarm::session
