#pragma once

#include <vector>

#include "mjarm/episode/task_internal.hpp"

// The table with box, can and house, on which `reach` and `pick_place` are.
namespace mjarm::episode {

inline constexpr const char* kPickScene = "pick.xml";

/// What is drawn of it.
struct PickTable {
  DrawnScene scene;
  /// [m] Where the target is to be, turned as the arm likes.
  Eigen::Vector3d p_place = Eigen::Vector3d::Zero();
  std::vector<double> turns;  ///< [rad] of the tool about the vertical, to be tried in turn
};

/// @param pattern  the task in words, of colour and object.
[[nodiscard]] PickTable draw_pick_table(const Robot& robot, EpisodeRng& rng, Msg pattern);

[[nodiscard]] std::vector<DrawRange> object_ranges();
[[nodiscard]] std::vector<DrawRange> place_ranges();

}  // namespace mjarm::episode
