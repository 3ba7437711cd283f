#include <numbers>
#include <utility>

#include "mjarm/core/messages/episode.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/episode/draw_looks_internal.hpp"
#include "mjarm/episode/pick_table_internal.hpp"
#include "mjarm/episode/plan_chain_internal.hpp"

namespace mjarm::episode {
namespace {

constexpr double kAbove = 0.12;  // [m] of the jaws above the middle of an object

DrawnScene over_target(DrawnScene scene) {
  scene.p_goal = scene.objects[scene.target].X_WB.p + Eigen::Vector3d(0, 0, kAbove);
  return scene;
}

/// The open gripper to above an object.
class ReachTask final : public Task {
 public:
  explicit ReachTask(PickTable table)
      : Task(over_target(std::move(table.scene))), turns_(std::move(table.turns)) {}

  [[nodiscard]] TaskPlan plan(const PlanInput& input) const override {
    const Pose X_JT = jaws_pose(*input.jaws).inverse();
    TaskPlan out;
    for (const double turn : turns_) {
      const Pose X_WJ{.p = *scene().p_goal, .R = from_euler({std::numbers::pi, 0, turn})};
      PlanChain chain(input, scene().q);
      const Pose goal = X_WJ * X_JT;
      chain.add({plan_to(goal)});
      out = std::move(chain).finish(goal);
      if (out.reason.empty()) break;
    }
    return out;
  }

  [[nodiscard]] Verdict judge(const SceneEnd& end) const override {
    std::vector<Pose> before;
    for (const DrawnObject& object : scene().objects) before.push_back(object.X_WB);
    return episode::judge(end.X_WT, end.goal, before, end.X_WB);
  }

 private:
  std::vector<double> turns_;
};

std::unique_ptr<Task> draw_reach(const Robot& robot, EpisodeRng& rng) {
  return std::make_unique<ReachTask>(draw_pick_table(robot, rng, msg::episode_reach));
}

}  // namespace

TaskKind reach_task() {
  return {"reach", kPickScene, with_looks_ranges(object_ranges()), draw_reach};
}

}  // namespace mjarm::episode
