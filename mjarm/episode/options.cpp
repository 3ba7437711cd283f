#include "mjarm/episode/options.hpp"

#include <algorithm>

#include "mjarm/core/messages/episode.hpp"
#include "mjarm/core/nearest_word.hpp"

namespace mjarm::episode {
namespace {

constexpr int kMinSize = 16, kMaxSize = 1024, kMinFps = 1, kMaxFps = 50;

Result<void> in_range(const char* name, int value, int least, int most) {
  if (value >= least && value <= most) return {};
  return fail(Errc::bad_input, text(msg::episode_range, name, least, most, value));
}

}  // namespace

std::vector<std::string> task_names() { return {"reach", "pick_place"}; }
std::vector<std::string> robot_names() { return {"panda", "ur5e"}; }

Result<void> check(const EpisodeOptions& options) {
  const std::vector<std::string> tasks = task_names(), robots = robot_names();
  if (std::ranges::count(tasks, options.task) == 0) {
    return fail(Errc::bad_input, text(msg::episode_task, options.task, listed(tasks)));
  }
  if (std::ranges::count(robots, options.robot) == 0) {
    return fail(Errc::bad_input, text(msg::episode_robot, options.robot, listed(robots)));
  }
  if (auto fits = in_range("size", options.size, kMinSize, kMaxSize); !fits) return fits;
  return in_range("fps", options.fps, kMinFps, kMaxFps);
}

}  // namespace mjarm::episode
