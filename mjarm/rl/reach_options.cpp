#include "mjarm/rl/reach_options.hpp"

#include <span>
#include <string>

#include "mjarm/core/messages/reach.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/rl/option_table_internal.hpp"
#include "mjarm/rl/reach_options_internal.hpp"

namespace mjarm::rl {
namespace {

constexpr std::array<std::string_view, 2> kRegions = {"tutorial", "wide"};
constexpr std::array<std::string_view, 4> kActions = {"joint_delta", "joint_velocity",
                                                      "joint_position", "torque"};
constexpr std::array<std::string_view, 2> kGrippers = {"open", "as_model"};

template <class Choice>
Result<Choice> choice(std::string_view word, std::span<const std::string_view> names) {
  const auto index = index_of_word(word, names, msg::reach_unknown);
  if (!index) return fail(index.error());
  return static_cast<Choice>(*index);
}

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
  detail::RangeCheck ranges("reward");
  ranges("task", "threads", o.threads, detail::kThreads);
  detail::visit_reach(o, ranges);
  if (auto fine = ranges.result(); !fine) return fine;
  const ReachOptions guide = guide_options();
  if (o.guide &&
      (o.action != guide.action || o.frame_skip != guide.frame_skip || o.region != guide.region ||
       o.gripper != guide.gripper || o.orientation || o.obstacle)) {
    return fail(Errc::usage, text(msg::reach_guide_options));
  }
  return {};
}

}  // namespace mjarm::rl
