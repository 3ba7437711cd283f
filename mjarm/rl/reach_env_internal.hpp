#pragma once

#include <limits>

#include "mjarm/rl/reach_drive_internal.hpp"
#include "mjarm/rl/reach_env.hpp"
#include "mjarm/rl/reach_episodes_internal.hpp"
#include "mjarm/sim/batch.hpp"

namespace mjarm::rl {

/// What stands for a distance that there is not.
inline constexpr double kNoDistance = std::numeric_limits<double>::quiet_NaN();

struct ReachEnv::Impl {
  /// What is remembered of one copy besides its world.
  struct Copy {
    ReachEpisode episode;
    std::uint32_t number = 0;  ///< of the episode
    int steps = 0;             ///< actions of it that are done
    Eigen::Vector3d judged;    ///< [m] the point that was compared with the goal last
  };

  Model model;
  Arm arm;
  ReachOptions options;
  ReachDrive drive;
  ReachEpisodes episodes;
  BatchSim batch;
  int dof = 0, size = 0;  ///< actions, observations of a row
  std::uint64_t seed = 0;
  int first = 0;  ///< number of copy 0 among those that draw from `seed`

  std::vector<Copy> copies = {};
  std::vector<double> references = {};  ///< (count, dof) where the joints should be by now
  std::vector<float> observations = {}, final_observations = {}, rewards = {};
  std::vector<std::uint8_t> terminated = {}, truncated = {}, touching = {};
  std::vector<double> distances = {}, final_distances = {}, final_turns = {};
  std::vector<int> ended = {};                           ///< scratch
  std::vector<double> qpos = {}, ctrl = {}, balls = {};  ///< scratch of as many rows

  void allocate();
  [[nodiscard]] Result<void> check_actions(std::span<const float> actions) const;
  void command(std::span<const float> actions);
  void measure(int i, std::span<const float> action);
  void end(int i);
  void begin_ended();
  void observe(int i);
  [[nodiscard]] Pose tool(int i) const;
  [[nodiscard]] double near_limits(int i) const;
  [[nodiscard]] std::span<double> reference(int i) {
    return {references.data() + std::ptrdiff_t{i} * dof, static_cast<std::size_t>(dof)};
  }
};

}  // namespace mjarm::rl
