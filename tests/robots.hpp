#pragma once

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/dynamics.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/model.hpp"

/// What tests of whole robots share: loading, random configurations, a bare MuJoCo state.
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

/// A configuration, uniform within the limits of all (one-degree) joints of a model.
inline std::vector<double> random_qpos(const Model& model, Rng& rng) {
  const mjModel* m = model.raw();
  std::vector<double> qpos(static_cast<std::size_t>(m->nq));
  for (int j = 0; j < m->njnt; ++j) {
    qpos[static_cast<std::size_t>(m->jnt_qposadr[j])] =
        rng.uniform(m->jnt_range[2 * j], m->jnt_range[2 * j + 1]);
  }
  return qpos;
}

/// Random values, uniform in [-size, size].
inline std::vector<double> random_vector(int count, double size, Rng& rng) {
  std::vector<double> values(static_cast<std::size_t>(count));
  for (double& value : values) value = rng.uniform(-size, size);
  return values;
}

/// A bare MuJoCo state, at the keyframe `home` where there is one. The oracle of many tests.
class State {
 public:
  explicit State(const Model& model) : m_(model.raw()), d_(mj_makeData(m_), &mj_deleteData) {
    const int home = mj_name2id(m_, mjOBJ_KEY, "home");
    if (home >= 0) mj_resetDataKeyframe(m_, d_.get(), home);
    mj_forward(m_, d_.get());
  }
  mjData* operator->() const { return d_.get(); }
  [[nodiscard]] mjData* get() const { return d_.get(); }
  /// Steps the simulation for `seconds` [s].
  void run(double seconds) const {
    const double end = d_->time + seconds - m_->opt.timestep / 2;
    while (d_->time < end) mj_step(m_, d_.get());
  }

 private:
  const mjModel* m_;
  std::unique_ptr<mjData, decltype(&mj_deleteData)> d_;
};

/// Half a turn about z: from the URDF's base_link to the world of the UR5e's MJCF and back.
inline Pose half_turn() {
  return {Eigen::Vector3d::Zero(), Eigen::Vector3d(-1, -1, 1).asDiagonal()};
}

}  // namespace mjarm::testing
