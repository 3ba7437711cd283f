#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// A body, whose pose is given elsewhere.
struct DrawnBody {
  std::string name = {};                           ///< "body 7" where the model has none
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();  ///< [m] centre of mass in the body
  double mass = 0;                                 ///< [kg]
  bool moves = false;                              ///< false for the world and what is fixed to it
};

/// What a geom looks like, and what its size means.
enum class DrawnShape {
  plane,      ///< half lengths along x and y, 0 = endless; its z axis is the normal
  sphere,     ///< radius
  capsule,    ///< radius, half length of the straight part along z
  cylinder,   ///< radius, half height along z
  ellipsoid,  ///< three half axes
  box,        ///< three half sizes
  mesh,       ///< `DrawnGeom::mesh`
};

/// A geom, which moves with its body.
struct DrawnGeom {
  int id = -1;            ///< number in the model
  int body = 0;           ///< number of its body
  std::string name = {};  ///< empty where the model has none
  int group = 0;          ///< 0 to 5; 0 to 2 are drawn at first
  DrawnShape shape = DrawnShape::sphere;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();     ///< [m] see DrawnShape; 0 what is not used
  Pose X_BG = {};                                     ///< in its body
  std::array<float, 4> rgba = {0.5F, 0.5F, 0.5F, 1};  ///< of the material, in the mean of a texture
  int mesh = -1;                                      ///< place in `DrawnModel::meshes`
};

/// Triangles in the frame of their geom.
struct DrawnMesh {
  std::vector<float> xyz = {};              ///< [m] shape (3 n,)
  std::vector<std::uint32_t> corners = {};  ///< shape (3 m,), vertices of each triangle, < n
};

/// A camera of the model; looks along its own -z, y is up.
struct DrawnCamera {
  std::string name = {};  ///< empty where the model has none
  int body = 0;
  Pose X_BC = {};
  double fovy = 0.8;  ///< [rad] whole angle of view, up and down
};

/// A joint of one degree of freedom.
struct DrawnJoint {
  int dof = -1;                                             ///< row of qvel
  int qpos = -1;                                            ///< place in qpos
  std::string name = {};                                    ///< "joint 7" where the model has none
  double lower = -std::numeric_limits<double>::infinity();  ///< [rad or m]
  double upper = std::numeric_limits<double>::infinity();   ///< [rad or m]
  bool angle = true;                                        ///< radians, else metres
};

/// What a model looks like and how it may move, as plain data: for whoever draws it without
/// MuJoCo. Numbers of bodies, geoms and joints are those of the compiled model.
struct DrawnModel {
  std::vector<DrawnBody> bodies = {};  ///< all; the first is the world
  std::vector<DrawnGeom> geoms = {};   ///< all groups, without those that are transparent
  std::vector<DrawnMesh> meshes = {};  ///< those that geoms use; height fields are meshes too
  std::vector<DrawnCamera> cameras = {};
  std::vector<DrawnJoint> joints = {};  ///< hinges and slides
  int left_out = 0;                     ///< geoms that are neither shape nor mesh (sdf)
};

/// Takes time and memory in proportion to the meshes. Meshes are those that MuJoCo draws.
[[nodiscard]] DrawnModel drawn_model(const Model& model);

}  // namespace mjarm
