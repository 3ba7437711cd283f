#include "mjarm/core/messages/reach.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/gripper_command.hpp"
#include "mjarm/rl/reach_episodes_internal.hpp"
#include "mjarm/rl/reach_options_internal.hpp"

namespace mjarm::rl {
namespace {

constexpr int kTries = 1000;          // of a goal; of a start and a ball a tenth
constexpr double kBallRadius = 0.06;  // [m] as in reach_obstacle.xml
constexpr double kBallRoom = 0.15;    // [m] least distance of the ball's middle from the goal
constexpr double kBallSpread = 0.05;  // [m] of the ball from half way
const Eigen::Vector3d kBallAway(0, 0, 3);

/// Where points are drawn from before the rest of the region's rule is asked.
struct Box {
  Eigen::Vector3d lower, upper;
};
Box box_of(ReachRegion region) {
  if (region == ReachRegion::wide) return {{0.2, -0.8, 0.05}, {1.0, 0.8, 1.0}};
  return {{0.2, -0.5, 0.2}, {0.8, 0.5, 0.3}};
}

Eigen::Vector3d draw_in(Rng& rng, const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) {
  Eigen::Vector3d p;
  for (int i = 0; i < 3; ++i) p[i] = static_cast<float>(rng.uniform(lower[i], upper[i]));
  return p;
}

}  // namespace

/// One world and the state in which everything but the arm's joints stands.
struct ReachEpisodes::Probe {
  Arm arm;
  BatchSim world;
  std::vector<double> qpos, ctrl;  ///< at the start
  std::vector<double> trial;

  /// Whether nothing touches with the arm's joints at `q` (dof,).
  [[nodiscard]] bool clear(std::span<const double> q, const Eigen::Vector3d& ball = kBallAway) {
    trial = qpos;
    for (int i = 0; i < arm.dof(); ++i) trial[arm.joints[i].qpos] = q[i];
    constexpr int kWorld[] = {0};
    world.place(
        kWorld, trial, ctrl,
        world.mocaps() == 1 ? std::span<const double>(ball.data(), 3) : std::span<const double>());
    return world.contacts(0) == 0;
  }
};

Result<ReachEpisodes> ReachEpisodes::create(const Model& model, const Arm& arm,
                                            const ReachOptions& options, const ReachDrive& drive) {
  ReachEpisodes episodes;
  episodes.options_ = options;
  auto world = BatchSim::create(model, arm, 1, 1);
  if (!world) return fail(std::move(world.error()));
  if (options.obstacle && (world->mocaps() != 1 || !frame_pose(model, "obstacle", model.qpos0()))) {
    return fail(Errc::bad_input, text(msg::reach_no_ball, model.file().string()));
  }
  episodes.probe_ = std::make_shared<Probe>(Probe{arm,
                                                  std::move(*world),
                                                  {model.qpos0().begin(), model.qpos0().end()},
                                                  std::vector<double>(model.nu(), 0.0),
                                                  {}});
  if (auto found = episodes.find_start(arm); !found) return fail(std::move(found.error()));
  if (auto settled = episodes.settle(drive); !settled) return fail(std::move(settled.error()));

  IkOptions how{.pos_tol = 1e-4, .rot_tol = 1e-3, .restarts = 8};
  how.task = options.orientation ? IkTask::axis : IkTask::position;
  how.valid = [probe = episodes.probe_](std::span<const double> q) { return probe->clear(q); };
  episodes.solver_ = std::make_shared<const IkSolver>(arm, how);
  Rng rng(0);
  for (int i = 0; i < 10; ++i) {
    const Eigen::Vector3d goal = episodes.draw_goal(rng);
    if (goal.isZero()) continue;
    episodes.some_goal_ = goal;
    return episodes;
  }
  return fail(Errc::impossible, text(msg::reach_no_goal, arm.name, name(options.region)));
}

Result<void> ReachEpisodes::find_start(const Arm& arm) {
  start_ = arm.home;
  if (!options_.start.empty()) {
    if (static_cast<int>(options_.start.size()) != arm.dof()) {
      return fail(Errc::usage,
                  text(msg::reach_start_size, options_.start.size(), arm.name, arm.dof()));
    }
    start_ = joint_vec(options_.start);
  }
  for (int i = 0; i < arm.dof(); ++i) {
    if (start_[i] >= arm.limits.lower[i] && start_[i] <= arm.limits.upper[i]) continue;
    return fail(Errc::usage, text(msg::reach_start_limit, arm.joints[i].name, start_[i]));
  }
  p_start_ = fk(arm, as_span(start_)) * judged_point(options_);
  return {};
}

/// Lets the gripper open where it is to be open, and everything come to rest.
Result<void> ReachEpisodes::settle(const ReachDrive& drive) {
  Probe& probe = *probe_;
  const Arm& arm = probe.arm;
  BatchSim& world = probe.world;
  const bool open = options_.gripper == ReachGripper::open && arm.gripper.has_value();
  if (open) set_grip(*arm.gripper, 0, probe.ctrl);
  bool clear = probe.clear(as_span(start_));
  if (open) {
    constexpr int kChunks = 50, kSteps = 10;  // 1 s of 2 ms
    for (int i = 0; i < kChunks && !world.failed(0); ++i) {
      drive.hold(as_span(start_), world.bias(0), world.ctrl(0));
      world.step(kSteps);
    }
    probe.qpos.assign(world.qpos(0).begin(), world.qpos(0).end());
    probe.ctrl.assign(world.ctrl(0).begin(), world.ctrl(0).end());
    clear = !world.failed(0) && probe.clear(as_span(start_));
  } else if (!options_.guide) {
    drive.hold(as_span(start_), world.bias(0), probe.ctrl);
  }
  if (!clear) return fail(Errc::impossible, text(msg::reach_start_touches));
  return {};
}

bool ReachEpisodes::in_region(const Eigen::Vector3d& p_W) const {
  const Box box = box_of(options_.region);
  if ((p_W.array() <= box.lower.array()).any() || (p_W.array() >= box.upper.array()).any()) {
    return false;
  }
  if (options_.region == ReachRegion::wide) return p_W.head<2>().norm() >= 0.3;
  const double from_start = (p_W - p_start_).norm();
  return from_start > 0.4 && from_start < 0.5;
}

bool ReachEpisodes::reachable(const Eigen::Vector3d& p_W) const {
  const Eigen::Vector3d down(1, -1, -1);
  return solver_->solve({p_W, down.asDiagonal()}, as_span(start_)).has_value();
}

JointVec ReachEpisodes::draw_start(Rng& rng) {
  const JointLimits& limits = probe_->arm.limits;
  for (int i = 0; i < kTries / 10 && options_.start_spread > 0; ++i) {
    JointVec q = start_;
    for (double& value : q) value += rng.uniform(-options_.start_spread, options_.start_spread);
    q = q.cwiseMax(limits.lower).cwiseMin(limits.upper);
    if (probe_->clear(as_span(q))) return q;
  }
  return start_;
}

Eigen::Vector3d ReachEpisodes::draw_goal(Rng& rng) const {
  const Box box = box_of(options_.region);
  for (int i = 0; i < kTries; ++i) {
    const Eigen::Vector3d p = draw_in(rng, box.lower, box.upper);
    if (in_region(p) && reachable(p)) return p;
  }
  return some_goal_;
}

/// Near half way from the start to the goal, but neither in the arm nor near the goal.
Eigen::Vector3d ReachEpisodes::draw_ball(Rng& rng, const ReachEpisode& episode) const {
  const Eigen::Vector3d middle = (p_start_ + episode.goal) / 2;
  const Eigen::Vector3d spread = Eigen::Vector3d::Constant(kBallSpread);
  for (int i = 0; i < kTries / 10; ++i) {
    const Eigen::Vector3d p = draw_in(rng, middle - spread, middle + spread);
    if ((p - episode.goal).norm() < kBallRoom || p.z() < kBallRadius) continue;
    if (probe_->clear(as_span(episode.q), p)) return p;
  }
  return kBallAway;
}

ReachEpisode ReachEpisodes::draw(std::uint64_t seed, int copy, std::uint32_t episode) {
  const std::uint64_t stream =
      (std::uint64_t{options_.held_out} << 63) | (static_cast<std::uint64_t>(copy) << 32) | episode;
  Rng rng(seed, stream);
  ReachEpisode drawn;
  drawn.q = draw_start(rng);
  drawn.goal = draw_goal(rng);
  drawn.ball = options_.obstacle ? draw_ball(rng, drawn) : kBallAway;
  return drawn;
}

void ReachEpisodes::write(const ReachEpisode& episode, std::span<double> qpos,
                          std::span<double> ctrl) const {
  std::copy(probe_->qpos.begin(), probe_->qpos.end(), qpos.begin());
  std::copy(probe_->ctrl.begin(), probe_->ctrl.end(), ctrl.begin());
  for (int i = 0; i < probe_->arm.dof(); ++i) qpos[probe_->arm.joints[i].qpos] = episode.q[i];
}

}  // namespace mjarm::rl
