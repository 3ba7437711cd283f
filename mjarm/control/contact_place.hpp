#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mjarm/control/contact_observer.hpp"
#include "mjarm/core/joint_vec.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// Where an arm is touched, as far as its joints tell.
struct ContactPlace {
  int joint = -1;    ///< of the arm, the last one that moves what is touched
  std::string body;  ///< that is touched; `#7`, its number, where it has no name
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();      ///< [m] the likeliest place
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();  ///< [N] that explains most there
};

/// Tells from the torques of a contact which link it is on: a single force that pushes at a point
/// of a link's surface, within a cone of friction about its normal, explains some torques and
/// others not (L. Manuelli, R. Tedrake, IEEE/RSJ IROS 2016, p. 5062; here points are spread over
/// the surfaces once, in place of particles). The link is the one whose points explain most: all
/// links are as likely, all points of a link, and forces of some tens of newtons. Several forces at
/// once have no one place.
class ContactPlaces {
 public:
  ContactPlaces(const Model& model, const Arm& arm);

  /// @param q  (dof,) [rad or m] of the joints when the contact was noticed
  [[nodiscard]] ContactPlace find(const JointVec& q, const NoticedContact& contact) const;

 private:
  struct Point {
    std::size_t body = 0;       ///< index in bodies_
    Eigen::Vector3d p_J, in_J;  ///< in the frame of the body's joint: place, inward normal
    double share = 0;           ///< of the body's surface
  };
  struct Body {
    int joint = -1;
    std::string name;
  };

  Arm arm_;
  std::vector<Body> bodies_;
  std::vector<Point> points_;
};

}  // namespace mjarm
