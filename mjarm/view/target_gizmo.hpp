#pragma once

#include <Eigen/Core>
#include <optional>

#include "mjarm/core/pose.hpp"
#include "mjarm/render/overlay.hpp"
#include "mjarm/view/ray.hpp"

namespace mjarm::view {

/// What of the target can be taken hold of.
enum class GizmoHandle {
  move_x,  ///< arrows: along one axis
  move_y,
  move_z,
  move_yz,  ///< squares: in the plane of two axes
  move_zx,
  move_xy,
  turn_x,  ///< rings: about one axis
  turn_y,
  turn_z,
  move_free,  ///< ball: in the plane of the picture
};

/// Sizes on the screen, as shares of the height of the picture. Every default is usable as is.
struct GizmoOptions {
  double size = 0.16;       ///< from the middle to the points of the arrows, > 0
  double nearness = 0.012;  ///< so near to a handle the mouse holds it, > 0
  bool turns = true;        ///< has rings; false for an arm whose tool is placed by position alone
};

/// A target pose to be dragged with the mouse: three arrows, three rings, three squares and a ball.
/// It knows no window: the mouse is a ray into the world. Nothing jumps: where an axis or the plane
/// of a ring points at the eye, the way of the mouse across the picture is what counts, and rays
/// that meet nothing leave the target where it is. A drag that ends where it began leaves the
/// target as it was.
class TargetGizmo {
 public:
  explicit TargetGizmo(const Pose& X_WT = {}, const GizmoOptions& options = {});

  /// The target X_WT as it stands.
  [[nodiscard]] const Pose& pose() const noexcept { return X_WT_; }
  /// Puts the target elsewhere; lets go of it.
  void set_pose(const Pose& X_WT);
  /// Directions of the handles: the columns of `R_WG`, or the target's own axes where none.
  void set_axes(std::optional<Eigen::Matrix3d> R_WG) { R_WG_ = R_WG; }
  /// How the target is seen; it is as large on the screen as before. Call it before each frame.
  void set_eye(const Eye& eye) { eye_ = eye; }

  /// The handle under the mouse, which is drawn brighter; the one that is held while one is.
  std::optional<GizmoHandle> hover(const Ray& mouse);
  /// Takes hold of the handle under the mouse.
  /// @return false where there is none.
  bool grab(const Ray& mouse);
  /// Moves the target with the mouse, as far as the handle held allows.
  /// @return the pose, which stays as it is where nothing is held.
  const Pose& drag(const Ray& mouse);
  void release() { grip_.reset(); }

  [[nodiscard]] std::optional<GizmoHandle> hovered() const noexcept { return hovered_; }
  [[nodiscard]] std::optional<GizmoHandle> held() const noexcept;
  /// How far it was dragged since `grab` [m, or rad beyond a full turn as well]; 0 if not held.
  [[nodiscard]] double amount() const noexcept;
  /// False for a square that is seen from its edge, and for rings where there are none: they are
  /// neither drawn nor taken hold of.
  [[nodiscard]] bool is_visible(GizmoHandle handle) const;

  /// Appends the handles, in front of all that stands in their way.
  /// @param state  colour of the ball: whether the pose can be reached.
  void draw(render::Overlay& overlay, const render::Rgba& state) const;

 private:
  /// What a drag goes by, set when it begins.
  struct Grip {
    GizmoHandle handle;
    Pose X_start;
    Eigen::Vector3d axis_W;    ///< unit, of the handle
    Eigen::Vector3d plane_W;   ///< unit normal of the plane in which the mouse is followed
    Eigen::Vector3d point_W;   ///< [m] where the mouse met that plane
    Eigen::Vector3d across_W;  ///< amount a metre of way in that plane, where it is linear in it
    bool linear;               ///< the amount is `across_W` times the way
    double flattest;           ///< rays whose sine to that plane is less change nothing
    double reach;              ///< [m] it is never moved further
    double amount = 0;         ///< [m or rad]
  };
  struct Hit {
    GizmoHandle handle;
    double cost;
    Eigen::Vector3d point_W;
  };

  [[nodiscard]] Eigen::Matrix3d axes() const { return R_WG_.value_or(X_WT_.R); }
  [[nodiscard]] double scale() const;
  [[nodiscard]] std::optional<Hit> find(const Ray& mouse) const;
  [[nodiscard]] std::optional<Grip> grip_of(const Hit& hit, const Ray& mouse) const;
  void hold_axis(Grip& grip, const Eigen::Vector3d& sight) const;
  void hold_ring(Grip& grip, const Eigen::Vector3d& sight) const;
  void turn(Grip& grip, const Eigen::Vector3d& met);

  Pose X_WT_;
  GizmoOptions options_;
  std::optional<Eigen::Matrix3d> R_WG_;
  Eye eye_;
  std::optional<GizmoHandle> hovered_;
  std::optional<Grip> grip_;
};

}  // namespace mjarm::view
