#pragma once

#include <optional>
#include <string>

#include "apps/mjarm/cli/robot.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/session/free_sim.hpp"
#include "mjarm/view/window.hpp"

namespace mjarm::app {

/// What a user looks at and plays with, in a window or in a page: any model; one without an arm has
/// nothing to hold.
struct SeenRobot {
  Model model;
  std::optional<Arm> arm;
};

/// Loads it and logs what was odd about it.
/// @param which  what is said where no model is named.
[[nodiscard]] Result<SeenRobot> load_seen_robot(const RobotChoice& choice, Msg which);

/// Loads a program and checks it; an interrupt ends that. It brings its robot and tool along, and
/// holds it.
/// @return an error of usage where the choice names a tip or nothing is to be held (`passive`).
[[nodiscard]] Result<program::LoadedProgram> load_seen_program(const RobotChoice& choice,
                                                               bool passive);

/// Its simulation; an arm whose actuators cannot hold it is not held, and the log says why.
[[nodiscard]] Result<session::FreeSim> make_free_sim(const SeenRobot& seen, bool passive);

/// Reads `--seconds`, a time > 0; 0 where it is not given.
[[nodiscard]] Result<double> parse_show_seconds(const std::string& value);

/// Reads `--camera` for `model`; where nobody says otherwise the view stays what it is.
[[nodiscard]] Result<void> set_camera(const std::string& words, const Model& model,
                                      view::WindowOptions& out);

}  // namespace mjarm::app
