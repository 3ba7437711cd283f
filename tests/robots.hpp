#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/describe.hpp"
#include "mjarm/model/dynamics.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/model.hpp"

/// What tests of whole robots share: loading, finding the arm, random configurations.
namespace mjarm::testing {

/// Folder of the shipped models. @throws std::runtime_error where it is not found.
inline std::filesystem::path models_folder() {
  const auto scene = find_model_file("ur5e");
  if (!scene) throw std::runtime_error(scene.error().what);
  return scene->parent_path().parent_path();
}

/// A model by its path. @throws std::runtime_error with the loader's message.
inline Model load(const std::filesystem::path& file) {
  auto model = Model::load(file);
  if (!model) throw std::runtime_error(model.error().what);
  return std::move(*model);
}

/// The arm of a model. @throws std::runtime_error with the finder's message.
inline Arm arm_of(const Model& model, const std::string& tip = {}) {
  auto arm = find_arm(model, {.tip = tip});
  if (!arm) throw std::runtime_error(arm.error().what);
  return std::move(*arm);
}

/// The values of the arm's joints out of a whole configuration of the model.
inline JointVec joints_of(const Arm& arm, std::span<const double> qpos) {
  JointVec q(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) {
    q[i] = qpos[static_cast<std::size_t>(arm.joints[static_cast<std::size_t>(i)].qpos)];
  }
  return q;
}

/// A configuration, uniform within the limits of all joints of a model of hinges and slides.
inline std::vector<double> random_qpos(const Model& model, Rng& rng) {
  std::vector<double> qpos(static_cast<std::size_t>(model.nq()));
  for (const BodyInfo& body : describe(model).bodies) {
    for (const JointInfo& joint : body.joints) {
      qpos[static_cast<std::size_t>(joint.qpos)] = rng.uniform(joint.lower, joint.upper);
    }
  }
  return qpos;
}

/// Random values, uniform in [-size, size].
inline std::vector<double> random_vector(int count, double size, Rng& rng) {
  std::vector<double> values(static_cast<std::size_t>(count));
  for (double& value : values) value = rng.uniform(-size, size);
  return values;
}

/// Half a turn about z: from the URDF's base_link to the world of the UR5e's MJCF and back.
inline Pose half_turn() {
  return {Eigen::Vector3d::Zero(), Eigen::Vector3d(-1, -1, 1).asDiagonal()};
}

}  // namespace mjarm::testing
