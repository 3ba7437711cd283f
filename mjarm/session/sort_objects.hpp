#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mjarm/session/pick_and_place.hpp"

namespace mjarm::session {

/// Where the objects of one kind go.
struct SortBin {
  std::vector<std::string> objects = {};      ///< bodies with a free joint
  std::vector<Eigen::Vector3d> spots_W = {};  ///< [m] on its floor, each for one object
};

/// What became of one object.
struct SortedObject {
  std::string name;
  std::size_t bin = 0;              ///< index of its bin
  std::optional<std::size_t> spot;  ///< of its bin, where it is as far as one can see
  std::string what = {};            ///< why it is at none, one line for people
};

/// How objects are sorted. Every default is usable as is.
struct SortOptions {
  PickAndPlaceOptions pick = {};
  double at_spot = 0.03;  ///< [m] > 0 from a spot, within which an object is there
  int chances = 3;        ///< how often an object is tried that cannot be had, >= 1
  /// Called when an object was put down or given up for now. May be empty.
  std::function<void(const SortedObject& object)> after_object = {};
};

/// What came of it.
struct SortOutcome {
  std::vector<SortedObject> objects;  ///< in the order of the bins
  std::vector<PickTry> tries;         ///< all grasps that were executed, in order

  [[nodiscard]] std::size_t placed() const;  ///< objects that are at a spot
};

/// Puts objects into their bins, each at a free spot of its own, one after another by
/// pick_and_place() from where the arm stands: looks, takes the one with the most room about it,
/// puts it down as it rests, turned so that its sides are along x and y, and looks again. What lies
/// at a spot of its bin already stays there. What cannot be had is tried again when something else
/// has been moved; what cannot be seen is known to be where it was put. An arm that is blocked ends
/// it.
/// @param look  as pick_and_place() has it; asked once for each object, and in the end.
/// @return bad_input for an object that is none, and for options out of range; fails as
///         pick_and_place() does.
[[nodiscard]] Result<SortOutcome> sort_objects(const Robot& robot, Sim& sim, const Look& look,
                                               std::span<const SortBin> bins,
                                               const SortOptions& options = {});

}  // namespace mjarm::session
