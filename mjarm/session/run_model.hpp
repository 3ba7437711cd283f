#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/sim/ctrl_schedule.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::session {

inline constexpr double kMaxModelSeconds = 3600;  ///< [s] that a model may be simulated for
inline constexpr double kMaxModelSteps = 1e8;     ///< the same in steps

/// Where a model begins.
struct ModelStart {
  /// As the file has it, with its ctrl. Empty: keyframe `home`, else the arm's own home, else as
  /// the model starts; servos of the arm hold it there.
  std::string keyframe = {};
  /// All of qpos, shape (nq,), at rest; servos of the arm hold it there. Not with a keyframe.
  std::optional<std::vector<double>> qpos = {};
};

/// How a model is simulated.
struct ModelRunOptions {
  ModelStart start = {};
  std::vector<CtrlSchedule> ctrl = {};  ///< commands; actuators without one keep what they have
  double seconds = 1;                   ///< [s] > 0, at most kMaxModelSeconds
};

/// A world of the model at its start.
/// @return bad_input: no such keyframe, or a qpos of another size.
[[nodiscard]] Result<Sim> start_model(const Model& model, const ModelStart& start);

/// @return usage where that long a simulation is out of the question, with what is possible.
[[nodiscard]] Result<void> check_run_length(const Model& model, double seconds);

/// Steps `sim` for that long, with a progress bar; the physics alone, no control. Ctrl-C ends it.
/// @param look  before every step and at the end, with the ctrl that holds from then on, (nu,);
///              false ends the run.
/// @return true where it came to the end; where it became unstable the error of Sim::step, with
///         `sim` back in its initial state.
[[nodiscard]] Result<bool> run_model(
    Sim& sim, const ModelRunOptions& options,
    const std::function<bool(const Sim& sim, std::span<const double> ctrl)>& look);

}  // namespace mjarm::session
