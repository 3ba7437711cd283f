#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/train/policy_run.hpp"
#include "mjarm/core/messages/train.hpp"
#include "mjarm/model/shipped.hpp"

namespace mjarm::app {

Result<Report> run_reach(const DemoOptions& options) {
  const Result<std::filesystem::path> file = find_shared_file("models/policies/reach.safetensors");
  if (!file) return fail(file.error());
  const Result<LoadedPolicy> loaded = load_policy(*file);
  if (!loaded) return fail(loaded.error());
  Result<PolicyOutcome> outcome =
      run_policy(*loaded, {.name = "reach", .least_success = 0.95}, options);
  if (!outcome) return fail(std::move(outcome.error()));
  return std::move(outcome->report);
}

}  // namespace mjarm::app
