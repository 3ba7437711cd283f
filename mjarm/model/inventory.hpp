#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mjarm/model/model.hpp"

namespace mjarm {

/// A joint as the file has it.
struct JointEntry {
  std::string name;  ///< "" where the file gives none
  std::string type;  ///< "free", "ball", "slide" or "hinge"
  bool limited = false;
  double lower = 0;            ///< [rad or m] where limited
  double upper = 0;            ///< [rad or m] where limited
  bool force_limited = false;  ///< the file bounds its torque, at the joint or at an actuator
};

/// A body with what hangs on it.
struct BodyEntry {
  std::string name;
  int parent = 0;     ///< index in ModelInventory::bodies; the world (0) is its own parent
  int depth = 0;      ///< 0 for the world
  double mass = 0;    ///< [kg] without its children
  int geoms = 0;      ///< all of them
  int colliding = 0;  ///< those that can touch something
  std::vector<JointEntry> joints;
  std::vector<std::string> sites;
};

/// An actuator as the file has it. Ranges are infinite where the file sets none.
struct ActuatorEntry {
  std::string name;
  std::string target;                       ///< name of the joint, tendon, site or body it acts on
  double ctrl_lower = 0, ctrl_upper = 0;    ///< of its first control
  double force_lower = 0, force_upper = 0;  ///< [N or N m]
};

/// What is in a model, in the order of the file; for people to read.
struct ModelInventory {
  std::vector<BodyEntry> bodies;  ///< world first, parents before children
  std::vector<ActuatorEntry> actuators;
  std::vector<std::string> keyframes;
  int joints = 0, geoms = 0, sites = 0, sensors = 0, tendons = 0, meshes = 0, equalities = 0;
  double mass = 0;  ///< [kg] of everything
};
[[nodiscard]] ModelInventory inventory(const Model& model);

/// The MuJoCo library this program runs with.
struct MujocoLibrary {
  std::string version;         ///< as the library says, e.g. "4.0.1"
  std::string built_against;   ///< as the headers said when mjarm was built
  std::filesystem::path file;  ///< where it was loaded from; empty where unknown
};
[[nodiscard]] MujocoLibrary mujoco_library();

}  // namespace mjarm
