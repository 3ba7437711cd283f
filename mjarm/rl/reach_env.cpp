#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "mjarm/core/messages/reach.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/rl/reach_env_internal.hpp"
#include "mjarm/rl/reach_options_internal.hpp"
#include "mjarm/rl/reach_reward_internal.hpp"

namespace mjarm::rl {
namespace {

constexpr double kCoarse = 0.25;         // [m] that count as 1 in the observation
constexpr double kFine = 0.02;           // [m] half of the fine observation's range
constexpr double kGuideSuccess = 0.005;  // [m]

/// Writes numbers one after the other.
class RowWriter {
 public:
  explicit RowWriter(float* row) : at_(row) {}
  void add(double value) { *at_++ = static_cast<float>(value); }
  void add(const Eigen::Vector3d& v) {
    for (int i = 0; i < 3; ++i) add(v[i]);
  }

 private:
  float* at_;
};

/// Rotation vector in the world that turns the tool's z axis straight down, on the short way.
Eigen::Vector3d turn_down(const Pose& X_WT) {
  const Eigen::Vector3d z = X_WT.R.col(2);
  const Eigen::Vector3d axis(-z.y(), z.x(), 0);  // z x down
  const double sine = axis.norm();
  const double angle = std::atan2(sine, -z.z());
  if (sine > 1e-9) return angle / sine * axis;
  return {angle, 0, 0};  // straight up: any way will do
}

}  // namespace

void ReachEnv::Impl::allocate() {
  const std::size_t n = options.environments;
  dof = arm.dof();
  size = options.guide ? dof + 3
                       : 2 * dof + 18 + (options.orientation ? 3 : 0) + (options.obstacle ? 3 : 0);
  copies.resize(n);
  references.resize(n * dof);
  observations.resize(n * size);
  final_observations.resize(n * size);
  rewards.resize(n);
  for (auto* flags : {&terminated, &truncated, &touching}) flags->resize(n);
  distances.resize(n);
  final_distances.assign(n, kNoDistance);
  final_turns.assign(n, 0.0);
  ended.reserve(n);
  qpos.resize(n * model.nq());
  ctrl.resize(n * model.nu());
  balls.resize(options.obstacle ? 3 * n : 0);
}

Pose ReachEnv::Impl::tool(int i) const {
  Pose X_WT = batch.tool(i);
  X_WT.p = X_WT * judged_point(options);
  return X_WT;
}

double ReachEnv::Impl::near_limits(int i) const {
  const double margin = options.reward.limit_margin;
  double sum = 0;
  for (int k = 0; k < dof; ++k) {
    const double q = batch.qpos(i)[arm.joints[k].qpos];
    const double room = std::min(q - arm.limits.lower[k], arm.limits.upper[k] - q);
    sum += std::clamp(1 - room / margin, 0.0, 1.0);
  }
  return sum;
}

Result<void> ReachEnv::Impl::check_actions(std::span<const float> actions) const {
  const std::size_t wanted = copies.size() * dof;
  if (actions.size() != wanted) {
    return fail(Errc::bad_input, text(msg::reach_action_count, actions.size(), wanted));
  }
  for (std::size_t i = 0; i < wanted; ++i) {
    if (std::isfinite(actions[i])) continue;
    return fail(Errc::bad_input, text(msg::reach_bad_action, i % dof, i / dof));
  }
  return {};
}

void ReachEnv::Impl::command(std::span<const float> actions) {
  for (int i = 0; i < batch.count(); ++i) {
    drive.command(actions.subspan(std::size_t(i) * dof, dof),
                  {batch.qpos(i), batch.qvel(i), batch.bias(i)}, reference(i), batch.ctrl(i));
  }
}

/// Everything that the step just done means for one copy.
void ReachEnv::Impl::measure(int i, std::span<const float> action) {
  Copy& copy = copies[i];
  ++copy.steps;
  terminated[i] = truncated[i] = 0;
  if (batch.failed(i)) {  // where it is now means nothing
    const ReachOutcome worst{
        .distance = 1, .mean_square = 1, .touching = true, .near_limits = 1.0 * dof};
    rewards[i] = static_cast<float>(reward_of(options.reward, worst, false));
    touching[i] = 0;
    terminated[i] = 1;
    distances[i] = final_distances[i] = kNoDistance;
    final_turns[i] = 0;
    return;
  }
  const Pose X_WT = tool(i);
  // The tutorial looks at the tool where it was before the step.
  const Eigen::Vector3d p = options.guide ? copy.judged : X_WT.p;
  copy.judged = X_WT.p;
  ReachOutcome outcome{.distance = (p - copy.episode.goal).norm(),
                       .touching = batch.contacts(i) > 0,
                       .near_limits = near_limits(i)};
  if (options.orientation) outcome.turn = turn_down(X_WT).norm();
  for (const float a : action) {
    const double clamped = std::clamp(a, -1.0F, 1.0F);
    outcome.mean_square += clamped * clamped / dof;
  }
  rewards[i] = static_cast<float>(reward_of(options.reward, outcome, options.orientation));
  touching[i] = outcome.touching ? 1 : 0;
  distances[i] = outcome.distance;
  observe(i);
  if (options.guide && outcome.distance < kGuideSuccess) {
    terminated[i] = 1;
  } else if (copy.steps >= options.episode_steps) {
    truncated[i] = 1;
  }
  if (terminated[i] != 0 || truncated[i] != 0) {
    final_distances[i] = outcome.distance;
    final_turns[i] = outcome.turn;
  }
}

/// Starts the next episode of all copies in `ended`.
void ReachEnv::Impl::begin_ended() {
  const std::size_t nq = model.nq(), nu = model.nu();
  for (std::size_t row = 0; row < ended.size(); ++row) {
    const int i = ended[row];
    Copy& copy = copies[i];
    copy.episode = episodes.draw(seed, first + i, copy.number++);
    copy.steps = 0;
    std::copy(copy.episode.q.begin(), copy.episode.q.end(), reference(i).begin());
    episodes.write(copy.episode, std::span(qpos).subspan(row * nq, nq),
                   std::span(ctrl).subspan(row * nu, nu));
    if (options.obstacle) std::copy_n(copy.episode.ball.data(), 3, balls.data() + 3 * row);
  }
  batch.place(ended, std::span(qpos).first(ended.size() * nq),
              std::span(ctrl).first(ended.size() * nu),
              std::span(balls).first(options.obstacle ? 3 * ended.size() : 0));
  for (const int i : ended) {
    copies[i].judged = tool(i).p;
    observe(i);
  }
}

void ReachEnv::Impl::observe(int i) {
  const Copy& copy = copies[i];
  const auto q = batch.qpos(i);
  RowWriter row(observations.data() + std::ptrdiff_t{i} * size);
  if (options.guide) {
    for (const ArmJoint& joint : arm.joints) row.add(q[joint.qpos]);
    row.add(copy.episode.goal);
    return;
  }
  const JointVec middle = (drive.lower() + drive.upper()) / 2;
  const JointVec half = (drive.upper() - drive.lower()) / 2;
  for (int k = 0; k < dof; ++k) row.add((q[arm.joints[k].qpos] - middle[k]) / half[k]);
  for (int k = 0; k < dof; ++k) row.add(batch.qvel(i)[arm.joints[k].dof] / drive.speed()[k]);
  const Pose X_WT = tool(i);
  const Eigen::Vector3d error = copy.episode.goal - X_WT.p;
  row.add(X_WT.p);
  row.add(X_WT.R.col(0));
  row.add(X_WT.R.col(1));
  row.add(copy.episode.goal);
  row.add(error / kCoarse);
  row.add(error / (error.norm() + kFine));
  if (options.orientation) row.add(turn_down(X_WT));
  if (options.obstacle) row.add(copy.episode.ball - X_WT.p);
}

ReachEnv::ReachEnv(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ReachEnv::~ReachEnv() = default;
ReachEnv::ReachEnv(ReachEnv&&) noexcept = default;
ReachEnv& ReachEnv::operator=(ReachEnv&&) noexcept = default;

Result<Model> reach_model(const ReachOptions& options) {
  auto scene = find_model_file("panda");
  if (!scene) return fail(std::move(scene.error()));
  if (options.obstacle) scene->replace_filename("reach_obstacle.xml");
  return Model::load(*scene);
}

Result<ReachEnv> ReachEnv::create(const Model& model, const ReachOptions& options) {
  if (auto fine = check(options); !fine) return fail(std::move(fine.error()));
  auto arm = find_arm(model);
  if (!arm) return fail(std::move(arm.error()));
  if (options.guide && (arm->dof() != 7 || arm->tip != "hand_tcp")) {
    return fail(Errc::usage, text(msg::reach_guide_arm, arm->name));
  }
  auto drive = ReachDrive::create(*arm, options, options.frame_skip * model.timestep());
  if (!drive) return fail(std::move(drive.error()));
  auto episodes = ReachEpisodes::create(model, *arm, options, *drive);
  if (!episodes) return fail(std::move(episodes.error()));
  auto batch = BatchSim::create(model, *arm, options.environments, options.threads);
  if (!batch) return fail(std::move(batch.error()));
  ReachEnv env(std::make_unique<Impl>(Impl{model, std::move(*arm), options, std::move(*drive),
                                           std::move(*episodes), std::move(*batch)}));
  env.impl_->allocate();
  if (auto begun = env.reset(0); !begun) return fail(std::move(begun.error()));
  return env;
}

Result<void> ReachEnv::reset(std::uint64_t seed) { return reset(seed, 0); }

Result<void> ReachEnv::reset(std::uint64_t seed, int first) {
  Impl& env = *impl_;
  env.seed = seed;
  env.first = first;
  env.ended.clear();
  for (int i = 0; i < count(); ++i) {
    env.copies[i].number = 0;
    env.ended.push_back(i);
  }
  std::fill(env.final_distances.begin(), env.final_distances.end(), kNoDistance);
  std::fill(env.final_turns.begin(), env.final_turns.end(), 0.0);
  env.begin_ended();
  for (int i = 0; i < count(); ++i) {
    env.rewards[i] = 0;
    env.terminated[i] = env.truncated[i] = env.touching[i] = 0;
    env.distances[i] = (env.copies[i].judged - env.copies[i].episode.goal).norm();
  }
  return {};
}

Result<void> ReachEnv::step(std::span<const float> actions) { return step(actions, {}); }

Result<void> ReachEnv::step(std::span<const float> actions, const StopCheck& stop) {
  constexpr int kWorldSteps = 10000;  // between two questions whether to stop
  Impl& env = *impl_;
  if (auto fine = env.check_actions(actions); !fine) return fine;
  const int chunks = env.drive.every_step() ? env.options.frame_skip : 1;
  for (int k = 0; k < chunks; ++k) {
    env.command(actions);
    const int steps = env.options.frame_skip / chunks;
    const int piece = stop ? std::clamp(kWorldSteps / count(), 1, steps) : steps;
    for (int done = 0; done < steps; done += piece) {
      if (is_stopped(stop)) return fail(stopped());
      env.batch.step(std::min(piece, steps - done));
    }
  }
  env.ended.clear();
  for (int i = 0; i < count(); ++i) {
    env.measure(i, actions.subspan(std::size_t(i) * env.dof, env.dof));
    if (env.terminated[i] == 0 && env.truncated[i] == 0) continue;
    const auto row = env.observations.begin() + std::ptrdiff_t{i} * env.size;
    std::copy_n(row, env.size, env.final_observations.begin() + std::ptrdiff_t{i} * env.size);
    env.ended.push_back(i);
  }
  if (!env.ended.empty()) env.begin_ended();
  return {};
}

int ReachEnv::count() const noexcept { return impl_->batch.count(); }
int ReachEnv::observation_size() const noexcept { return impl_->size; }
int ReachEnv::action_size() const noexcept { return impl_->dof; }
std::span<const float> ReachEnv::observations() const noexcept { return impl_->observations; }
std::span<const float> ReachEnv::rewards() const noexcept { return impl_->rewards; }
std::span<const std::uint8_t> ReachEnv::terminated() const noexcept { return impl_->terminated; }
std::span<const std::uint8_t> ReachEnv::truncated() const noexcept { return impl_->truncated; }
std::span<const float> ReachEnv::final_observations() const noexcept {
  return impl_->final_observations;
}
std::span<const double> ReachEnv::distances() const noexcept { return impl_->distances; }
std::span<const double> ReachEnv::final_distances() const noexcept {
  return impl_->final_distances;
}
std::span<const double> ReachEnv::final_turns() const noexcept { return impl_->final_turns; }
std::span<const std::uint8_t> ReachEnv::touching() const noexcept { return impl_->touching; }
const ReachOptions& ReachEnv::options() const noexcept { return impl_->options; }
const Model& ReachEnv::model() const noexcept { return impl_->model; }
const Arm& ReachEnv::arm() const noexcept { return impl_->arm; }
Eigen::Vector3d ReachEnv::goal(int copy) const { return impl_->copies[copy].episode.goal; }
Pose ReachEnv::tool(int copy) const { return impl_->tool(copy); }
Snapshot ReachEnv::snapshot(int copy) const { return impl_->batch.snapshot(copy); }

}  // namespace mjarm::rl
