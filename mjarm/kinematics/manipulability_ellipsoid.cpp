#include "mjarm/kinematics/manipulability_ellipsoid.hpp"

#include <Eigen/Geometry>

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {

VelocityEllipsoid manipulability_ellipsoid(const Arm& arm, std::span<const double> q) {
  // Of J itself, not of J J^T: its square root would lose half the digits near a singularity. Three
  // columns of zeros more change nothing, and give arms of fewer joints all three axes.
  Eigen::MatrixXd J_W = Eigen::MatrixXd::Zero(3, arm.dof() + 3);
  J_W.leftCols(arm.dof()) = fk_jacobian(arm, q).J_W.topRows(3);
  const SingularValues found = singular_values(J_W);
  VelocityEllipsoid out{found.U, found.values};
  if (out.R_WE.determinant() < 0) out.R_WE.col(2) *= -1;
  return out;
}

}  // namespace mjarm
