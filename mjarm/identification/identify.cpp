#include "mjarm/identification/identify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/control/step_inverse.hpp"
#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/core/messages/identification.hpp"
#include "mjarm/identification/equations_internal.hpp"
#include "mjarm/model/link_inertials.hpp"
#include "mjarm/model/moved_bodies.hpp"
#include "mjarm/model/step_rule.hpp"

namespace mjarm {
namespace {

using detail::Equations;
using detail::Solution;
using detail::Unknowns;

Estimate estimate(const Solution& solution, int k, double model) {
  if (!solution.known[static_cast<std::size_t>(k)]) {
    return {model, std::numeric_limits<double>::infinity(), false};
  }
  return {model + solution.x[k], std::sqrt(solution.covariance(k, k))};
}

/// The centre of mass is moment over mass; its error by the derivatives of that.
PayloadEstimate payload_of(const Solution& solution, int at) {
  PayloadEstimate out;
  out.mass = estimate(solution, at, 0);
  for (int i = 0; i < 3; ++i) {
    const int k = at + 1 + i;
    Estimate& c = out.center[static_cast<std::size_t>(i)];
    c.known = out.mass.known && solution.known[static_cast<std::size_t>(k)];
    c.value = c.known ? solution.x[k] / out.mass.value : 0;
    const double m = out.mass.value;
    const double variance = (solution.covariance(k, k) - 2 * c.value * solution.covariance(k, at) +
                             c.value * c.value * solution.covariance(at, at)) /
                            (m * m);
    c.error =
        c.known ? std::sqrt(std::max(0.0, variance)) : std::numeric_limits<double>::infinity();
  }
  return out;
}

/// (10,) Parameters of second degree of a point mass, which follow from those of first degree.
Eigen::VectorXd second_degree(const Solution& solution, int at) {
  const double mass = solution.x[at];
  if (!(mass > 0)) return Eigen::VectorXd::Zero(kInertialSize);
  return Inertial{.inertia = point_inertia(mass, solution.x.segment<3>(at + 1) / mass)}.vector();
}

Identification told(const Robot& robot, const Unknowns& unknowns, const Solution& solution) {
  const Arm& arm = robot.arm;
  const StepRule rule = step_rule(robot.model);
  Identification out;
  for (int j = 0; j < arm.dof(); ++j) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(j)];
    const double dry = rule.friction[static_cast<std::size_t>(joint.dof)].max;
    out.joints.push_back({estimate(solution, unknowns.friction(j), dry),
                          estimate(solution, unknowns.viscous(j), joint.damping),
                          estimate(solution, unknowns.offset(j), 0),
                          estimate(solution, unknowns.inertia(j), joint.armature),
                          solution.rms[j]});
  }
  if (unknowns.has_payload) out.payload = payload_of(solution, unknowns.payload());
  if (unknowns.base) {
    out.base = *unknowns.base;
    out.model_links = out.base.of(parameters_of(robot.model, arm));
    for (int i = 0; i < out.model_links.size(); ++i) {
      out.links.push_back(estimate(solution, unknowns.link(i), out.model_links[i]));
      const int rotor = out.base.kept[static_cast<std::size_t>(i)] - kInertialSize * arm.dof();
      if (rotor >= 0) out.joints[static_cast<std::size_t>(rotor)].inertia = out.links.back();
    }
  }
  out.delay = solution.delay;
  out.rows = solution.rows;
  return out;
}

}  // namespace

std::string describe(const Estimate& estimate) {
  if (!estimate.known) return "-";
  // Two digits of the error say all there is.
  const double digits = std::ceil(1 - std::log10(std::max(estimate.error, 1e-12)));
  const int decimals = static_cast<int>(std::clamp(digits, 0.0, 6.0));
  return fmt::format("{:.{}f} +- {:.{}f}", estimate.value, decimals, estimate.error, decimals);
}

Result<Identification> identify(const Robot& robot, const IdentifyTask& task) {
  constexpr double kSame = 0.01;  // of a time step
  if (task.empty != nullptr && std::abs(task.empty->timestep / task.log->timestep - 1) > kSame) {
    return fail(Errc::bad_input,
                text(msg::identification_other_step, task.empty->timestep, task.log->timestep));
  }
  const Eigen::Vector3d gravity = gravity_of(robot.model);
  Unknowns unknowns{robot.arm.dof(), task.payload || task.empty != nullptr, {}};
  if (task.links || task.empty != nullptr) unknowns.base = base_columns(robot.arm, gravity);
  Equations equations(robot, gravity, unknowns);
  for (const JointLog* log : {task.log, task.empty}) {
    if (log == nullptr) continue;
    const Result<detail::SmoothLog> smoothed = detail::smooth(*log, task.stop);
    if (!smoothed) return fail(smoothed.error());
    equations.add(*smoothed, log == task.log);
  }
  if (!equations.moves()) {
    return fail(Errc::bad_input, text(msg::identification_no_motion, Equations::kSlowest));
  }
  Result<Solution> solution = equations.solve(task.stop);
  constexpr int kRounds = 2;
  for (int i = 0; i < kRounds && unknowns.has_payload && solution; ++i) {
    equations.set_point_inertia(second_degree(*solution, unknowns.payload()));
    solution = equations.solve(task.stop);
  }
  if (!solution) return fail(solution.error());
  return told(robot, unknowns, *solution);
}

}  // namespace mjarm
