#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/train/policy_run.hpp"
#include "mjarm/core/os.hpp"

namespace mjarm::app {

Result<Report> run_reach(const DemoOptions& options) {
  const Result<std::filesystem::path> self = executable_path();
  if (!self) return fail(self.error());
  const std::filesystem::path file =
      self->parent_path() / ".." / "share" / "mjarm" / "models" / "policies" / "reach.safetensors";
  const Result<LoadedPolicy> loaded = load_policy(file.lexically_normal());
  if (!loaded) return fail(loaded.error());
  Result<PolicyOutcome> outcome =
      run_policy(*loaded, {.name = "reach", .least_success = 0.95}, options);
  if (!outcome) return fail(std::move(outcome.error()));
  return std::move(outcome->report);
}

}  // namespace mjarm::app
