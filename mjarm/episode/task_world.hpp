#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/episode/draw_scene.hpp"
#include "mjarm/episode/options.hpp"
#include "mjarm/episode/record.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/render/image.hpp"

namespace mjarm::episode {

/// What the columns of an episode hold in one row.
struct TaskRow {
  JointVec q, v;              ///< (dof,) [rad] and [rad/s] of the arm
  Pose X_WT;                  ///< of the tool
  double grip = 0;            ///< command, 0 open to 1 closed
  std::vector<Pose> objects;  ///< X_WB in the order of the drawn scene
};

/// The scenes and actions of `mjarm record` for somebody else to act in: a policy that learned from
/// its episodes. Between two rows the reference of the joints goes to where the action puts it, at
/// a steady speed at the end, within the limits of the joints; computed torque follows it.
/// Used by one thread at a time. Actions that are the same give the same rows to the last bit.
class TaskWorld {
 public:
  /// Stands in the scene of episode 0.
  /// @return bad_input for options out of range.
  [[nodiscard]] static Result<TaskWorld> open(const EpisodeOptions& options);
  ~TaskWorld();
  TaskWorld(TaskWorld&&) noexcept;
  TaskWorld& operator=(TaskWorld&&) noexcept;

  /// Begins episode `number`: the same scene that Studio::make() draws.
  void reset(std::uint64_t number);
  /// Goes on to the next row, 1 / fps seconds later.
  /// @param action  (dof + 1,) as column action_joint: the joints [rad] and the gripper's command
  ///                there; cut to the limits of position and velocity, and to 0 to 1.
  /// @return bad_input for another number of values, or one that is not finite; an error where the
  ///         simulation broke down.
  [[nodiscard]] Result<void> step(std::span<const double> action);

  [[nodiscard]] TaskRow row() const;
  /// (dof,) [rad] where the joints are to be at this row.
  [[nodiscard]] const JointVec& reference() const;
  /// What a camera of the scene sees, as in the pictures of an episode.
  /// @return bad_input for a name that is none; not_available where no OpenGL works here.
  [[nodiscard]] Result<render::Image> picture(std::string_view camera);
  /// As things stand: the task is done where the object is in the tray, upright, wherever places
  /// are drawn there, or the tool over the object, pointing down, in both turned as it likes; where
  /// it stands still, and the gripper is open. Others as judge() has it. Reasons: "off_goal",
  /// "moving", "closed", "others_moved".
  [[nodiscard]] Verdict verdict() const;

  [[nodiscard]] const DrawnScene& scene() const;
  [[nodiscard]] const Robot& robot() const;
  [[nodiscard]] const EpisodeOptions& options() const;

 private:
  struct Impl;
  explicit TaskWorld(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm::episode
