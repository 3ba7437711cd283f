#include <mujoco/mujoco.h>

#include <cmath>

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/core/messages/model.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/link_inertials.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/point_mass_internal.hpp"

namespace mjarm::detail {

void add_point_mass(mjModel& m, int body, const Eigen::Vector3d& p_B, double mass) {
  using Vector = Eigen::Map<Eigen::Vector3d>;
  mjtNum* const quat = m.body_iquat + 4 * body;
  Vector center(m.body_ipos + 3 * body), moments(m.body_inertia + 3 * body);
  const Eigen::Matrix3d R_BI = to_matrix(Quat(quat[0], quat[1], quat[2], quat[3]));
  const double before = m.body_mass[body], after = before + mass;
  const Eigen::Vector3d middle = (before * center + mass * p_B) / after;
  // Steiner's theorem, about the new centre.
  const Eigen::Matrix3d inertia = R_BI * moments.asDiagonal() * R_BI.transpose() +
                                  point_inertia(before, center - middle) +
                                  point_inertia(mass, p_B - middle);
  const SymmetricEigen axes = symmetric_eigen(inertia);
  Eigen::Matrix3d R = axes.vectors;
  if (R.determinant() < 0) R.col(0) *= -1;
  const Quat turned = to_quat(R);
  m.body_mass[body] = after;
  center = middle;
  moments = axes.values;
  const double wxyz[] = {turned.w(), turned.x(), turned.y(), turned.z()};
  mju_copy4(quat, wxyz);
  m.body_sameframe[body] = mjSAMEFRAME_NONE;
  m.body_simple[body] = 0;
  const MjDataPtr data(mj_makeData(&m));
  mj_setConst(&m, data.get());
}

}  // namespace mjarm::detail
