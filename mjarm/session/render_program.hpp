#pragma once

#include <optional>
#include <string>

#include "mjarm/core/os.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/session/picture.hpp"

namespace mjarm::session {

/// Runs a plan without faults and makes a picture of its end, a strip of pictures or a video of all
/// of it.
/// @param seconds  [s] of simulated time at most.
/// @param stop     ends it; no file is written then.
/// @return the line to tell, or why there is no file.
[[nodiscard]] Result<std::string> render_program(const program::LoadedProgram& loaded,
                                                 const PictureOptions& options,
                                                 const render::Camera& camera,
                                                 std::optional<double> seconds = {},
                                                 const StopCheck& stop = interrupted);

}  // namespace mjarm::session
