#pragma once

#include <string>

#include "apps/mjarm/commands/render_options.hpp"

namespace mjarm::app {

/// Plans and runs the motion program `file` and makes a picture of its end or a video of all of it.
/// @return the line to tell, or why there is no file.
[[nodiscard]] Result<std::string> render_program(const std::string& file,
                                                 const PictureOptions& options);

/// Draws one picture and writes it. @return the line to tell.
[[nodiscard]] Result<std::string> write_picture(OffscreenRenderer& renderer,
                                                const PictureOptions& options,
                                                const Snapshot& snapshot, const Camera& camera,
                                                const Overlay& overlay);

}  // namespace mjarm::app
