#include <utility>

#include "mjarm/core/messages/episode.hpp"
#include "mjarm/episode/draw_looks_internal.hpp"
#include "mjarm/episode/pick_table_internal.hpp"
#include "mjarm/program/pick_place.hpp"

namespace mjarm::episode {
namespace {

/// An object into the tray.
class PickPlaceTask final : public Task {
 public:
  using Task::Task;

  [[nodiscard]] TaskPlan plan(const PlanInput& input) const override {
    const Pose X_WB_place{.p = *scene().p_goal};
    const program::PickTask task{.object = scene().objects[scene().target].name,
                                 .place = {{.X_WB = X_WB_place, .any_turn = true}}};
    auto planned =
        program::plan_pick(input.robot, input.before, scene().q, task, {.stop = input.stop});
    if (!planned) {
      return {.plan = {}, .goal = X_WB_place, .reason = std::string(name(planned.error().code))};
    }
    return {.plan = std::move(planned->plan),
            .goal = planned->X_WB_place.value_or(X_WB_place),
            .reason = {}};
  }

  [[nodiscard]] Verdict judge(const SceneEnd& end) const override {
    std::vector<Pose> before, after;
    for (std::size_t i = 0; i < scene().objects.size(); ++i) {
      if (i == scene().target) continue;
      before.push_back(scene().objects[i].X_WB);
      after.push_back(end.X_WB[i]);
    }
    return episode::judge(end.X_WB[scene().target], end.goal, before, after);
  }
};

std::unique_ptr<Task> draw_pick_place(const Robot& robot, EpisodeRng& rng) {
  PickTable table = draw_pick_table(robot, rng, msg::episode_put);
  table.scene.p_goal = table.p_place;
  return std::make_unique<PickPlaceTask>(std::move(table.scene));
}

}  // namespace

TaskKind pick_place_task() {
  std::vector<DrawRange> ranges = object_ranges();
  const std::vector<DrawRange> place = place_ranges();
  ranges.insert(ranges.end(), place.begin(), place.end());
  return {"pick_place", kPickScene, with_looks_ranges(std::move(ranges)), draw_pick_place};
}

}  // namespace mjarm::episode
