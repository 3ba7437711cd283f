#include "apps/mjarm/view/view_program.hpp"

#include <utility>

#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/session/program_player.hpp"
#include "mjarm/session/simulate_world.hpp"
#include "mjarm/view/remote_window.hpp"

namespace mjarm::app {
namespace {

/// A program that stops at a time of the simulation, as if the user had asked for it.
class ProgramUntil {
 public:
  /// @param seconds  [s] 0 = never.
  ProgramUntil(session::ProgramPlayer& player, double seconds)
      : player_(player), seconds_(seconds) {}

  void handle(const ViewEvent& event) { player_.handle(event); }
  [[nodiscard]] int steps_due() { return player_.steps_due(); }
  void step() {
    player_.step();
    if (!(seconds_ > 0) || player_.sim().time() < seconds_) return;
    player_.handle(PanelEvent{session::kProgramStop, 1});
    seconds_ = 0;
  }
  void fill(ViewFrame& frame) const { player_.fill(frame); }

 private:
  session::ProgramPlayer& player_;
  double seconds_;
};

std::string window_title(const LoadedProgram& loaded) { return "mjarm " + loaded.program.name; }

WindowOptions with_panel(WindowOptions window) {
  window.right_panel = true;
  window.joints_open = false;
  return window;
}

}  // namespace

Result<int> view_program(const std::string& name_or_path, WindowOptions window,
                         const ShowOptions& options) {
  catch_interrupts();
  const Result<LoadedProgram> loaded = load_sound_program(name_or_path);
  if (!loaded) return fail(loaded.error());
  Result<session::ProgramPlayer> player = session::ProgramPlayer::make(*loaded);
  if (!player) return fail(std::move(player.error()));
  if (window.paused) player->handle(PauseEvent{true});
  return show_in_window(loaded->robot.model, window_title(*loaded), with_panel(std::move(window)),
                        options,
                        [&player](ViewLink& link) { session::simulate_world(*player, link); });
}

Result<void> show_program(const LoadedProgram& loaded, double seconds) {
  if (interrupted()) return {};
  Result<session::ProgramPlayer> player = session::ProgramPlayer::make(loaded);
  if (!player) return fail(std::move(player.error()));
  const Result<std::optional<RemoteWindow>> window =
      RemoteWindow::open_where_possible(loaded.robot.model, window_title(loaded), with_panel({}));
  if (!window) return fail(window.error());
  if (!*window) return {};
  log_info(text(msg::demo_close_window));
  player->handle(PanelEvent{session::kProgramRun, 1});
  ProgramUntil world(*player, seconds);
  session::simulate_world(world, (*window)->link());
  return {};
}

}  // namespace mjarm::app
