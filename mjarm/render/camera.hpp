#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm::render {

/// Where a free camera stands, told by the point it looks at, in the world frame W.
struct CameraView {
  Eigen::Vector3d lookat_W =
      Eigen::Vector3d::Zero();  ///< [m] the point in the middle of the picture
  double distance = 2;          ///< [m] from the camera to that point, > 0
  double azimuth = 0;           ///< [rad] heading of the line of sight about z; 0 looks along +x
  double elevation = 0;         ///< [rad] pitch of the line of sight; negative looks down
};

/// Which camera to draw with: the free camera `view` if given, else the model's camera `name` if
/// not empty, else the free camera that the model asks for (`default_view`).
struct Camera {
  std::string name = {};                ///< a camera of the model
  std::optional<CameraView> view = {};  ///< a free camera
};

/// The free camera the model asks for (statistic and visual/global of an MJCF file); where what
/// moves, as it stands at home, would be tiny in it, as in a large room, or far aside, as near as
/// shows that well.
[[nodiscard]] CameraView default_view(const Model& model);

/// Names of the cameras of a model, in its order; those without a name are left out.
[[nodiscard]] std::vector<std::string> camera_names(const Model& model);

/// Checks that `camera` can be used with `model`.
/// @return bad_input that names the cameras there are, or says which number of `view` is bad.
[[nodiscard]] Result<void> check_camera(const Model& model, const Camera& camera);

}  // namespace mjarm::render
