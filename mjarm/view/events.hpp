#pragma once

#include <Eigen/Core>
#include <string>
#include <variant>

namespace mjarm::view {

/// The user paused the simulation or lets it go on.
struct PauseEvent {
  bool paused = false;
};
/// A paused simulation shall make so many steps; negative: go back.
struct StepEvent {
  int steps = 1;
};
/// The simulation shall run at this speed.
struct SpeedEvent {
  double speed = 1;  ///< simulated seconds a second, > 0
};
/// The simulation shall begin anew.
struct ResetEvent {};
/// The user pushes a body; comes with every frame while he does.
struct PushEvent {
  int body = -1;                                       ///< number in the model
  std::string name = {};                               ///< of the body; empty where it has none
  Eigen::Vector3d point_W = Eigen::Vector3d::Zero();   ///< [m] where it is held, in the world
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();   ///< [N] at the body's centre of mass
  Eigen::Vector3d torque_W = Eigen::Vector3d::Zero();  ///< [N m] about it, that of the force too
};
/// The user let the body go.
struct ReleaseEvent {
  int body = -1;
};
/// The user double-clicked a body; -1 where there was none.
struct SelectEvent {
  int body = -1;
  int geom = -1;
  std::string body_name = {};
  std::string geom_name = {};
  Eigen::Vector3d point_W = Eigen::Vector3d::Zero();  ///< [m] the point that was hit
};
/// The user moved the slider of a joint.
struct JointEvent {
  int dof = -1;            ///< row of qvel
  std::string joint = {};  ///< its name
  double value = 0;        ///< [rad or m] where it shall go
};
/// The user used an item of one of the application's panel sections.
struct PanelEvent {
  int id = -1;       ///< of the item
  double value = 0;  ///< see `PanelItem`
};
/// The user wants the target of the tool shown, or put away.
struct TargetEvent {};
/// The user of a page leads the tool: what he asks for from now on, in shares of the full speed,
/// each from -1 to 1. Comes again and again as long as it is not zero.
struct LeadEvent {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();
  double grip = 0;  ///< 1: the gripper closes; -1: it opens
};
/// A picture of the window was written, or could not be.
struct ScreenshotEvent {
  std::string file = {};
  std::string error = {};  ///< empty where it was written
};

/// What the user did in a window, for the application to act on.
using ViewEvent =
    std::variant<PauseEvent, StepEvent, SpeedEvent, ResetEvent, PushEvent, ReleaseEvent,
                 SelectEvent, JointEvent, PanelEvent, TargetEvent, LeadEvent, ScreenshotEvent>;

}  // namespace mjarm::view
