#include "mjarm/clone/learn.hpp"

#include <cmath>

#include "mjarm/core/messages/clone.hpp"

namespace mjarm::clone {

Result<ClonedPolicy> learn(const Demonstrated& data, const rl::CloningOptions& options,
                           const StopCheck& stop,
                           const std::function<void(int, double)>& after_epoch) {
  const rl::Demonstrations rows{
      .rows = data.rows.size(),
      .observations = observation_size(data.rows.front().seen.objects.size()),
      .actions = kActions,
      .show = [&](std::size_t row, Rng* rng, std::span<float> observation,
                  std::span<float> action) {
        const Shown& kept = data.rows[row];
        const Shown shown = rng == nullptr ? kept : blurred(kept, *rng);
        write_observation(shown.seen, observation);
        write_answer(shown.seen, shown.answer, action);
      }};
  rl::Cloner cloner(rows, options);
  while (cloner.epochs() < options.epochs) {
    if (is_stopped(stop)) return fail(stopped());
    const double loss = cloner.epoch();
    if (!std::isfinite(loss)) {
      return fail(Errc::impossible, text(msg::clone_diverged, cloner.epochs(), loss));
    }
    if (after_epoch) after_epoch(cloner.epochs(), loss);
  }
  return ClonedPolicy{cloner.policy(), data.options};
}

}  // namespace mjarm::clone
