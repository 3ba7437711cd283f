#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "mjarm/core/pose.hpp"

namespace mjarm::render {

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

/// How a line or a set of segments is drawn.
enum class LineLook {
  automatic,  ///< a tube where there are few pieces (about 100 a picture), else thin
  tube,       ///< always a round tube of the width asked for
  thin,       ///< always of the same width on the screen; costs next to nothing
};

/// A polyline in the world frame W. Points that make no difference to be seen cost nothing.
struct OverlayLine {
  std::vector<Eigen::Vector3d> points_W = {};  ///< [m] fewer than two draw nothing
  double width = 0.003;                        ///< [m] diameter of the tube, > 0
  Rgba color = {0.85F, 0.15F, 0.15F, 1};
  double dash = 0;  ///< [m] length of a dash and of the gap after it; 0 = not dashed
  LineLook look = LineLook::automatic;
  /// [s] shape (n,), ascending: when the line came to each point; a page that plays what is over
  /// draws it so far. Empty = all of it is there all the time.
  std::vector<double> times = {};
};

/// Many separate straight pieces of one kind (the edges of a search tree), in the world frame W.
struct OverlaySegments {
  std::vector<Eigen::Vector3d> ends_W = {};  ///< [m] two a piece; an odd one at the end is left out
  double width = 0.002;                      ///< [m] diameter of the tubes, > 0
  Rgba color = {0.45F, 0.45F, 0.50F, 1};
  LineLook look = LineLook::automatic;
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

/// An ellipsoid in the world frame W, e.g. of manipulability; its axes are those of its frame E.
struct OverlayEllipsoid {
  Pose X_WE = {};
  Eigen::Vector3d semi_axes = Eigen::Vector3d::Constant(0.1);  ///< [m] >= 0; flat ones stay visible
  Rgba color = {0.20F, 0.60F, 0.85F, 0.35F};
};

/// A box in the world frame W; its sides are parallel to the axes of its frame B.
struct OverlayBox {
  Pose X_WB = {};
  Eigen::Vector3d half_sizes = Eigen::Vector3d::Constant(0.05);  ///< [m] > 0
  Rgba color = {0.55F, 0.55F, 0.60F, 0.5F};
};

/// A capsule in the world frame W.
struct OverlayCapsule {
  Eigen::Vector3d from_W = Eigen::Vector3d::Zero();       ///< [m] centre of one end
  Eigen::Vector3d to_W = 0.1 * Eigen::Vector3d::UnitZ();  ///< [m] centre of the other end
  double radius = 0.03;                                   ///< [m] > 0
  Rgba color = {0.55F, 0.55F, 0.60F, 0.5F};
};

/// The model once more with some joints elsewhere: what they move is drawn translucent in one
/// colour, as far as it is not where it is anyway. `ghost_of` makes one for an arm.
struct OverlayGhost {
  std::vector<int> qpos_index = {};  ///< shape (n,), places in the model's qpos; others are ignored
  std::vector<double> qpos = {};     ///< shape (n,) [rad or m] values there
  Rgba color = {0.30F, 0.75F, 0.45F, 0.35F};
  int item = -1;     ///< of a panel, which a click on the ghost uses where it can be clicked on
  double value = 0;  ///< ... with this value
};

/// A text at a point of the world. The font of the renderer knows ASCII only; other characters are
/// shown as `?`. At most 99 characters.
struct OverlayLabel {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< [m]
  std::string text = {};
};

/// What is drawn on top of a model: plain data to which anybody appends, casts no shadow, takes no
/// part in physics. What is not a finite number is left out.
struct Overlay {
  std::vector<OverlaySphere> spheres = {};
  std::vector<OverlayLine> lines = {};
  std::vector<OverlayArrow> arrows = {};
  std::vector<OverlayFrame> frames = {};
  std::vector<OverlayLabel> labels = {};
  std::vector<OverlayEllipsoid> ellipsoids = {};
  std::vector<OverlayBox> boxes = {};
  std::vector<OverlayCapsule> capsules = {};
  std::vector<OverlaySegments> segments = {};
  std::vector<OverlayGhost> ghosts = {};  ///< the first kMaxGhosts are drawn
};

/// Most shapes of an overlay that are drawn: a piece of a line, a dash, a ball and an axis of a
/// frame are one each. Of more, every n-th is drawn, lines staying connected; labels, arrows,
/// frames, boxes and ellipsoids go first.
inline constexpr std::size_t kMaxOverlayShapes = 20000;
inline constexpr std::size_t kMaxGhosts = 8;

/// Most shapes that all of `overlay` can need, without its ghosts.
[[nodiscard]] std::size_t shapes_of(const Overlay& overlay);

/// One line for people where only a part of `overlay` is drawn, in the language in use; empty where
/// all of it is.
[[nodiscard]] std::string overlay_notice(const Overlay& overlay);

/// Adds all of `more` to `overlay`.
void append(Overlay& overlay, const Overlay& more);

}  // namespace mjarm::render
