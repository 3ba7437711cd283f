#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/episode/options.hpp"
#include "mjarm/model/looks.hpp"
#include "mjarm/model/placed_bodies.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/render/camera.hpp"

namespace mjarm::episode {

/// An interval of which a number is drawn uniformly.
struct DrawRange {
  const char* name;  ///< in dataset.json
  const char* unit;
  double lower, upper;
};

/// All of a task, for who wants to know what a data set covers; none of a task that is none.
[[nodiscard]] std::vector<DrawRange> draw_ranges(std::string_view task);

/// One object and how it is shown.
struct DrawnObject {
  std::string name;   ///< of its body
  Pose X_WB;          ///< where it stands at first
  std::string color;  ///< in English
  std::array<float, 4> rgba;
};

/// A camera that stands; its vertical angle of view is the model's.
struct DrawnView {
  std::string name;  ///< "front" or "side"
  render::CameraView view;
};

/// A joint of the scene that is not the arm's, and where it stands at first.
struct DrawnJoint {
  std::string name;
  double value = 0;  ///< [rad or m]
};

/// What one episode begins with.
struct DrawnScene {
  std::vector<DrawnObject> objects;
  std::size_t target = 0;  ///< the object that is asked for
  /// [m] In the world, where the task is about a place: pick_place: of the object; reach: of the
  /// middle of the jaws.
  std::optional<Eigen::Vector3d> p_goal;
  std::vector<PlacedBody> places;  ///< furniture
  std::vector<DrawnJoint> joints;
  std::vector<double> q;  ///< (dof,) [rad] where the arm stands
  LooksChange looks;      ///< colours and light
  std::vector<DrawnView> views;
  std::string english, chinese;  ///< the task in words
};

/// The robot in the scene of the task, as its file has it.
/// @return check()'s error, or load_robot()'s.
[[nodiscard]] Result<Robot> load_task_robot(const EpisodeOptions& options);

/// Draws episode `number`. Looks come from a stream of their own: what moves is the same whatever
/// is seen.
/// @param robot    load_task_robot().
/// @param options  whose check() was successful.
[[nodiscard]] DrawnScene draw_scene(const Robot& robot, const EpisodeOptions& options,
                                    std::uint64_t number);

}  // namespace mjarm::episode
