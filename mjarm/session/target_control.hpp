#pragma once

#include <string>
#include <vector>

#include "mjarm/path/tool_target.hpp"
#include "mjarm/session/free_sim.hpp"
#include "mjarm/view/panel_section.hpp"
#include "mjarm/view/target_link.hpp"

namespace mjarm::session {

/// Green, amber (near a limit or a singularity, a jump), red.
[[nodiscard]] render::Rgba color_of(TargetGrade grade) noexcept;

/// The target of the tool in a session: dragged by its handles, jogged by buttons; the arm of
/// the simulation follows it. In the thread of the simulation.
class TargetControl {
 public:
  /// @param sim  holds `arm` (`FreeSim::is_held`) and outlives this.
  TargetControl(const Model& model, const Arm& arm, FreeSim& sim);

  /// Does what an item of its panels asks for.
  /// @return false where the item is not of these panels.
  bool handle(const view::PanelEvent& event);
  /// Shows the target, or puts it away.
  void toggle();
  /// Follows the mouse.
  /// @return false where it did nothing.
  bool take_drags();
  /// Follows the arm where something else sent it somewhere, as a joint's slider.
  void follow_sim();
  /// The target is where the arm goes.
  void restart();

  [[nodiscard]] const ToolTarget& target() const noexcept { return target_; }
  [[nodiscard]] view::TargetLink& link() noexcept { return link_; }
  /// Hands the state to the window.
  void post_look();
  void add_sections(std::vector<view::PanelSection>& sections) const;
  /// Appends the robot as it would stand, in the colour of the target's state: while the target is
  /// dragged, while the arm is not sent there, or `always`; and, where they are shown, the other
  /// postures, each of which a click takes.
  void add_ghost(render::Overlay& overlay, bool always) const;
  /// One line in the language in use; empty while the target is not shown.
  [[nodiscard]] std::string line() const;

 private:
  void jog(int button);
  void changed();
  void send();
  /// Looks for the postures anew, where they are shown and the target is another one.
  void find_postures();
  [[nodiscard]] view::PanelSection target_section() const;
  [[nodiscard]] view::PanelSection posture_section() const;
  [[nodiscard]] view::PanelSection tool_section() const;

  FreeSim& sim_;
  ToolTarget target_;
  view::TargetLink link_;
  JointVec sent_;                   ///< the goal of the simulation as it was last seen
  std::vector<JointVec> postures_;  ///< that reach the target, where they are shown
  bool shows_postures_ = false;
  bool shown_ = true;
  bool follow_ = true;
  bool held_ = false;  ///< the mouse holds a handle
  long number_ = 0;    ///< of the last drag
  int frame_ = 0;      ///< of JogFrame
  int move_step_ = 1;  ///< of kMoveSteps
  int turn_step_ = 1;  ///< of kTurnSteps
};

}  // namespace mjarm::session
