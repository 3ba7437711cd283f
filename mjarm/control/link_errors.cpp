#include "mjarm/control/link_errors.hpp"

#include <cmath>
#include <vector>

#include "mjarm/control/regressor.hpp"
#include "mjarm/model/link_inertials.hpp"
#include "mjarm/model/moved_bodies.hpp"

namespace mjarm {

LinkErrors::LinkErrors(const Model& model, const Arm& arm, const ModelErrors& errors)
    : arm_(arm), gravity_(gravity_of(model)) {
  const double mass = errors.mass / std::sqrt(3.0), center = errors.center / std::sqrt(3.0);
  const std::vector<MovedBody> bodies = moved_bodies(model, arm);
  columns_.setZero(kInertialSize * arm.dof(), 4 * static_cast<Eigen::Index>(bodies.size()));
  Eigen::Index column = 0;
  for (const MovedBody& body : bodies) {
    const auto put = [&](const Inertial& change) {
      columns_.block<kInertialSize, 1>(kInertialSize * body.joint, column++) = change.vector();
    };
    const Eigen::Vector3d& c = body.center_J;
    const double m = body.mass;
    put({mass * m, mass * m * c, mass * (body.inertia_center_J + point_inertia(m, c))});
    for (int x = 0; x < 3; ++x) {
      const Eigen::Vector3d e = center * Eigen::Vector3d::Unit(x);
      // The derivative of point_inertia(m, c) along e.
      put({0, m * e,
           m * (2 * c.dot(e) * Eigen::Matrix3d::Identity() - c * e.transpose() -
                e * c.transpose())});
    }
  }
}

Eigen::MatrixXd LinkErrors::torques(const JointVec& q, const JointVec& v, const JointVec& a) const {
  return regressor_at(arm_, gravity_, {q, v, a}).links.leftCols(columns_.rows()) * columns_;
}

}  // namespace mjarm
