#pragma once

#include <optional>

#include "mjarm/session/free_sim.hpp"
#include "mjarm/session/robot_show.hpp"
#include "mjarm/session/target_control.hpp"
#include "mjarm/view/view_link.hpp"

namespace mjarm::session {

/// A robot to play with: the simulation, and what a window or a page shows of an arm besides. It
/// takes the events of the user and fills the frames that he sees; knows neither window nor clock.
/// One thread at a time uses it, see `simulate_world`.
class RobotSession {
 public:
  /// @param arm  of `model`; none for a model without one, of which the world alone is shown.
  /// @param sim  of `model` and `arm`; outlives this.
  RobotSession(const Model& model, const std::optional<Arm>& arm, FreeSim& sim);

  /// Does what the user asked for, in the panels as in the scene.
  void handle(const view::ViewEvent& event);
  /// Leads the arm where the target was dragged since the last call.
  /// @return false where nothing was dragged.
  bool take_drags();
  [[nodiscard]] int steps_due() { return sim_.steps_due(); }
  void step();
  /// Writes the next frame, and hands over how the target is to be shown.
  void fill(view::ViewFrame& frame);

  /// None without an arm that is held.
  [[nodiscard]] TargetControl* target() noexcept { return target_ ? &*target_ : nullptr; }

 private:
  FreeSim& sim_;
  std::optional<TargetControl> target_;
  std::optional<RobotShow> show_;
};

}  // namespace mjarm::session
