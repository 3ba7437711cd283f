#include "mjarm/session/run_model.hpp"

#include <cmath>

#include "mjarm/core/messages/show.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/model/find_arm.hpp"

namespace mjarm::session {
namespace {

/// Puts the whole model at `qpos`; the servos of its arm, if it has one, hold it there.
Result<void> stand_at(Sim& sim, const std::vector<double>& qpos) {
  const Model& model = sim.model();
  if (static_cast<int>(qpos.size()) != model.nq()) {
    return fail(Errc::bad_input, text(msg::show_qpos_size, qpos.size(), model.nq()));
  }
  sim.set_state(qpos, std::vector<double>(static_cast<std::size_t>(model.nv()), 0.0));
  if (const Result<Arm> arm = find_arm(model)) sim.place(*arm, as_span(sim.arm_state(*arm).q));
  return {};
}

void stand_at_home(Sim& sim) {
  sim.reset_home();
  if (const Result<Arm> arm = find_arm(sim.model())) sim.place(*arm, as_span(arm->home));
}

}  // namespace

Result<Sim> start_model(const Model& model, const ModelStart& start) {
  Sim sim(model);
  if (start.qpos) {
    if (Result<void> stands = stand_at(sim, *start.qpos); !stands) return fail(stands.error());
  } else if (!start.keyframe.empty()) {
    if (Result<void> reset = sim.reset(start.keyframe); !reset) return fail(reset.error());
  } else {
    stand_at_home(sim);
  }
  return sim;
}

Result<void> check_run_length(const Model& model, double seconds) {
  const double steps = std::round(seconds / model.timestep());
  if (seconds > 0 && seconds <= kMaxModelSeconds && steps >= 1 && steps <= kMaxModelSteps) {
    return {};
  }
  return fail(Errc::usage, text(msg::show_run_length, seconds, model.timestep(),
                                std::min(kMaxModelSeconds, kMaxModelSteps * model.timestep())));
}

Result<bool> run_model(
    Sim& sim, const ModelRunOptions& options,
    const std::function<bool(const Sim& sim, std::span<const double> ctrl)>& look) {
  const double start = sim.time();
  const auto steps =
      static_cast<std::uint64_t>(std::round(options.seconds / sim.model().timestep()));
  std::vector<double> ctrl(sim.ctrl().begin(), sim.ctrl().end());
  Progress progress(text(msg::show_running), steps);
  for (std::uint64_t i = 0;; ++i) {
    for (const CtrlSchedule& schedule : options.ctrl) schedule.apply(sim.time() - start, ctrl);
    if (!look(sim, ctrl) || interrupted()) return false;
    if (i == steps) return true;
    if (Result<void> stepped = sim.step(ctrl); !stepped) return fail(std::move(stepped.error()));
    progress.advance();
  }
}

}  // namespace mjarm::session
