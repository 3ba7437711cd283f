#include "mjarm/sim/body_poses.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/core/messages/sim.hpp"
#include "mjarm/sim/raw_internal.hpp"

namespace mjarm {
namespace {

constexpr double kSamePlace = 1e-6;  ///< [m], and for entries of rotation matrices

bool same_numbers(const mjtNum* a, const mjtNum* b, int count) {
  return std::equal(a, a + count, b,
                    [](mjtNum x, mjtNum y) { return std::abs(x - y) < kSamePlace; });
}

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
  const int size = mj_stateSize(&impl_->m, mjSTATE_INTEGRATION);
  if (snapshot.state.empty()) {
    mj_resetData(&impl_->m, impl_->d.get());
  } else if (static_cast<int>(snapshot.state.size()) == size) {
    mj_setState(&impl_->m, impl_->d.get(), snapshot.state.data(), mjSTATE_INTEGRATION);
  } else {
    return fail(Errc::bad_input, text(msg::sim_other_snapshot, snapshot.state.size(), size));
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
  const auto finite = [](double value) { return std::isfinite(value); };
  if (index.size() != values.size() || !std::ranges::all_of(values, finite)) return {};
  const mjModel& m = impl_->m;
  const mjData& d = *impl_->d;
  if (!impl_->other) impl_->other.reset(mj_makeData(&m));
  mjData& other = *impl_->other;
  std::copy_n(d.qpos, m.nq, other.qpos);
  std::copy_n(d.mocap_pos, 3 * m.nmocap, other.mocap_pos);
  std::copy_n(d.mocap_quat, 4 * m.nmocap, other.mocap_quat);
  for (std::size_t i = 0; i < index.size(); ++i) {
    if (index[i] >= 0 && index[i] < m.nq) other.qpos[index[i]] = values[i];
  }
  mj_kinematics(&m, &other);
  std::vector<Moved> out;
  for (int body = 1; body < m.nbody; ++body) {
    if (same_numbers(other.xpos + 3 * body, d.xpos + 3 * body, 3) &&
        same_numbers(other.xmat + 9 * body, d.xmat + 9 * body, 9)) {
      continue;
    }
    out.push_back({body, pose_in(other, body)});
  }
  return out;
}

}  // namespace mjarm
