#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/episode/options.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm::episode {

/// An object, or the tool, is at its goal within these; nothing else may be moved by more than the
/// last: as `mjarm bench pick` judges.
inline constexpr double kAtGoal = 5e-3;          // [m]
inline constexpr double kTurnedAtGoal = 0.0873;  // [rad] 5 deg
inline constexpr double kOthersMoved = 1e-3;     // [m]

/// How an episode went, by the simulation's own knowledge of the scene.
struct Verdict {
  /// Empty for a success; else the first that applies: a word of program::PickErrc or of
  /// ProgramFault;
  /// "nothing_held", "lost", "blocked"; "contact"; "object_lost", ... (ObjectFault); "off_goal",
  /// "others_moved"; a word of the task (docs/data.md). Words, so that bytes do not depend on the
  /// language.
  std::string reason = {};
  double position = 0;  ///< [m] from the goal at the end
  double rotation = 0;  ///< [rad] likewise
  double others = 0;    ///< [m] farthest that an object that was not asked for was moved
  /// What a task measured beside that, by name in `executed` of `episode.json`; SI units.
  std::vector<std::pair<const char*, double>> facts = {};

  [[nodiscard]] bool success() const { return reason.empty(); }
};

/// Judges where things are at the end.
/// @param X_WB    of what was to get to `goal`.
/// @param before  where the other objects were, @param after  and are.
[[nodiscard]] Verdict judge(const Pose& X_WB, const Pose& goal, std::span<const Pose> before,
                            std::span<const Pose> after);

/// [us] What an episode took, by kind of work. Never part of its bytes.
struct EpisodeTimes {
  double planning = 0, physics = 0, rendering = 0, compression = 0;

  void add(const EpisodeTimes& other) {
    planning += other.planning;
    physics += other.physics;
    rendering += other.rendering;
    compression += other.compression;
  }
};

/// One episode, whole.
struct Episode {
  std::uint64_t number = 0;
  Verdict verdict = {};
  std::string bytes = {};  ///< of its archive, see docs/data.md
  EpisodeTimes times = {};
};

/// Makes episodes, one after another; used by one thread at a time.
class Studio {
 public:
  /// @return bad_input for options out of range; not_available where no OpenGL works here.
  [[nodiscard]] static Result<Studio> open(const EpisodeOptions& options);
  ~Studio();
  Studio(Studio&&) noexcept;
  Studio& operator=(Studio&&) noexcept;

  /// Draws, plans, executes and records episode `number`: a function of the options and `number`,
  /// whatever was made before.
  /// @return an error where the simulation broke down, OpenGL failed, or it was stopped.
  [[nodiscard]] Result<Episode> make(std::uint64_t number, const StopCheck& stop = {});
  /// With the scene of the task.
  [[nodiscard]] const Robot& robot() const;
  /// Of the compiled scene: MuJoCo's own binary of it, so its version counts as well.
  [[nodiscard]] const std::string& model_hash() const;

 private:
  struct Impl;
  explicit Studio(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm::episode
