#include "apps/bench/robots.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/peers.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/find_arm.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;

constexpr double kPosTol = 1e-4;  // [m]
constexpr double kRotTol = 1e-3;  // [rad]
constexpr double kBeyond = 1e-9;  // [rad or m] peers may round at a limit

/// The file of a robot by name: peers read URDF, so that is taken where there is one.
std::string file_of(const std::string& robot, const fs::path& folder) {
  if (!folder.empty()) return (folder / (robot + ".urdf")).string();
  if (robot == "ur5e") return "universal_robots_ur5e/ur5e.urdf";
  if (robot == "panda") return "franka_emika_panda/panda.urdf";
  return robot;
}

}  // namespace

Result<Robot> load_bench_robot(const RobotChoice& options, const fs::path& folder) {
  const std::string file = file_of(options.robot, folder);
  // The bare flange of the Panda, as in its own URDF: every peer finds that frame.
  const bool bare = options.tip.empty() && folder.empty() && options.robot == "panda";
  return load_robot({.robot = file, .tip = bare ? "panda_link8" : options.tip});
}

Error no_cases(const fs::path& file) {
  return {Errc::bad_input, text(msg::bench_no_cases, file.string())};
}

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

JointVec random_q(const Arm& arm, Rng& rng) {
  JointVec q(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) {
    const double lower = arm.limits.lower[i];
    const double upper = arm.limits.upper[i];
    const double half =
        arm.joints[static_cast<std::size_t>(i)].type == JointType::hinge ? std::numbers::pi : 0.5;
    q[i] = std::isfinite(upper - lower) ? rng.uniform(lower, upper) : rng.uniform(-half, half);
  }
  return q;
}

double stretch_of(const Arm& arm) {
  double stretch = arm.X_JT.p.norm();
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    if (i > 0) stretch += arm.joints[i].X_PJ.p.norm();
    if (arm.joints[i].type == JointType::slide) {
      const auto k = static_cast<Eigen::Index>(i);
      stretch += std::max(std::abs(arm.limits.lower[k]), std::abs(arm.limits.upper[k]));
    }
  }
  return stretch;
}

Result<Pose> mujoco_pose(const Robot& robot, std::span<const double> q) {
  const std::span<const double> qpos0 = robot.model.qpos0();
  std::vector<double> qpos(qpos0.begin(), qpos0.end());
  for (std::size_t i = 0; i < q.size(); ++i) {
    qpos[static_cast<std::size_t>(robot.arm.joints[i].qpos)] = q[i];
  }
  return frame_pose(robot.model, robot.arm.tip, qpos);
}

Result<bool> reaches(const Robot& robot, const Pose& X_WT, const std::vector<double>& q) {
  const Arm& arm = robot.arm;
  if (q.size() != static_cast<std::size_t>(arm.dof())) return false;
  if (!within_limits(arm, q, -kBeyond)) return false;
  const Result<Pose> X = mujoco_pose(robot, q);
  if (!X) return fail(X.error());
  return (X->p - X_WT.p).norm() <= kPosTol && angle_between(X->R, X_WT.R) <= kRotTol;
}

Result<JsonDoc> robot_job(const Robot& robot, int rounds) {
  if (robot.model.format() != ModelFormat::urdf) {
    return fail(Errc::usage, text(msg::bench_peers_urdf, robot.model.file().string()));
  }
  const Arm& arm = robot.arm;
  std::vector<std::string> joints;
  for (const ArmJoint& joint : arm.joints) joints.push_back(joint.name);
  return JsonDoc{{"urdf", fs::absolute(robot.model.file()).string()},
                 {"tip", arm.tip},
                 {"lower", arm.limits.lower},
                 {"upper", arm.limits.upper},
                 {"zero", pose_json(fk(arm, as_span(JointVec(JointVec::Zero(arm.dof())))))},
                 {"joints", joints},
                 {"rounds", rounds}};
}

}  // namespace mjarm::app
