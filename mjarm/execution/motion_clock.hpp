#pragma once

#include <cstddef>
#include <optional>

#include "mjarm/control/reference.hpp"
#include "mjarm/execution/motion_plan.hpp"

namespace mjarm {

/// [s] The reference rests for so long at the end of a plan, so that the arm does as well.
inline constexpr double kRestAtEnd = 0.5;

/// The time of a plan: goes along its motions, step by step of a simulation, and can be stopped
/// anywhere: it is slowed down to rest within `kBrakeSteps`, and taken up again in the same way, so
/// the arm stays on its path and neither its place nor its speed ever jumps. Where nobody stops,
/// each motion that begins at rest is met on its own grid of time steps. Knows no simulation.
class MotionClock {
 public:
  enum class State {
    ready,     ///< nothing was begun
    running,   ///< on its way, to the end of this motion or of all
    stopping,  ///< comes to rest
    stopped,   ///< at rest on the way, or between two motions
    done,      ///< at rest at the end of all motions
  };
  /// Steps in which it comes to rest.
  static constexpr int kBrakeSteps = 250;

  /// @param plan         outlives this.
  /// @param timestep     [s] > 0.
  /// @param rest_at_end  [s] >= 0
  MotionClock(const MotionPlan& plan, double timestep, double rest_at_end = kRestAtEnd);

  /// Goes on to the end of all motions.
  void run();
  /// Goes on to the end of the current motion; of one that passes, to where the arm next stops.
  void run_one();
  void stop();
  /// The same as fast as `limits` allow: in the fewest steps, at most kBrakeSteps, in which no
  /// joint is accelerated or jerked beyond them; where the motion itself needs all its jerk just
  /// then, up to 1.25 of that.
  void brake(const JointLimits& limits);
  /// Is back at the start.
  void restart();

  /// What the arm shall do in one step.
  struct Step {
    StepReference reference;
    std::size_t motion = 0;          ///< whose step it is; where it stands, as motion()
    bool moves = false;              ///< along that motion; else the arm is held where it is
    bool begins = false;             ///< it is the first one of that motion
    bool passes = false;             ///< and the motion before was passed without a stop
    bool ends = false;               ///< it is the last one
    bool waits = false;              ///< the plan waits: what was begun last goes on at its end
    std::optional<bool> close = {};  ///< the gripper closes or opens at its beginning
  };
  /// The step that comes.
  [[nodiscard]] Step next();

  [[nodiscard]] State state() const noexcept;
  /// Index of the current motion, the next one where it stands between two; that of no motion once
  /// all is done.
  [[nodiscard]] std::size_t motion() const noexcept { return motion_; }
  /// [s] of the current motion that are over.
  [[nodiscard]] double time() const noexcept { return at_ * timestep_; }
  /// Where the arm should be now, (dof,) [rad or m].
  [[nodiscard]] const JointVec& q_ref() const noexcept { return now_; }
  /// Steps that a motion takes where nobody stops; the last one rests at its end. Whole but where a
  /// motion passes.
  [[nodiscard]] double steps_of(std::size_t motion) const;
  /// [s] of all motions.
  [[nodiscard]] double duration() const;

 private:
  [[nodiscard]] bool is_moving() const noexcept;
  void set_out(bool one);
  /// Whether it comes to rest within that many steps without breaking `limits`.
  [[nodiscard]] bool keeps(const JointLimits& limits, int brake) const;
  void begin_motion(Step& step);
  void end_motion();
  void pass_on(Step& step);

  const MotionPlan* plan_;
  double timestep_;
  double rest_at_end_;
  std::size_t motion_ = 0;
  double at_ = 0;  ///< [steps] of the current motion; whole where nobody stopped or passed
  int brake_ = kBrakeSteps;  ///< steps from full speed to rest
  int pace_ = 0;             ///< from 0 at rest to brake_ at full speed
  bool going_ = false;       ///< the user wants it to move
  bool one_ = false;         ///< to the end of this motion only
  bool begun_ = false;
  JointVec before_, now_;
};

}  // namespace mjarm
