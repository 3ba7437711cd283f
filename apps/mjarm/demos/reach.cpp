#include "apps/mjarm/commands/policy_run.hpp"
#include "apps/mjarm/demos/demos.hpp"
#include "mjarm/core/share.hpp"

namespace mjarm::app {

Result<Report> run_reach(const DemoOptions& options) {
  const Result<std::filesystem::path> share = share_folder();
  if (!share) return fail(share.error());
  const Result<rl::TrainedPolicy> loaded =
      rl::load_policy(*share / "models" / "policies" / "reach.safetensors");
  if (!loaded) return fail(loaded.error());
  Result<PolicyOutcome> outcome =
      run_policy(*loaded, {.name = "reach", .least_success = 0.95}, options);
  if (!outcome) return fail(std::move(outcome.error()));
  return std::move(outcome->report);
}

}  // namespace mjarm::app
