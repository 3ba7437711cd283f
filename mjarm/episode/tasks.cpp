#include <algorithm>
#include <optional>
#include <utility>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/episode.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/episode/options.hpp"
#include "mjarm/episode/task_internal.hpp"
#include "mjarm/model/describe.hpp"

namespace mjarm::episode {
namespace {

constexpr int kMinSize = 16, kMaxSize = 1024, kMinFps = 1, kMaxFps = 50;

Result<void> in_range(const char* name, int value, int least, int most) {
  if (value >= least && value <= most) return {};
  return fail(Errc::bad_input, text(msg::episode_range, name, least, most, value));
}

/// ` (did you mean "pick_place"?)` where `word` is near to a task, or to how its name begins.
std::string task_meant(const std::string& word, const std::vector<std::string>& tasks) {
  if (const std::string whole = did_you_mean(word, tasks); !whole.empty()) return whole;
  std::vector<std::string> beginnings;
  for (const std::string& task : tasks) beginnings.push_back(task.substr(0, task.find('_')));
  // Equal words are no nearest one.
  auto found = std::ranges::find(beginnings, word);
  if (found == beginnings.end()) {
    const std::optional<std::string> near = nearest_word(word, beginnings);
    if (!near) return "";
    found = std::ranges::find(beginnings, *near);
  }
  return text(msg::core_did_you_mean, tasks[static_cast<std::size_t>(found - beginnings.begin())]);
}

const char* folder_of(const std::string& robot) {
  return robot == "panda" ? "franka_emika_panda/" : "universal_robots_ur5e/";
}

}  // namespace

const std::vector<TaskKind>& task_kinds() {
  static const std::vector<TaskKind> all{reach_task(),       pick_place_task(),
                                         sort_task(),        draw_a_figure_task(),
                                         push_button_task(), open_drawer_task()};
  return all;
}

const TaskKind& task_kind(std::string_view name) {
  return *std::ranges::find(task_kinds(), name, &TaskKind::name);
}

std::size_t qpos_of(const Model& model, std::string_view joint) {
  for (const BodyInfo& body : describe(model).bodies) {
    for (const JointInfo& one : body.joints) {
      if (one.name == joint) return static_cast<std::size_t>(one.qpos);
    }
  }
  return 0;
}

std::vector<std::string> task_names() {
  std::vector<std::string> out;
  for (const TaskKind& kind : task_kinds()) out.emplace_back(kind.name);
  return out;
}

std::vector<std::string> robot_names() { return {"panda", "ur5e"}; }

Result<Robot> load_task_robot(const EpisodeOptions& options) {
  if (Result<void> fits = check(options); !fits) return fail(std::move(fits.error()));
  const TaskKind& kind = task_kind(options.task);
  return load_robot(folder_of(options.robot) + std::string(kind.scene), {.tip = kind.tip});
}

Result<void> check(const EpisodeOptions& options) {
  const std::vector<std::string> tasks = task_names(), robots = robot_names();
  if (std::ranges::count(tasks, options.task) == 0) {
    return fail(Errc::bad_input, text(msg::episode_task, options.task, listed(tasks),
                                      task_meant(options.task, tasks)));
  }
  if (std::ranges::count(robots, options.robot) == 0) {
    return fail(Errc::bad_input, text(msg::episode_robot, options.robot, listed(robots),
                                      did_you_mean(options.robot, robots)));
  }
  if (auto fits = in_range("size", options.size, kMinSize, kMaxSize); !fits) return fits;
  return in_range("fps", options.fps, kMinFps, kMaxFps);
}

std::vector<DrawRange> draw_ranges(std::string_view task) {
  const auto kind = std::ranges::find(task_kinds(), task, &TaskKind::name);
  return kind == task_kinds().end() ? std::vector<DrawRange>{} : kind->ranges;
}

std::unique_ptr<Task> draw_task(const Robot& robot, const EpisodeOptions& options,
                                std::uint64_t number) {
  EpisodeRng rng{Rng(options.seed, 2 * number), Rng(options.seed, 2 * number + 1)};
  return task_kind(options.task).draw(robot, rng);
}

DrawnScene draw_scene(const Robot& robot, const EpisodeOptions& options, std::uint64_t number) {
  return draw_task(robot, options, number)->scene();
}

}  // namespace mjarm::episode
