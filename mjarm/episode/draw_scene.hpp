#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/episode/options.hpp"
#include "mjarm/model/looks.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/render/camera.hpp"

namespace mjarm::episode {

/// [m] "reach": of the middle of the jaws above that of the object.
inline constexpr double kReachAbove = 0.12;

/// An interval of which a number is drawn uniformly.
struct DrawRange {
  const char* name;  ///< in dataset.json
  const char* unit;
  double lower, upper;
};

/// All of them, for who wants to know what a data set covers.
[[nodiscard]] std::vector<DrawRange> draw_ranges();

/// One object and how it is shown.
struct DrawnObject {
  std::string name;   ///< of body and geom
  Pose X_WB;          ///< where it stands at first
  std::string color;  ///< in English
  std::array<float, 4> rgba;
};

/// A camera that stands; its vertical angle of view is the model's.
struct DrawnView {
  std::string name;  ///< "front" or "side"
  render::CameraView view;
};

/// What one episode begins with, and what is asked for there.
struct DrawnScene {
  std::vector<DrawnObject> objects;
  std::size_t target = 0;     ///< the object that is asked for
  Pose X_WB_place;            ///< pick_place: where it is to be, turned as the arm likes
  std::vector<double> turns;  ///< [rad] reach: of the tool about the vertical, tried in turn
  std::vector<double> q;      ///< (dof,) [rad] where the arm stands
  LooksChange looks;          ///< colours and light
  std::vector<DrawnView> views;
  std::string english, chinese;  ///< the task in words
};

/// Draws episode `number`. Looks come from a stream of their own: what moves is the same whatever
/// is seen.
/// @param robot  with one of the shipped scenes `pick.xml`.
[[nodiscard]] DrawnScene draw_scene(const Robot& robot, const EpisodeOptions& options,
                                    std::uint64_t number);

}  // namespace mjarm::episode
