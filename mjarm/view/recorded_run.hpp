#pragma once

#include <functional>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/render/camera.hpp"
#include "mjarm/render/overlay.hpp"
#include "mjarm/render/plot.hpp"
#include "mjarm/sim/body_record.hpp"
#include "mjarm/view/live_plot.hpp"

namespace mjarm::view {

/// All of a run that people look at, once it is over.
struct RecordedRun {
  const Model& model;
  std::string title;
  const BodyRecord& bodies;
  render::Overlay overlay = {};      ///< what was planned, and the trail
  std::vector<LivePlot> plots = {};  ///< over time, and from above
  std::string line = {};             ///< what became of it, for people
  render::Camera camera = {};        ///< from where it is seen well
  std::string arm = {};        ///< JSON of the arm that may be led by hand; empty = none may be
  std::vector<int> dofs = {};  ///< ... and of its joints
};

/// Puts a recorded run where the user wants it.
using RunKeeper = std::function<Result<void>(const RecordedRun& run)>;

/// A panel of a page on paper as one that lives: its curves in their colours; strips and fields are
/// left out.
[[nodiscard]] LivePlot live_plot(const render::PlotPanel& panel);

}  // namespace mjarm::view
