#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mjarm/model/model.hpp"

namespace mjarm {

/// A joint as the file has it.
struct JointInfo {
  std::string name;      ///< "#ID" where the file gives none, here and below
  std::string type;      ///< "hinge", "slide", "ball" or "free"
  Eigen::Vector3d axis;  ///< unit, in the body's frame; of no meaning for ball and free
  bool limited = false;  ///< has stops
  double lower = 0;      ///< [rad or m] only where limited
  double upper = 0;      ///< [rad or m] only where limited
  int qpos = 0;          ///< first index in qpos
  int dof = 0;           ///< first index in qvel
};

/// A shape on a body.
struct GeomInfo {
  std::string name;
  std::string type;       ///< "box", "capsule", "mesh", ...
  bool collides = false;  ///< may touch something (contype or conaffinity is not 0)
  int group = 0;          ///< 0 to 5; viewers show 0, 1 and 2 at first
};

/// A body and what it carries.
struct BodyInfo {
  std::string name;
  int parent = -1;        ///< index in ModelInfo::bodies; -1 for the world
  int depth = 0;          ///< 0 for the world, 1 for its children, ...
  double mass = 0;        ///< [kg]
  bool is_mocap = false;  ///< moved by the program, not by physics
  std::vector<JointInfo> joints;
  std::vector<std::string> sites;
  std::vector<GeomInfo> geoms;
};

/// An actuator and what it drives.
struct ActuatorInfo {
  std::string name;
  std::string drives;          ///< "joint", "tendon", "site", "body", ...
  std::string target;          ///< name of what it drives
  int ctrl = 0;                ///< first row of ctrl
  bool ctrl_limited = false;   ///< ctrl is clamped
  double ctrl_lower = 0;       ///< only where ctrl_limited
  double ctrl_upper = 0;       ///< only where ctrl_limited
  bool force_limited = false;  ///< force is clamped
  double force_lower = 0;      ///< [N or N m] only where force_limited
  double force_upper = 0;      ///< [N or N m] only where force_limited
};

/// A frame that can be asked for by name (`frame_pose`, `--tip`).
struct FrameInfo {
  std::string name;
  bool is_site = false;  ///< else the frame of a body
  std::string body;      ///< body that carries it
};

/// A stored configuration.
struct KeyframeInfo {
  std::string name;
  std::vector<double> qpos;  ///< shape (nq,)
};

/// Everything in a model that a user may want to read, as plain data.
struct ModelInfo {
  std::string name;
  double timestep = 0;            ///< [s]
  Eigen::Vector3d gravity;        ///< [m/s^2] in the world
  double mass = 0;                ///< [kg] of all bodies
  std::vector<BodyInfo> bodies;   ///< the world first, parents before children (depth first)
  std::vector<FrameInfo> frames;  ///< sites, then bodies but the world; only those with a name
  std::vector<ActuatorInfo> actuators;
  std::vector<KeyframeInfo> keyframes;
  std::vector<std::string> sensors;
  std::vector<std::string> cameras;
  int meshes = 0;  ///< how many
};

/// Reads `model` into plain data.
[[nodiscard]] ModelInfo describe(const Model& model);

}  // namespace mjarm
