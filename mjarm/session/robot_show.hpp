#pragma once

#include <vector>

#include "mjarm/collision/exact.hpp"
#include "mjarm/render/overlay.hpp"
#include "mjarm/render/trail.hpp"
#include "mjarm/session/arm_figures.hpp"
#include "mjarm/session/free_sim.hpp"
#include "mjarm/view/panel_section.hpp"

namespace mjarm::session {

/// What a session draws of an arm beside itself, as far as the user wants it: trail of the tool
/// (on at first), manipulability ellipsoid, contacts, closest pair, figures.
class RobotShow {
 public:
  /// `arm` must come from `model`.
  RobotShow(const Model& model, const Arm& arm);

  /// Does what an item of its panels asks for.
  /// @return false where the item is not of these panels.
  bool handle(const view::PanelEvent& event);
  /// Takes note of where the arm is; call it after each step.
  void add(const FreeSim& sim);
  /// Forgets all that was.
  void clear();

  /// The ghost of the goal is wanted at all times.
  [[nodiscard]] bool wants_ghost() const noexcept { return ghost_; }
  void add_sections(std::vector<view::PanelSection>& sections) const;
  void add_overlay(render::Overlay& overlay, const FreeSim& sim);
  [[nodiscard]] std::vector<view::LivePlot> plots() const { return figures_.plots(); }

 private:
  void add_contact(render::Overlay& overlay, const JointVec& q);

  Arm arm_;
  ExactChecker checker_;
  render::Trail trail_;
  ArmFigures figures_;
  bool ghost_ = false;
  bool ellipsoid_ = false;
  bool contacts_ = false;
  bool nearest_ = false;
  int trail_look_ = 1;  ///< off, line, balls
};

}  // namespace mjarm::session
