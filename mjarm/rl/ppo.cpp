#include "mjarm/rl/ppo.hpp"

#include <cmath>
#include <limits>
#include <string_view>

#include "mjarm/core/messages/rl.hpp"

namespace mjarm::rl {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::max();

/// A range, as text and as numbers; the lower end belongs to it unless it is `open`.
struct OptionRange {
  std::string_view words;
  double least;
  double max = kNoLimit;
  bool open = false;

  [[nodiscard]] bool holds(double value) const {
    return (open ? value > least : value >= least) && value <= max;
  }
};

struct NamedOption {
  std::string_view name;
  double value;
  OptionRange range;
};

constexpr OptionRange kAboveZero = {"> 0", 0, kNoLimit, true};
constexpr OptionRange kZeroOrMore = {">= 0", 0};
constexpr OptionRange kShare = {"in [0, 1]", 0, 1};
constexpr OptionRange kCount = {"in [1, 1e6]", 1, 1e6};

Result<void> check_layers(std::string_view name, const std::vector<int>& layers) {
  for (const int size : layers) {
    if (size < 1 || size > 65536) {
      return fail(Errc::bad_input, text(msg::rl_option_range, name, "in [1, 65536]", double(size)));
    }
  }
  return {};
}

}  // namespace

std::string_view name(Schedule schedule) noexcept {
  return schedule == Schedule::constant ? "constant" : "linear";
}

Result<void> check(const PpoOptions& options) {
  const NamedOption all[] = {
      {"threads", double(options.threads), {"in [1, 1024]", 1, 1024}},
      {"total_steps", static_cast<double>(options.total_steps), kAboveZero},
      {"rollout_steps", double(options.rollout_steps), kCount},
      {"minibatch", double(options.minibatch), {"in [2, 1e6]", 2, 1e6}},
      {"epochs", double(options.epochs), kCount},
      {"learning_rate", options.learning_rate, kAboveZero},
      {"adam_epsilon", options.adam_epsilon, kAboveZero},
      {"max_gradient_norm", options.max_gradient_norm, kZeroOrMore},
      {"discount", options.discount, kShare},
      {"gae_lambda", options.gae_lambda, kShare},
      {"clip", options.clip, kAboveZero},
      {"value_clip", options.value_clip, kZeroOrMore},
      {"value_weight", options.value_weight, kZeroOrMore},
      {"entropy_weight", options.entropy_weight, kZeroOrMore},
      {"target_kl", options.target_kl, kZeroOrMore},
      {"initial_log_std", options.initial_log_std, {"in [-20, 2]", -20, 2}},
  };
  for (const NamedOption& option : all) {
    if (!option.range.holds(option.value)) {
      return fail(Errc::bad_input,
                  text(msg::rl_option_range, option.name, option.range.words, option.value));
    }
  }
  return check_layers("actor", options.actor).and_then([&] {
    return check_layers("critic", options.critic);
  });
}

}  // namespace mjarm::rl
