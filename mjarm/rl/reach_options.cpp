#include "mjarm/rl/reach_options.hpp"

#include <span>
#include <string>

#include "mjarm/core/messages/reach.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/rl/reach_options_internal.hpp"

namespace mjarm::rl {
namespace {

constexpr std::array<std::string_view, 2> kRegions = {"tutorial", "wide"};
constexpr std::array<std::string_view, 4> kActions = {"joint_delta", "joint_velocity",
                                                      "joint_position", "torque"};
constexpr std::array<std::string_view, 2> kGrippers = {"open", "as_model"};

template <class Choice>
Result<Choice> choice(std::string_view word, std::span<const std::string_view> names) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == word) return static_cast<Choice>(i);
  }
  const std::vector<std::string> words(names.begin(), names.end());
  return fail(Errc::usage,
              text(msg::reach_unknown, word, listed(words)) + did_you_mean(word, words));
}

/// One option and the range it must be in.
struct Range {
  std::string_view name;
  double value;
  double lower;
  double upper;
  bool open = false;  ///< `lower` itself is too little
};

Result<void> in_range(const Range& range) {
  const bool high_enough = range.open ? range.value > range.lower : range.value >= range.lower;
  if (high_enough && range.value <= range.upper) return {};
  const Msg words = range.open ? msg::reach_number_above : msg::reach_number_from_to;
  return fail(Errc::usage, text(msg::reach_number, range.name,
                                text(words, range.lower, range.upper), range.value));
}

constexpr double kMax = 1e6;  // of weights and scales

}  // namespace

std::string_view name(ReachRegion region) noexcept {
  return kRegions[static_cast<std::size_t>(region)];
}
std::string_view name(ReachAction action) noexcept {
  return kActions[static_cast<std::size_t>(action)];
}
std::string_view name(ReachGripper gripper) noexcept {
  return kGrippers[static_cast<std::size_t>(gripper)];
}
Result<ReachRegion> reach_region(std::string_view name) {
  return choice<ReachRegion>(name, kRegions);
}
Result<ReachAction> reach_action(std::string_view name) {
  return choice<ReachAction>(name, kActions);
}
Result<ReachGripper> reach_gripper(std::string_view name) {
  return choice<ReachGripper>(name, kGrippers);
}

ReachOptions guide_options() {
  return {.action = ReachAction::joint_position,
          .gripper = ReachGripper::as_model,
          .frame_skip = 1,
          .episode_steps = 2000,
          .guide = true};
}

Result<void> check(const ReachOptions& o) {
  const ReachReward& r = o.reward;
  const Range ranges[] = {
      {"environments", 1.0 * o.environments, 1, 100000},
      {"threads", 1.0 * o.threads, 1, 1024},
      {"frame_skip", 1.0 * o.frame_skip, 1, 10000},
      {"episode_steps", 1.0 * o.episode_steps, 1, kMax},
      {"start_spread", o.start_spread, 0, 1},
      {"speed", o.speed, 0, 1, true},
      {"torque", o.torque, 0, 1, true},
      {"reward.distance", r.distance, 0, kMax},
      {"reward.coarse", r.coarse, 0, kMax},
      {"reward.coarse_scale", r.coarse_scale, 0, kMax, true},
      {"reward.fine", r.fine, 0, kMax},
      {"reward.fine_scale", r.fine_scale, 0, kMax, true},
      {"reward.action", r.action, 0, kMax},
      {"reward.collision", r.collision, 0, kMax},
      {"reward.limit", r.limit, 0, kMax},
      {"reward.limit_margin", r.limit_margin, 0, kMax, true},
      {"reward.turn", r.turn, 0, kMax},
      {"reward.turn_fine", r.turn_fine, 0, kMax},
      {"reward.turn_scale", r.turn_scale, 0, kMax, true},
  };
  for (const Range& range : ranges) {
    if (auto fine = in_range(range); !fine) return fine;
  }
  const ReachOptions guide = guide_options();
  if (o.guide &&
      (o.action != guide.action || o.frame_skip != guide.frame_skip || o.region != guide.region ||
       o.gripper != guide.gripper || o.orientation || o.obstacle)) {
    return fail(Errc::usage, text(msg::reach_guide_options));
  }
  return {};
}

}  // namespace mjarm::rl
