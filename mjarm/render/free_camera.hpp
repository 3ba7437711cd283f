#pragma once

#include "mjarm/core/pose.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/render/camera.hpp"

namespace mjarm::render {

/// Pose X_WC of a free camera in the world: it looks along -z of C, y of C is up in the picture.
[[nodiscard]] Pose camera_pose(const CameraView& view);

/// [rad] Whole angle of view of free cameras of a model, up and down; pixels are square.
[[nodiscard]] double free_camera_fovy(const Model& model);

}  // namespace mjarm::render
