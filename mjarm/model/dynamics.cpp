#include "mjarm/model/dynamics.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cassert>
#include <vector>

namespace mjarm {

struct Dynamics::Impl {
  explicit Impl(Model the_model)
      : model(std::move(the_model)),
        data(mj_makeData(model.raw())),
        mass(model.nv(), model.nv()),
        force(model.nv()),
        rest(static_cast<std::size_t>(model.nv()), 0.0) {}
  ~Impl() { mj_deleteData(data); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  /// Everything that depends on positions alone and that the functions below read. Controllers ask
  /// several things about one state, so what is known of it already is kept.
  void set_position(std::span<const double> qpos) {
    const mjModel* m = model.raw();
    assert(qpos.size() == static_cast<std::size_t>(m->nq));
    if (position_known && std::equal(qpos.begin(), qpos.end(), data->qpos)) return;
    std::copy(qpos.begin(), qpos.end(), data->qpos);
    position_known = true;
    velocity_known = false;
    mj_kinematics(m, data);
    mj_comPos(m, data);
    mj_flex(m, data);
    mj_tendon(m, data);
    mj_makeM(m, data);
    mj_transmission(m, data);
  }

  /// Velocity-dependent forces, into data->qfrc_bias and data->qfrc_passive.
  void set_velocity(std::span<const double> qvel) {
    assert(qvel.size() == static_cast<std::size_t>(model.nv()));
    if (velocity_known && std::equal(qvel.begin(), qvel.end(), data->qvel)) return;
    std::copy(qvel.begin(), qvel.end(), data->qvel);
    velocity_known = true;
    mj_fwdVelocity(model.raw(), data);
  }

  Model model;
  mjData* data;
  Eigen::MatrixXd mass;
  Eigen::VectorXd force;
  std::vector<double> rest;  ///< no velocity
  bool position_known = false;
  bool velocity_known = false;
};

Dynamics::Dynamics(const Model& model) : impl_(std::make_unique<Impl>(model)) {}
Dynamics::~Dynamics() = default;
Dynamics::Dynamics(Dynamics&&) noexcept = default;
Dynamics& Dynamics::operator=(Dynamics&&) noexcept = default;

const Eigen::MatrixXd& Dynamics::mass_matrix(std::span<const double> qpos) {
  impl_->set_position(qpos);
  mj_fullM(impl_->model.raw(), impl_->data, impl_->mass.data());  // symmetric: order is no matter
  return impl_->mass;
}

const Eigen::VectorXd& Dynamics::gravity(std::span<const double> qpos) {
  impl_->set_position(qpos);
  impl_->set_velocity(impl_->rest);
  std::copy_n(impl_->data->qfrc_bias, impl_->model.nv(), impl_->force.data());
  return impl_->force;
}

const Eigen::VectorXd& Dynamics::bias(std::span<const double> qpos, std::span<const double> qvel) {
  impl_->set_position(qpos);
  impl_->set_velocity(qvel);
  std::copy_n(impl_->data->qfrc_bias, impl_->model.nv(), impl_->force.data());
  return impl_->force;
}

const Eigen::VectorXd& Dynamics::passive(std::span<const double> qpos,
                                         std::span<const double> qvel) {
  impl_->set_position(qpos);
  impl_->set_velocity(qvel);
  const mjModel& m = *impl_->model.raw();
  std::copy_n(impl_->data->qfrc_passive, m.nv, impl_->force.data());
  // Where a file has the actuators compensate gravity, MuJoCo adds that to what they are commanded.
  for (int i = 0; i < m.nv; ++i) {
    if (m.jnt_actgravcomp[m.dof_jntid[i]]) impl_->force[i] += impl_->data->qfrc_gravcomp[i];
  }
  return impl_->force;
}

const Eigen::VectorXd& Dynamics::inverse(std::span<const double> qpos, std::span<const double> qvel,
                                         std::span<const double> qacc) {
  assert(qacc.size() == static_cast<std::size_t>(impl_->model.nv()));
  impl_->set_position(qpos);
  impl_->set_velocity(qvel);
  mj_mulM(impl_->model.raw(), impl_->data, impl_->force.data(), qacc.data());
  impl_->force += Eigen::Map<const Eigen::VectorXd>(impl_->data->qfrc_bias, impl_->model.nv());
  return impl_->force;
}

}  // namespace mjarm
