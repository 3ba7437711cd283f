#include "mjarm/path/path_failure.hpp"

#include "mjarm/core/messages/path.hpp"
#include "mjarm/core/stop.hpp"

namespace mjarm {
namespace {

struct JointWords {
  std::string name;
  const char* unit;
};

JointWords words(const Arm& arm, int joint) {
  if (joint < 0 || joint >= arm.dof()) return {"?", "rad"};
  const ArmJoint& it = arm.joints[static_cast<std::size_t>(joint)];
  return {it.name, it.type == JointType::slide ? "m" : "rad"};
}

/// [rad/s or m/s] what the joint would have to do.
double speed_of(const PathFailure& failure, const Arm& arm) {
  const bool known = failure.joint >= 0 && failure.joint < arm.dof();
  return failure.amount + (known ? arm.limits.velocity[failure.joint] : 0);
}

std::string describe_cause(const PathFailure& failure, const Arm& arm) {
  const JointWords joint = words(arm, failure.joint);
  switch (failure.code) {
    case PathErrc::joint_limit:
      return text(msg::path_joint_limit, joint.name, failure.amount, joint.unit);
    case PathErrc::singularity:
      return text(msg::path_singularity, describe(failure.kind), joint.name, failure.amount,
                  joint.unit);
    case PathErrc::collision:
      if (failure.pair.geom1.empty()) return text(msg::path_refused);
      return text(msg::path_collision, failure.pair.geom1, failure.pair.geom2,
                  1000 * failure.amount);
    case PathErrc::branch_flip:
      return text(msg::path_flips, joint.name, failure.amount, joint.unit);
    case PathErrc::joint_speed:
      return text(msg::path_joint_speed, joint.name, speed_of(failure, arm), joint.unit,
                  failure.amount);
    case PathErrc::stopped:
      return stopped().what;
    case PathErrc::out_of_reach:
    case PathErrc::inner_void:
    case PathErrc::no_convergence:
    case PathErrc::bad_input:
      break;
  }
  return describe(failure.ik, arm);
}

}  // namespace

std::string_view name(PathErrc code) noexcept {
  switch (code) {
    case PathErrc::out_of_reach:
      return "out_of_reach";
    case PathErrc::inner_void:
      return "inner_void";
    case PathErrc::joint_limit:
      return "joint_limit";
    case PathErrc::singularity:
      return "singularity";
    case PathErrc::collision:
      return "collision";
    case PathErrc::branch_flip:
      return "branch_flip";
    case PathErrc::joint_speed:
      return "joint_speed";
    case PathErrc::stopped:
      return "stopped";
    case PathErrc::bad_input:
      return "bad_input";
    case PathErrc::no_convergence:
      break;
  }
  return "no_convergence";
}

std::string describe(const PathFailure& failure, const Arm& arm) {
  return text(msg::path_stops, 100 * failure.fraction, failure.at, describe_cause(failure, arm));
}

}  // namespace mjarm
