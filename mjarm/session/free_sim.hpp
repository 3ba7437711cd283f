#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mjarm/control/controller.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/sim/sim.hpp"
#include "mjarm/view/events.hpp"
#include "mjarm/view/history.hpp"
#include "mjarm/view/playback.hpp"

namespace mjarm::session {

/// A simulation without a plan: the arm, where there is one, stands where the user puts it, and all
/// that he does in a window acts on it. Knows no window and no clock of its own.
class FreeSim {
 public:
  /// @param arm      is held against gravity, and what Sim::hold_others() keeps with it; none = all
  ///                 actuators stay at 0.
  /// @param passive  nothing is held.
  /// @return not_available where the arm's actuators cannot hold it; `passive` never fails.
  [[nodiscard]] static Result<FreeSim> create(const Model& model, const std::optional<Arm>& arm,
                                              bool passive);

  /// Does what the user asked for.
  void handle(const view::ViewEvent& event);
  /// Steps to run now.
  [[nodiscard]] int steps_due() { return playback_.steps_due(); }
  /// One step of the simulation. One that became unstable begins anew, and `status` says so.
  void step();
  /// Back to the beginning.
  void reset();

  [[nodiscard]] const Sim& sim() const { return sim_; }
  [[nodiscard]] const view::Playback& playback() const { return playback_; }
  /// One line for the window, ASCII; empty = nothing to say.
  [[nodiscard]] std::string status() const;
  /// True where an arm is held, which goes where it is sent.
  [[nodiscard]] bool is_held() const noexcept { return controller_.has_value(); }
  /// Where the held arm goes, shape (dof,) [rad or m].
  [[nodiscard]] const JointVec& goal() const noexcept { return q_goal_; }
  /// Sends it to `q`, shape (dof,) [rad or m], clamped to its limits; nothing where it is not held.
  void set_goal(const JointVec& q);
  /// Where the held arm should be now on its way, shape (dof,) [rad or m].
  [[nodiscard]] const JointVec& reference() const noexcept { return q_now_; }
  /// Dofs that a slider can move.
  [[nodiscard]] std::vector<int> jog_dofs() const;

 private:
  /// All that decides what comes next.
  struct Moment {
    Snapshot snapshot;
    JointVec q_before, q_now, q_goal;
  };
  FreeSim(const Model& model, std::optional<Arm> arm, std::optional<Controller> controller);
  void go_to(const Moment& moment);
  void remember();
  void jog(const view::JointEvent& event);
  /// The next position on the way to the goal: as a spring without overshoot, no faster than half
  /// the joint's limit.
  [[nodiscard]] JointVec next_reference() const;

  Sim sim_;
  std::optional<Arm> arm_;
  std::optional<Controller> controller_;
  view::Playback playback_;
  view::History<Moment> history_;
  std::vector<double> ctrl_;
  JointVec q_before_, q_now_, q_goal_;
  bool unstable_ = false;  ///< it was, and began anew
};

}  // namespace mjarm::session
