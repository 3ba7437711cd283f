#include "mjarm/rl/trained_policy.hpp"

#include <optional>
#include <utility>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/rl/safetensors.hpp"
#include "mjarm/rl/sb3_zip.hpp"
#include "mjarm/rl/training_config.hpp"

namespace mjarm::rl {

Result<TrainedPolicy> load_policy(const std::filesystem::path& file) {
  const bool zip = file.extension() == ".zip";
  const Result<TensorSet> set = zip ? load_sb3_zip(file) : load_safetensors(file);
  if (!set) return fail(set.error());
  Result<Policy> policy = Policy::from(*set);
  if (!policy)
    return fail(policy.error().code, text(msg::core_at_place, file.string(), policy.error().what));
  const Result<std::optional<TrainingOptions>> config = config_in(*set, file);
  if (!config) return fail(config.error());
  return TrainedPolicy{file, std::move(*policy), config->value_or(TrainingOptions{}).task};
}

}  // namespace mjarm::rl
