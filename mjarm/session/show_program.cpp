#include "mjarm/session/show_program.hpp"

#include <utility>

#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/show.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/session/program_player.hpp"
#include "mjarm/session/simulate_world.hpp"
#include "mjarm/view/remote_window.hpp"

namespace mjarm::session {
namespace {

/// A program that stops at a time of the simulation, as if the user had asked for it.
class ProgramUntil {
 public:
  /// @param seconds  [s] 0 = never.
  ProgramUntil(ProgramPlayer& player, double seconds) : player_(player), seconds_(seconds) {}

  void handle(const view::ViewEvent& event) { player_.handle(event); }
  [[nodiscard]] int steps_due() { return player_.steps_due(); }
  void step() {
    player_.step();
    if (!(seconds_ > 0) || player_.sim().time() < seconds_) return;
    player_.handle(view::PanelEvent{kProgramStop, 1});
    seconds_ = 0;
  }
  void fill(view::ViewFrame& frame) const { player_.fill(frame); }

 private:
  ProgramPlayer& player_;
  double seconds_;
};

std::string window_title(const program::LoadedProgram& loaded) {
  return "mjarm " + loaded.program.name;
}

view::WindowOptions with_panel(view::WindowOptions window) {
  window.right_panel = true;
  window.joints_open = false;
  return window;
}

}  // namespace

Result<view::ViewStats> view_program(const program::LoadedProgram& loaded,
                                     view::WindowOptions window, const view::ShowOptions& options) {
  Result<ProgramPlayer> player = ProgramPlayer::create(loaded);
  if (!player) return fail(std::move(player.error()));
  if (window.paused) player->handle(view::PauseEvent{true});
  return view::show_in_window(loaded.robot.model, window_title(loaded),
                              with_panel(std::move(window)), options,
                              [&player](view::ViewLink& link) { simulate_world(*player, link); });
}

Result<void> show_program(const program::LoadedProgram& loaded, double seconds) {
  if (interrupted()) return {};
  Result<ProgramPlayer> player = ProgramPlayer::create(loaded);
  if (!player) return fail(std::move(player.error()));
  const Result<std::optional<view::RemoteWindow>> window = view::RemoteWindow::open_where_possible(
      loaded.robot.model, window_title(loaded), with_panel({}));
  if (!window) return fail(window.error());
  if (!*window) return {};
  log_info(text(msg::show_close_window));
  player->handle(view::PanelEvent{kProgramRun, 1});
  ProgramUntil world(*player, seconds);
  simulate_world(world, (*window)->link());
  return {};
}

}  // namespace mjarm::session
