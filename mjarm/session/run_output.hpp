#pragma once

#include <filesystem>
#include <initializer_list>

#include "mjarm/core/result.hpp"
#include "mjarm/execution/report.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/render/camera.hpp"
#include "mjarm/render/overlay.hpp"
#include "mjarm/render/plot.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::session {

/// What a run leaves behind besides its log.
struct RunOutput {
  Report report;
  render::Plot plot;
  render::Overlay overlay;  ///< drawn into the picture
  render::Camera camera;    ///< of the picture
  bool film = false;        ///< there is a video of it
};

inline constexpr const char* kVideoFile = "video.mp4";

/// Takes away files that an earlier run left in `folder` and this one does not make.
void remove_stale(const std::filesystem::path& folder, std::initializer_list<const char*> names);

/// Writes picture.png into `folder`. A machine without any GL back end gets none, and a line that
/// says so.
[[nodiscard]] Result<void> write_end_picture(const std::filesystem::path& folder,
                                             const Model& model, const Snapshot& snapshot,
                                             const render::Camera& camera,
                                             const render::Overlay& overlay);

/// Writes report.json, plot.svg, plot.png and picture.png into `folder`, the picture as
/// `write_end_picture` does; of these and a video none stays there that is of an earlier run.
[[nodiscard]] Result<void> write_output(const std::filesystem::path& folder, const Model& model,
                                        const Snapshot& snapshot, const RunOutput& output);

}  // namespace mjarm::session
