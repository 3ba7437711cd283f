#include "apps/mjarm/view_program.hpp"

#include <filesystem>
#include <utility>

#include "apps/mjarm/program_player.hpp"
#include "mjarm/core/os.hpp"

namespace mjarm::app {

bool is_program(const std::string& name_or_path) {
  const std::filesystem::path extension = std::filesystem::path(name_or_path).extension();
  if (extension == ".yaml" || extension == ".yml") return true;
  return !find_model_file(name_or_path) && find_program_file(name_or_path).has_value();
}

Result<int> view_program(const std::string& name_or_path, WindowOptions window,
                         const ShowOptions& options) {
  catch_interrupts();
  const Result<LoadedProgram> loaded = load_program(name_or_path);
  if (!loaded) return fail(loaded.error());
  if (!loaded->plan.ok()) return fail(first_fault(*loaded));
  Result<ProgramPlayer> player = ProgramPlayer::make(*loaded);
  if (!player) return fail(std::move(player.error()));
  if (window.paused) player->handle(PauseEvent{true});
  window.right_panel = true;
  window.joints_open = false;
  return show_in_window(loaded->robot.model, "mjarm " + loaded->program.name, window, options,
                        [&player](ViewLink& link) { simulate_world(*player, link); });
}

}  // namespace mjarm::app
