#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "mjarm/render/framing.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::render {

/// What a picture of a motion is about: the corners of boxes round all shapes that are drawn of
/// what moves, with what it stands on, at each of `moments`; and round the solids within its reach.
/// Floors and the like are none. Empty where nothing of the model moves.
/// @param moments  states of `model`; one without numbers is its home.
[[nodiscard]] std::vector<FramedBall> moving_parts(const Model& model,
                                                   std::span<const Snapshot> moments);

/// What has to be in a picture, and what of it must not be hidden.
struct ViewSubject {
  std::vector<FramedBall> balls;
  std::vector<Eigen::Vector3d> marks_W;  ///< [m] what was drawn with the tool
  std::vector<Snapshot> moments;         ///< when it has to be seen; none = nothing hides
  /// Of marks that are read, such as letters: from left to right, a unit vector.
  std::optional<Eigen::Vector3d> right_W = {};
};

/// A free camera with all of it in the picture. Of the headings all round it takes the one from
/// which the model hides least of the marks, and from which they do not lie edge-on; of equally
/// good ones that nearest to the model's own, or to where the marks are read from; then it may also
/// look down more steeply.
/// @param aspect  width of the picture by its height, > 0.
[[nodiscard]] CameraView clear_view(const Model& model, const ViewSubject& subject, double aspect);

}  // namespace mjarm::render
