#include "mjarm/control/contact_place.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mjarm/core/rng.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/moved_bodies.hpp"
#include "mjarm/model/scene_bodies.hpp"
#include "mjarm/model/surface.hpp"

namespace mjarm {
namespace {

constexpr int kPoints = 100;       // of a body
constexpr double kFriction = 0.5;  // of what touches: sides of the cone to its height
constexpr int kSweeps = 30;
constexpr double kUsualForce = 50;  // [N] deviation: a small lever needs a large force
// By so much of what a contact does the model may be wrong: whole likelihoods of a force of
// hundreds of standard deviations would take the nearest point for certain.
constexpr double kWrongShare = 0.01;

/// Points spread evenly over what is drawn of a body; where nothing is, its centre of mass, pushed
/// along its axes.
std::vector<SurfacePoint> skin_points(const Result<Surface>& skin,
                                      const Eigen::Vector3d& center_B) {
  std::vector<SurfacePoint> out;
  if (const SurfacePoints points(skin ? *skin : Surface{}); points.area() > 0) {
    Rng rng(1);
    for (int i = 0; i < kPoints; ++i) {
      out.push_back(points.draw((i + rng.uniform()) / kPoints, rng));
    }
    return out;
  }
  for (const double sign : {-1.0, 1.0}) {
    for (int axis = 0; axis < 3; ++axis) {
      out.push_back({center_B, sign * Eigen::Vector3d::Unit(axis)});
    }
  }
  return out;
}

/// Edges of the cone of friction, (3, 4) [1], each of length 1.
Eigen::Matrix<double, 3, 4> cone_edges(const Eigen::Vector3d& in_W) {
  const Eigen::Vector3d u = in_W.unitOrthogonal(), w = in_W.cross(u);
  Eigen::Matrix<double, 3, 4> out;
  out << in_W + kFriction * u, in_W - kFriction * u, in_W + kFriction * w, in_W - kFriction * w;
  return out / std::hypot(1.0, kFriction);
}

/// The shares c >= 0 of edges that maximise g c - c H c / 2, by turns.
Eigen::Vector4d best_shares(const Eigen::Matrix4d& H, const Eigen::Vector4d& g) {
  Eigen::Vector4d c = Eigen::Vector4d::Zero();
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int i = 0; i < 4; ++i) {
      if (H(i, i) > 0) c[i] = std::max(0.0, c[i] + (g[i] - H.row(i).dot(c)) / H(i, i));
    }
  }
  return c;
}

}  // namespace

ContactPlaces::ContactPlaces(const Model& model, const Arm& arm) : arm_(arm) {
  const SceneBodies scene = scene_bodies(model, arm);
  for (const MovedBody& body : moved_bodies(model, arm)) {
    const Eigen::Vector3d center_B = body.X_JB.inverse() * body.center_J;
    const auto skin = skin_points(body_surface(model, body.body), center_B);
    for (const SurfacePoint& point : skin) {
      points_.push_back({bodies_.size(), body.X_JB * point.p, -(body.X_JB.R * point.outward),
                         1.0 / static_cast<double>(skin.size())});
    }
    bodies_.push_back({body.joint, scene.name[static_cast<std::size_t>(body.body)]});
  }
}

ContactPlace ContactPlaces::find(const JointVec& q, const NoticedContact& contact) const {
  std::vector<Pose> X_WJ(static_cast<std::size_t>(arm_.dof()));
  fk_all(arm_, as_span(q), X_WJ);
  const double spread = 2 * (1 + kWrongShare * contact.surprise);
  std::vector<double> of_joint(X_WJ.size(), 0.0), best(X_WJ.size(), -1.0);
  std::vector<ContactPlace> places(X_WJ.size());
  for (const Point& point : points_) {
    const auto joint = static_cast<std::size_t>(bodies_[point.body].joint);
    const Eigen::Vector3d p_W = X_WJ[joint] * point.p_J;
    const Eigen::Matrix<double, 3, 4> edges = cone_edges(X_WJ[joint].R * point.in_J);
    Eigen::MatrixXd torques = Eigen::MatrixXd::Zero(arm_.dof(), 4);
    for (std::size_t j = 0; j <= joint; ++j) {
      const ArmJoint& feels = arm_.joints[static_cast<int>(j)];
      const Eigen::Vector3d axis = X_WJ[j].R * feels.axis;
      torques.row(static_cast<Eigen::Index>(j)) =
          (feels.type == JointType::slide ? axis : axis.cross(p_W - X_WJ[j].p)).transpose() * edges;
    }
    const Eigen::Matrix4d H =
        torques.transpose() * contact.information * torques +
        edges.transpose() * edges * (0.5 * spread / (kUsualForce * kUsualForce));
    const Eigen::Vector4d g = torques.transpose() * contact.evidence;
    const Eigen::Vector4d shares = best_shares(H, g);
    const double explained = 2 * g.dot(shares) - shares.dot(H * shares);
    const double weight = point.share * std::exp((explained - contact.surprise) / spread);
    of_joint[joint] += weight;
    if (weight <= best[joint]) continue;
    best[joint] = weight;
    places[joint] = {static_cast<int>(joint), bodies_[point.body].name, p_W, edges * shares};
  }
  return places[static_cast<std::size_t>(std::ranges::max_element(of_joint) - of_joint.begin())];
}

}  // namespace mjarm
