#include "mjarm/session/posture_rods.hpp"

#include <vector>

#include "mjarm/kinematics/fk.hpp"

namespace mjarm::session {

void add_posture_rods(render::Overlay& overlay, const Arm& arm, const JointVec& q,
                      const render::Rgba& color, double radius) {
  std::vector<Pose> X_WJ(arm.joints.size());
  const Pose X_WT = fk_all(arm, as_span(q), X_WJ);
  std::vector<Eigen::Vector3d> chain;
  for (const Pose& X : X_WJ) chain.push_back(X.p);
  chain.push_back(X_WT.p);
  for (std::size_t i = 1; i < chain.size(); ++i) {
    overlay.capsules.push_back(
        {.from_W = chain[i - 1], .to_W = chain[i], .radius = radius, .color = color});
  }
}

}  // namespace mjarm::session
