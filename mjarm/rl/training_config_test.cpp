#include "mjarm/rl/training_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/rl/option_table_internal.hpp"
#include "mjarm/rl/safetensors.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::rl {
namespace {

using ::testing::HasSubstr;

std::string error_of(const std::string& yaml) {
  const Result<TrainingOptions> read = read_config(yaml, "f.yaml");
  if (read) return "none";
  EXPECT_EQ(read.error().code, Errc::bad_input);
  return read.error().what;
}

/// Numbers that no short text holds, and another choice of every kind.
TrainingOptions odd_options() {
  TrainingOptions options;
  options.task.region = ReachRegion::wide;
  options.task.action = ReachAction::torque;
  options.task.start = {0.1, 1.0 / 3.0, -2e-17};
  options.task.obstacle = true;
  options.task.reward.coarse_scale = std::nextafter(0.05, 1);
  options.ppo.seed = std::numeric_limits<std::uint64_t>::max();
  options.ppo.actor = {7};
  options.ppo.critic = {};
  options.ppo.activation = Activation::relu;
  options.ppo.schedule = Schedule::constant;
  options.ppo.learning_rate = 1.0 / 7.0;
  options.evaluation.episodes = 13;
  options.stop_share = 0.95;
  return options;
}

TEST(TrainingConfig, WhatIsWrittenIsReadBackInFull) {
  const TrainingOptions options = odd_options();
  const std::string text = config_text(options);
  const Result<TrainingOptions> read = read_config(text, "f.yaml");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(config_text(*read), text);
  EXPECT_EQ(read->ppo.seed, options.ppo.seed);
  EXPECT_EQ(read->ppo.learning_rate, options.ppo.learning_rate);
  EXPECT_EQ(read->task.start, options.task.start);
  EXPECT_EQ(read->task.reward.coarse_scale, options.task.reward.coarse_scale);
  EXPECT_TRUE(read->ppo.critic.empty());
  EXPECT_EQ(read->task.action, ReachAction::torque);
}

TEST(TrainingConfig, WhatIsLeftOutStaysAsItWas) {
  const TrainingOptions base = odd_options();
  const Result<TrainingOptions> read = read_config("ppo: {epochs: 3}", "f.yaml", base);
  ASSERT_TRUE(read) << read.error().what;
  TrainingOptions expected = base;
  expected.ppo.epochs = 3;
  EXPECT_EQ(config_text(*read), config_text(expected));
}

TEST(TrainingConfig, FaultsNameThePlaceAndTheNearestWord) {
  EXPECT_THAT(error_of("ppo: {learning_rat: 1}"), HasSubstr("f.yaml:1:7: \"learning_rat\""));
  EXPECT_THAT(error_of("ppo: {learning_rat: 1}"), HasSubstr("learning_rate"));
  EXPECT_THAT(error_of("zzz: {}"), HasSubstr("task, reward, ppo, training"));
  EXPECT_THAT(error_of("task: {region: wid}"), HasSubstr("tutorial, wide"));
  EXPECT_THAT(error_of("task: {obstacle: maybe}"), HasSubstr("false, true"));
  EXPECT_THAT(error_of("task: {obstacle: [true]}"), HasSubstr("f.yaml:1:18: obstacle: "));
  EXPECT_THAT(error_of("task: {start: [0, x]}"), HasSubstr("start: expected a number"));
  EXPECT_THAT(error_of("reward: {distance: 1e999}"), HasSubstr("distance: expected a number"));
  EXPECT_THAT(error_of("reward: {distance: 1 m}"), HasSubstr("distance: expected a number"));
  EXPECT_THAT(error_of("ppo: {seed: -1}"), HasSubstr("seed: expected a whole number"));
  EXPECT_THAT(error_of("ppo: {seed: 18446744073709551616}"), HasSubstr("seed: "));
  EXPECT_THAT(error_of("ppo: {actor: {a: 1}}"), HasSubstr("actor: expected a list"));
  EXPECT_THAT(error_of("training: 4"), HasSubstr("f.yaml:1:1: expected the keys evaluate_every"));
}

TEST(TrainingConfig, AnEmptyTextHasNoKeys) {
  EXPECT_EQ(error_of(""), "f.yaml: expected the keys task, reward, ppo, training");
  EXPECT_EQ(error_of("{}"), "none");
}

TEST(TrainingConfig, FaultsAreToldInTheLanguageInUse) {
  const LanguageScope chinese(Language::chinese);
  EXPECT_THAT(error_of("ppo: {epochs: x}"),
              HasSubstr("epochs：应为整数（介于 1 与 1e+06 之间的数）"));
}

/// One number of a configuration, as the table of options has it.
struct RangedKey {
  std::string section, key;
  detail::OptionRange range;
  bool list, whole;

  [[nodiscard]] std::string yaml(const std::string& value) const {
    return section + ": {" + key + ": " + (list ? "[" + value + "]" : value) + "}";
  }
};

struct RangedKeys {
  std::vector<RangedKey> all;

  template <class T>
  void operator()(const char*, const char*, const T&) {}
  template <class T>
  void operator()(const char* section, const char* key, const T&,
                  const detail::OptionRange& range) {
    if constexpr (std::is_arithmetic_v<T>) {
      all.push_back({section, key, range, false, std::is_integral_v<T>});
    } else {
      all.push_back({section, key, range, true, std::is_integral_v<typename T::value_type>});
    }
  }
};

TEST(TrainingConfig, EveryNumberHasARangeThatIsKept) {
  RangedKeys keys;
  TrainingOptions defaults;
  detail::visit_options(defaults, keys);
  EXPECT_GT(keys.all.size(), 40U);
  for (const RangedKey& key : keys.all) {
    SCOPED_TRACE(key.section + "." + key.key);
    const auto refused = [&](const std::string& value) {
      EXPECT_THAT(error_of(key.yaml(value)), HasSubstr("f.yaml:1:")) << value;
      EXPECT_THAT(error_of(key.yaml(value)), HasSubstr(key.key)) << value;
    };
    const auto taken = [&](double value) {
      const std::string written =
          key.whole ? std::to_string(static_cast<std::int64_t>(value)) : number(value);
      EXPECT_EQ(error_of(key.yaml(written)), "none") << written;
    };
    const double less = key.range.least - (key.whole ? 1 : 1e-6 + std::abs(key.range.least) * 1e-6);
    refused(key.whole ? std::to_string(static_cast<std::int64_t>(less)) : number(less));
    if (key.range.above)
      refused(number(key.range.least));
    else
      taken(key.range.least);
    const bool bounded = key.range.most < 1e18;
    if (bounded) taken(key.range.most);
    const double more = bounded ? 1.001 * key.range.most + 1 : 0;
    if (bounded)
      refused(key.whole ? std::to_string(static_cast<std::int64_t>(more)) : number(more));
    for (const char* absurd : {"-1e308", "99999999999999999999", "nan", "inf", "1e999"}) {
      if (key.whole || std::string(absurd) != "99999999999999999999" || bounded) refused(absurd);
    }
  }
}

TEST(TrainingConfig, AnEvaluationEveryZeroStepsIsRefusedByFileAndLine) {
  EXPECT_EQ(error_of("training: {evaluate_every: 0}"),
            "f.yaml:1:28: evaluate_every must be in [1, 1e+15], not 0");
  EXPECT_EQ(error_of("training:\n  evaluate_every: -5"),
            "f.yaml:2:19: evaluate_every must be in [1, 1e+15], not -5");
}

TEST(TrainingConfig, FilesThatAreMissingOrHugeAreErrors) {
  const support::TempFolder folder;
  EXPECT_THAT(load_config(folder.path() / "none.yaml").error().what, HasSubstr("none.yaml"));
  const auto huge = folder.write("huge.yaml", std::string((1 << 20) + 1, '#'));
  EXPECT_THAT(load_config(huge).error().what, HasSubstr("huge.yaml"));
  const auto good = folder.write("good.yaml", config_text(odd_options()));
  EXPECT_EQ(config_text(load_config(good).value()), config_text(odd_options()));
}

TEST(TrainingConfig, ACheckpointHoldsOneOrSaysThatItDoesNot) {
  const support::TempFolder folder;
  const auto file = folder.path() / "c.safetensors";
  TensorSet set = Policy({.observations = 2, .actions = 1, .actor = {3}, .critic = {3}}).tensors();
  ASSERT_TRUE(save_safetensors(file, set));
  EXPECT_THAT(config_of_checkpoint(file).error().what, HasSubstr("holds no configuration"));
  EXPECT_FALSE(config_in(set, file).value());
  set.metadata["config"] = config_text(odd_options());
  ASSERT_TRUE(save_safetensors(file, set));
  EXPECT_EQ(config_text(config_of_checkpoint(file).value()), config_text(odd_options()));
  set.metadata["config"] = "ppo: {epochs: many}";
  EXPECT_THAT(config_in(set, file).error().what, HasSubstr("c.safetensors:1:15: epochs"));
}

}  // namespace
}  // namespace mjarm::rl
