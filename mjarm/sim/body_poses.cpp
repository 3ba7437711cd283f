#include "mjarm/sim/body_poses.hpp"

#include "mjarm/core/finite.hpp"
#include "mjarm/core/messages/sim.hpp"
#include "mjarm/sim/raw_internal.hpp"
#include "mjarm/sim/raw_state.hpp"

namespace mjarm {
namespace {

Pose pose_in(const mjData& d, int body) {
  return {Eigen::Map<const Eigen::Vector3d>(d.xpos + 3 * body),
          Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(d.xmat + 9 * body)};
}

}  // namespace

struct BodyPoses::Impl {
  explicit Impl(const Model& of) : model(of), m(*of.raw()), d(mj_makeData(&m)) {
    mj_kinematics(&m, d.get());
  }
  Model model;  ///< keeps `m` alive
  const mjModel& m;
  raw::Data d;
  raw::Data other;  ///< for `moved`, made at its first call
};

BodyPoses::BodyPoses(const Model& model) : impl_(std::make_unique<Impl>(model)) {}
BodyPoses::~BodyPoses() = default;
BodyPoses::BodyPoses(BodyPoses&&) noexcept = default;
BodyPoses& BodyPoses::operator=(BodyPoses&&) noexcept = default;

Result<void> BodyPoses::set(const Snapshot& snapshot) {
  if (!raw::set_state_or_start(impl_->m, snapshot, *impl_->d)) {
    return fail(Errc::bad_input, text(msg::sim_other_snapshot, snapshot.state.size(),
                                      mj_stateSize(&impl_->m, mjSTATE_INTEGRATION)));
  }
  mj_kinematics(&impl_->m, impl_->d.get());
  return {};
}

int BodyPoses::size() const noexcept { return static_cast<int>(impl_->m.nbody); }
Pose BodyPoses::pose(int body) const { return pose_in(*impl_->d, body); }
std::span<const double> BodyPoses::p_W() const noexcept {
  return {impl_->d->xpos, 3 * static_cast<std::size_t>(impl_->m.nbody)};
}
std::span<const double> BodyPoses::quat() const noexcept {
  return {impl_->d->xquat, 4 * static_cast<std::size_t>(impl_->m.nbody)};
}
std::span<const double> BodyPoses::qpos() const noexcept {
  return {impl_->d->qpos, static_cast<std::size_t>(impl_->m.nq)};
}

std::vector<BodyPoses::Moved> BodyPoses::moved(std::span<const int> index,
                                               std::span<const double> values) {
  if (index.size() != values.size() || !all_finite(values)) return {};
  const mjModel& m = impl_->m;
  const mjData& d = *impl_->d;
  if (!impl_->other) impl_->other.reset(mj_makeData(&m));
  mjData& other = *impl_->other;
  raw::place_otherwise(m, d, index, values, other);
  std::vector<Moved> out;
  for (int body = 1; body < m.nbody; ++body) {
    if (!raw::same_place(other, d, body)) out.push_back({body, pose_in(other, body)});
  }
  return out;
}

}  // namespace mjarm
