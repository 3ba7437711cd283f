#pragma once

#include <optional>

#include "apps/mjarm/view/robot_show.hpp"
#include "apps/mjarm/view/target_control.hpp"
#include "apps/mjarm/view/view_sim.hpp"
#include "mjarm/view/view_link.hpp"

namespace mjarm::app {

/// `mjarm view ROBOT`: the simulation, and what its window adds for an arm. In a thread of its own;
/// neither it nor the window waits for the other.
class RobotView {
 public:
  /// @param sim  of `model` and `arm`; outlives this.
  RobotView(const Model& model, const std::optional<Arm>& arm, ViewSim& sim);

  /// What `simulate_world` calls, in its order.
  void handle(const ViewEvent& event);
  /// @return false where nothing was dragged.
  bool take_drags();
  [[nodiscard]] int steps_due() { return sim_.steps_due(); }
  void step();
  /// Writes the next frame, and hands over how the target is to be shown.
  void fill(ViewFrame& frame);

  /// None without an arm that is held.
  [[nodiscard]] TargetControl* target() noexcept { return target_ ? &*target_ : nullptr; }

 private:
  ViewSim& sim_;
  std::optional<TargetControl> target_;
  std::optional<RobotShow> show_;
};

}  // namespace mjarm::app
