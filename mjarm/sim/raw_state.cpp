#include "mjarm/sim/raw_state.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace mjarm::raw {
namespace {

bool same_numbers(const mjtNum* a, const mjtNum* b, int count) {
  constexpr double kSamePlace = 1e-6;
  return std::equal(a, a + count, b,
                    [](mjtNum x, mjtNum y) { return std::abs(x - y) < kSamePlace; });
}

}  // namespace

bool set_state(const mjModel& m, const Snapshot& snapshot, mjData& d) {
  if (static_cast<int>(snapshot.state.size()) != mj_stateSize(&m, mjSTATE_INTEGRATION))
    return false;
  mj_setState(&m, &d, snapshot.state.data(), mjSTATE_INTEGRATION);
  return true;
}

bool set_state_or_start(const mjModel& m, const Snapshot& snapshot, mjData& d) {
  if (!snapshot.state.empty()) return set_state(m, snapshot, d);
  mj_resetData(&m, &d);
  return true;
}

void place_otherwise(const mjModel& m, const mjData& at, std::span<const int> index,
                     std::span<const double> values, mjData& d) {
  assert(index.size() == values.size());
  std::copy_n(at.qpos, m.nq, d.qpos);
  std::copy_n(at.mocap_pos, 3 * m.nmocap, d.mocap_pos);
  std::copy_n(at.mocap_quat, 4 * m.nmocap, d.mocap_quat);
  for (std::size_t i = 0; i < index.size(); ++i) {
    if (index[i] >= 0 && index[i] < m.nq) d.qpos[index[i]] = values[i];
  }
  mj_kinematics(&m, &d);
}

bool same_place(const mjData& a, const mjData& b, int body) {
  return same_numbers(a.xpos + 3 * body, b.xpos + 3 * body, 3) &&
         same_numbers(a.xmat + 9 * body, b.xmat + 9 * body, 9);
}

}  // namespace mjarm::raw
