#pragma once

#include <optional>

namespace mjarm::view {

/// How well a window keeps up.
struct ViewStats {
  long frames = 0;
  double fps = 0;             ///< [1/s] mean from the first frame to the last
  double frame_ms = 0;        ///< [ms] mean time one frame took to draw
  double first_frame_ms = 0;  ///< [ms] from the opening of the window to its first frame
  double sim_rate = 0;        ///< simulated seconds a second, while not paused; 0 = never ran
};

/// Counts the frames of a window.
class FrameCounter {
 public:
  /// @param opened [s] when the window began to open, on the clock of the frames.
  explicit FrameCounter(double opened) : opened_(opened) {}

  /// A frame that was drawn from `begin` to `end` [s], showing `sim_time` [s].
  void add(double begin, double end, double sim_time, bool paused);
  [[nodiscard]] ViewStats stats() const;

 private:
  struct Frame {
    double end;
    double sim_time;
    bool paused;
  };
  double opened_;
  long frames_ = 0;
  double first_end_ = 0;
  double drawing_ = 0;  ///< [s] spent in all frames
  double sim_ = 0;      ///< [s] simulated and shown while not paused
  double wall_ = 0;     ///< [s] of the clock while not paused
  std::optional<Frame> last_;
};

}  // namespace mjarm::view
