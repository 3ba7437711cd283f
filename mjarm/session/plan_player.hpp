#pragma once

#include <optional>
#include <vector>

#include "mjarm/session/plan_drawing.hpp"
#include "mjarm/sim/sim.hpp"
#include "mjarm/view/playback.hpp"
#include "mjarm/view/view_link.hpp"

namespace mjarm::session {

/// Numbers of the items in the panel of a planned path.
enum PlanItem {
  kPlanTime,
  kPlanTightest,
  kPlanSpheres,
  kPlanPair,
  kPlanPath,
  kPlanTree,
  kPlanEnds,
  kPlanCorners,
  kPlanText,
};

/// A planned path in a window: the arm goes along it back and forth, without physics, and what it
/// keeps clear of is shown as it goes. Knows no window, and no clock but that of `Playback`.
class PlanPlayer {
 public:
  /// @param subject, drawing  of the same path; outlive this.
  PlanPlayer(const PlanSubject& subject, PlanDrawing& drawing);

  /// Does what the user asked for.
  void handle(const view::ViewEvent& event);
  /// Time steps to make now.
  [[nodiscard]] int steps_due() { return playback_.steps_due(); }
  void step();
  /// What there is to be seen now.
  void fill(view::ViewFrame& frame);

  /// Where it is [rad or m, L2 along the path].
  [[nodiscard]] double place() const { return place_; }
  [[nodiscard]] const PlanLayers& layers() const { return layers_; }

 private:
  void press(const view::PanelEvent& event);
  void go(double ways);
  [[nodiscard]] std::vector<view::PanelSection> panels(const PlanLook& look) const;

  const PlanSubject* subject_;
  PlanDrawing* drawing_;
  Sim sim_;
  view::Playback playback_;
  PlanLayers layers_;
  double place_ = 0;
  bool back_ = false;
};

}  // namespace mjarm::session
