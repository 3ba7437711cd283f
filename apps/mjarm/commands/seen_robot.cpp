#include "apps/mjarm/commands/seen_robot.hpp"

#include <utility>

#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/commands/render_options.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/view.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/session/see_scene.hpp"

namespace mjarm::app {

Result<SeenRobot> load_seen_robot(const RobotChoice& choice, Msg which) {
  if (choice.robot.empty()) return fail(Errc::usage, text(which));
  Result<Model> model = load_model(choice);
  if (!model) return fail(std::move(model.error()));
  tell_warnings(*model);
  Result<Arm> arm = find_arm(*model, {.tip = choice.tip});
  if (!arm && !choice.tip.empty()) return fail(std::move(arm.error()));
  SeenRobot seen{std::move(*model), std::nullopt};
  if (arm) seen.arm = std::move(*arm);
  return seen;
}

Result<program::LoadedProgram> load_seen_program(const RobotChoice& choice, bool passive) {
  if (passive || !choice.tip.empty()) {
    return fail(Errc::usage, text(msg::view_not_for_programs, choice.robot));
  }
  catch_interrupts();
  return program::load_sound_program(choice.robot, interrupted, load_options(choice),
                                     session::see_scene);
}

Result<session::FreeSim> make_free_sim(const SeenRobot& seen, bool passive) {
  Result<session::FreeSim> sim = session::FreeSim::create(seen.model, seen.arm, passive);
  if (sim || sim.error().code != Errc::not_available) return sim;
  log_info(text(msg::view_not_held, sim.error().what));
  return session::FreeSim::create(seen.model, seen.arm, true);
}

Result<double> parse_show_seconds(const std::string& value) {
  if (value.empty()) return 0;
  Result<double> seconds = parse_quantity(value, Quantity::time);
  if (!seconds) return fail(in_option("--seconds", seconds.error()));
  if (!(*seconds > 0)) return fail(Errc::usage, text(msg::view_bad_seconds, value));
  return seconds;
}

Result<void> set_camera(const std::string& words, const Model& model, view::WindowOptions& out) {
  if (words.empty()) return {};
  Result<render::Camera> camera = choose_camera(model, words);
  if (!camera) return fail(std::move(camera.error()));
  out.camera = std::move(*camera);
  return {};
}

}  // namespace mjarm::app
