#pragma once

#include <string>
#include <vector>

#include "mjarm/execution/execution.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/session/program_panels.hpp"
#include "mjarm/session/program_scene.hpp"
#include "mjarm/sim/sim.hpp"
#include "mjarm/view/playback.hpp"
#include "mjarm/view/thinned_record.hpp"
#include "mjarm/view/view_link.hpp"

namespace mjarm::session {

/// A program in a window: runs it in a simulation as the user asks for, records it, and shows what
/// was. Who looks back changes nothing: the simulation waits meanwhile and goes on from where it
/// stood. Knows no window, and no clock but that of `Playback`.
class ProgramPlayer {
 public:
  /// The arm stands where the program starts.
  /// @param loaded  has no faults; outlives this.
  /// @return an error where the arm's actuators cannot follow the program's control.
  [[nodiscard]] static Result<ProgramPlayer> create(const program::LoadedProgram& loaded);

  /// Does what the user asked for.
  void handle(const view::ViewEvent& event);
  /// Time steps to make now.
  [[nodiscard]] int steps_due();
  /// One time step: of the simulation, or of a replay. A simulation that became unstable begins
  /// anew, and the status says so.
  void step();
  /// What there is to be seen now.
  void fill(view::ViewFrame& frame) const;

  [[nodiscard]] const Sim& sim() const { return sim_; }
  [[nodiscard]] const MotionClock& clock() const { return execution_.clock(); }
  [[nodiscard]] ProgramLook look() const { return look_; }
  [[nodiscard]] ProgramFacts facts() const;
  [[nodiscard]] const ProgramScene::Choice& choice() const { return choice_; }

 private:
  struct Moment {
    Snapshot snapshot;
    std::size_t motion = 0;
    double time = 0;  ///< [s] of the motion
  };

  ProgramPlayer(const program::LoadedProgram& loaded, Execution execution);
  void restart();
  void press(const view::PanelEvent& event);
  void choose(const view::PanelEvent& event);
  void step_moments(int steps);
  void step_simulation();
  void keep();
  void to_present() { look_ = ProgramLook::present; }
  void look_at(double time);
  [[nodiscard]] const Moment& shown() const { return record_.at(record_.nearest(cursor_)); }
  [[nodiscard]] std::string status() const;

  const program::LoadedProgram* loaded_;
  Sim sim_;
  Execution execution_;
  view::Playback playback_;
  view::ThinnedRecord<Moment> record_;  ///< from the first motion on
  ProgramScene scene_;
  ProgramScene::Choice choice_;
  std::vector<std::string> lines_;
  ProgramLook look_ = ProgramLook::present;
  double cursor_ = 0;      ///< [s] of the simulation, where it does not look at the present
  bool unstable_ = false;  ///< the simulation was, and began anew
};

}  // namespace mjarm::session
