#include "mjarm/program/start_posture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/servo_range.hpp"

namespace mjarm::program {
namespace {

/// [m] the tool of a good posture is this high above the plane z = 0 of the world.
constexpr double kAboveFloor = 0.1;
/// More dexterity than this is of no use.
constexpr double kEnough = 0.25;
/// [rad or m] two postures are different where a joint differs by more.
constexpr double kDifferent = 0.3;

struct Range {
  double lower;
  double upper;
  [[nodiscard]] double middle() const { return 0.5 * (lower + upper); }
};

/// The limits of a joint, as far as its servo can be told to go there; where that is nowhere,
/// commands are of another unit and say nothing.
Range held_range(const Arm& arm, int i) {
  const Range limits{arm.limits.lower[i], arm.limits.upper[i]};
  const ServoRange servo = servo_range(arm.joints[static_cast<std::size_t>(i)]);
  const Range held{std::max(limits.lower, servo.lower), std::min(limits.upper, servo.upper)};
  return held.lower < held.upper ? held : limits;
}

/// The values from which a joint is drawn: those that it can be held at, at most half a turn
/// (hinge) or 0.5 m (slide) to either side of the value nearest to 0, without the outer tenth.

Range draw_range(const Arm& arm, int i) {
  const double max = arm.joints[i].type == JointType::hinge ? 0.75 * std::numbers::pi : 0.5;
  const auto [lower, upper] = held_range(arm, i);
  const double centre = std::clamp(0.0, lower, upper);
  Range range{std::max(lower, centre - max), std::min(upper, centre + max)};
  const double inset = 0.1 * (range.upper - range.lower);
  return {range.lower + inset, range.upper - inset};
}

double limit_room(const Arm& arm, const JointVec& q) {
  double room = std::numbers::pi;
  for (int i = 0; i < arm.dof(); ++i) {
    const auto [lower, upper] = held_range(arm, i);
    room = std::min({room, q[i] - lower, upper - q[i]});
  }
  return room;
}

/// Length of the stretched arm [m].
double reach_of(const Arm& arm) {
  double length = arm.X_JT.p.norm();
  for (int i = 1; i < arm.dof(); ++i) length += arm.joints[i].X_PJ.p.norm();
  return std::max(length, 1e-3);
}

/// How much a posture is wanted: dexterous, not far from the middle of the joints' ranges, above
/// the floor.
double merit(const Arm& arm, const StartPosture& posture) {
  double twist = 0;
  for (int i = 0; i < arm.dof(); ++i) {
    const Range range = draw_range(arm, i);
    twist += std::abs(posture.q[i] - range.middle()) / std::max(range.upper - range.lower, 1e-9) /
             arm.dof();
  }
  const double height = fk(arm, as_span(posture.q)).p.z();
  return std::min(posture.dexterity, kEnough) / kEnough - twist - (height < kAboveFloor ? 1 : 0);
}

}  // namespace

double dexterity(const Arm& arm, std::span<const double> q) {
  Jacobian J = fk_jacobian(arm, q).J_W;
  J.topRows<3>() /= reach_of(arm);
  if (task_for(arm) == IkTask::pose) return smallest_singular_value(J);
  const Eigen::Matrix3d gram = J.topRows<3>() * J.topRows<3>().transpose();
  return std::sqrt(std::max(0.0, symmetric_eigen(gram).values[0]));
}

std::vector<StartPosture> start_postures(
    const Arm& arm, const std::function<bool(std::span<const double> q)>& valid, Rng& rng,
    const StartOptions& options) {
  const auto posture_at = [&](const JointVec& q) {
    return StartPosture{q, false, dexterity(arm, as_span(q)), limit_room(arm, q)};
  };
  const auto accepted = [&](const JointVec& q) { return !valid || valid(as_span(q)); };
  std::vector<StartPosture> postures;
  StartPosture home = posture_at(arm.home);
  home.is_home = true;
  if (home.dexterity >= options.least_dexterity && home.limit_room >= options.least_limit_room &&
      accepted(home.q)) {
    postures.push_back(home);
  }

  std::vector<std::pair<double, StartPosture>> drawn;
  for (int n = 0; n < options.draws; ++n) {
    JointVec q(arm.dof());
    for (int i = 0; i < arm.dof(); ++i) {
      const Range range = draw_range(arm, i);
      q[i] = rng.uniform(range.lower, range.upper);
    }
    const StartPosture posture = posture_at(q);
    drawn.emplace_back(-merit(arm, posture), posture);
  }
  std::stable_sort(drawn.begin(), drawn.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  const std::size_t max = postures.size() + static_cast<std::size_t>(options.postures);
  for (const auto& [negative_merit, posture] : drawn) {
    if (postures.size() >= max) break;
    const bool known = std::any_of(postures.begin(), postures.end(), [&](const StartPosture& p) {
      return (p.q - posture.q).cwiseAbs().maxCoeff() < kDifferent;
    });
    if (!known && accepted(posture.q)) postures.push_back(posture);
  }
  return postures;
}

}  // namespace mjarm::program
