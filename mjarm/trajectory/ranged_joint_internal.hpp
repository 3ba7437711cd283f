#pragma once

#include <array>
#include <optional>

#include "mjarm/trajectory/extremal_internal.hpp"
#include "mjarm/trajectory/phases_internal.hpp"

namespace mjarm::detail {

/// How far a joint may go from where it starts [rad or m]: below <= 0 <= above.
struct Room {
  double below = -std::numeric_limits<double>::infinity();
  double above = std::numeric_limits<double>::infinity();

  [[nodiscard]] Room mirrored() const noexcept { return {-above, -below}; }
  [[nodiscard]] bool limited() const noexcept {
    return below > -std::numeric_limits<double>::infinity() ||
           above < std::numeric_limits<double>::infinity();
  }
  /// True where a motion from velocity `v` stays in it, to rounding.
  [[nodiscard]] bool holds(const Phases& motion, double v, double noise) const noexcept;
};

/// How far [rad or m] a state of a joint must leave its room whatever it does, from its velocity
/// and acceleration: full braking is the least it can do. 0 where it can stay.
[[nodiscard]] double overshoot(const OneJoint& joint, const Room& room) noexcept;

/// The end of a move as the start of the way back in time, and the room around it.
[[nodiscard]] OneJoint reversed(const OneJoint& joint) noexcept;
[[nodiscard]] Room reversed(const OneJoint& joint, const Room& room) noexcept;

/// One joint whose motion must stay in its room: where the fastest motions of all, laid over
/// another, leave it, there are others.
/// - A cruise at less than the velocity limit: the fastest change to that velocity, the cruise, the
///   fastest change to that of the end. In the limit of long durations the joint all but rests.
/// - A turn at a limit: it arrives there without velocity, but decelerating; the fastest motions
///   that would leave the room touch its limit there instead.
/// - A stop at either end, and a move from rest to rest between them: possible in all durations
///   from one on. A joint that has room to brake but not to let the deceleration go turns back
///   first.
class RangedJoint {
 public:
  /// @param joint  whose ends do not overshoot the room. @param times  of that joint; both are
  ///               copied.
  RangedJoint(const OneJoint& joint, const JointTimes& times, const Room& room) noexcept;

  /// A motion of that duration [s] in the room, if one is found.
  [[nodiscard]] std::optional<Phases> motion(double duration) const noexcept;
  /// The first duration >= `from` for which one is found; infinity if none is. Looks for turns at
  /// a limit where it has to, which `motion` then knows.
  [[nodiscard]] double first_possible(double from) noexcept;

 private:
  /// A turn at the upper limit (`sign` 1) or the lower one (-1), with the acceleration with which
  /// it is fastest.
  struct Turn {
    double sign, way, a;
    double before, after;  // [s] fastest to it and on from it
  };
  [[nodiscard]] std::optional<Turn> fastest_turn(double sign) const noexcept;
  [[nodiscard]] std::optional<Turn> turn_with(double sign, double way, double a) const noexcept;
  [[nodiscard]] std::optional<Phases> turning(const Turn& turn, double duration) const noexcept;
  [[nodiscard]] std::optional<Phases> blended(double duration) const noexcept;
  [[nodiscard]] std::optional<Phases> cruising(double duration) const noexcept;
  [[nodiscard]] std::optional<Phases> stopping(double duration) const noexcept;
  bool cruise_at(double v, double duration, Phases& out, double& left) const noexcept;
  [[nodiscard]] bool fits(const Phases& motion) const noexcept;
  /// Keeps a motion of that duration, if one is found.
  bool find(double duration) noexcept;

  OneJoint joint_;
  JointTimes times_;
  Room room_;
  std::array<std::optional<Turn>, 2> turns_;
  bool looked_for_turns_ = false;
  Phases found_;                     // what was found last, as it is asked for again
  double found_for_ = -1;            // [s]
  std::optional<Phases> stop_, go_;  // to rest, and from rest to the end
  double stopping_from_;             // [s] first duration with stops; infinity without
};

}  // namespace mjarm::detail
