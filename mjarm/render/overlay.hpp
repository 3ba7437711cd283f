#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mjarm/core/pose.hpp"

namespace mjarm {

/// A colour, each part in [0, 1]; `a` = 1 is opaque.
struct Rgba {
  float r = 0.5F;
  float g = 0.5F;
  float b = 0.5F;
  float a = 1;

  [[nodiscard]] bool operator==(const Rgba&) const = default;
};

/// A ball in the world frame W.
struct OverlaySphere {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< [m] centre
  double radius = 0.005;                          ///< [m] > 0
  Rgba color = {0.85F, 0.15F, 0.15F, 1};
};

/// A polyline in the world frame W, drawn as a round tube.
struct OverlayLine {
  std::vector<Eigen::Vector3d> points_W = {};  ///< [m] fewer than two draw nothing
  double width = 0.003;                        ///< [m] diameter of the tube, > 0
  Rgba color = {0.85F, 0.15F, 0.15F, 1};
};

/// An arrow in the world frame W.
struct OverlayArrow {
  Eigen::Vector3d from_W = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d to_W = Eigen::Vector3d::UnitZ();   ///< [m] the point of the arrow
  double width = 0.008;                              ///< [m] diameter of the shaft, > 0
  Rgba color = {0.95F, 0.65F, 0.10F, 1};
};

/// The axes of a frame F: x red, y green, z blue.
struct OverlayFrame {
  Pose X_WF = {};
  double length = 0.1;   ///< [m] > 0
  double width = 0.005;  ///< [m] diameter of the axes, > 0
};

/// A text at a point of the world. The font of the renderer knows ASCII only; other characters are
/// shown as `?`. At most 99 characters.
struct OverlayLabel {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< [m]
  std::string text = {};
};

/// What is drawn on top of a model: plain data, casts no shadow, takes no part in physics.
struct Overlay {
  std::vector<OverlaySphere> spheres = {};
  std::vector<OverlayLine> lines = {};
  std::vector<OverlayArrow> arrows = {};
  std::vector<OverlayFrame> frames = {};
  std::vector<OverlayLabel> labels = {};
};

}  // namespace mjarm
