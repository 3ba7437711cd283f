#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/episode/draw_scene.hpp"
#include "mjarm/episode/record.hpp"
#include "mjarm/execution/execution.hpp"
#include "mjarm/model/jaws.hpp"
#include "mjarm/program/program_plan.hpp"
#include "mjarm/render/overlay.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::episode {

/// What a task is planned with.
struct PlanInput {
  const Robot& robot;               ///< in the scene as it was drawn
  const std::optional<Jaws>& jaws;  ///< of an arm with a gripper
  const SceneState& before;         ///< how things stand
  const StopCheck& stop;
};

/// What a task has planned.
struct TaskPlan {
  program::ProgramPlan plan;  ///< without motions where there is none
  Pose goal;                  ///< of what the task is about, as it tells
  std::string reason;         ///< why there is no plan, one word
};

/// How things stand in the end.
struct SceneEnd {
  const Sim& sim;
  Pose X_WT;                      ///< of the tool
  const std::vector<Pose>& X_WB;  ///< in the order of the drawn objects
  const Pose& goal;               ///< TaskPlan::goal
};

/// One episode of a task: what was drawn, how it is planned, and whether it succeeded. What can be
/// asked of all tasks; each is a file task_NAME.cpp.
class Task {
 public:
  explicit Task(DrawnScene scene) : scene_(std::move(scene)) {}
  virtual ~Task() = default;
  Task(const Task&) = delete;
  Task& operator=(const Task&) = delete;

  [[nodiscard]] const DrawnScene& scene() const { return scene_; }
  [[nodiscard]] virtual TaskPlan plan(const PlanInput& input) const = 0;
  [[nodiscard]] virtual ExecutionOptions execution() const { return {}; }
  /// After each step of the simulation, and once before the first.
  virtual void look(const Sim& /*sim*/) {}
  /// By the simulation's own knowledge of the scene, whatever was planned.
  [[nodiscard]] virtual Verdict judge(const SceneEnd& end) const = 0;
  /// The goal in `episode.json`; members `pos` and `quat` at least.
  [[nodiscard]] virtual JsonDoc goal_json(const Pose& goal) const { return pose_json(goal); }
  /// How much there is by now of what pictures show beside the model: a lamp that is on, ink.
  [[nodiscard]] virtual std::size_t marks() const { return 0; }
  /// What pictures show with so many marks.
  [[nodiscard]] virtual render::Overlay overlay(std::size_t /*marks*/) const { return {}; }

 private:
  DrawnScene scene_;
};

/// Index of a joint of one degree of freedom in the model's qpos.
[[nodiscard]] std::size_t qpos_of(const Model& model, std::string_view joint);

/// The random numbers of one episode: looks have a stream of their own.
struct EpisodeRng {
  Rng scene, looks;
};

/// A task as a user asks for it.
struct TaskKind {
  const char* name;
  const char* scene;  ///< file in the folder of each robot
  std::vector<DrawRange> ranges;
  /// @param robot  with that scene.
  std::unique_ptr<Task> (*draw)(const Robot& robot, EpisodeRng& rng);
  const char* tip = "";  ///< frame that is moved; empty: the robot's own
};

[[nodiscard]] TaskKind reach_task();
[[nodiscard]] TaskKind pick_place_task();
[[nodiscard]] TaskKind sort_task();
[[nodiscard]] TaskKind draw_a_figure_task();
[[nodiscard]] TaskKind push_button_task();
[[nodiscard]] TaskKind open_drawer_task();

/// All of them, in the order in which they are told.
[[nodiscard]] const std::vector<TaskKind>& task_kinds();
/// The one of that name, which is one.
[[nodiscard]] const TaskKind& task_kind(std::string_view name);

/// Draws episode `number`.
[[nodiscard]] std::unique_ptr<Task> draw_task(const Robot& robot, const EpisodeOptions& options,
                                              std::uint64_t number);

}  // namespace mjarm::episode
