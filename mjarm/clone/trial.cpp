#include "mjarm/clone/trial.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "mjarm/clone/observation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/track.hpp"

namespace mjarm::clone {
namespace {

constexpr double kLongest = 20;       // [s]
constexpr double kStill = 1;          // [s] after which it is taken to be done
constexpr double kStillWay = 5e-4;    // [m] of the tool in a row
constexpr double kStillGrip = 0.005;  // of the gripper's command
constexpr int kLeads = 10;            // steps of inverse kinematics a row

Observed look(const episode::TaskWorld& world) {
  episode::TaskRow row = world.row();
  return {.X_WT = fk(world.robot().arm, as_span(world.reference())),
          .grip = row.grip,
          .objects = std::move(row.objects),
          .target = world.scene().target,
          .p_place = *world.scene().p_goal};
}

/// Joints and gripper that an answer asks for.
std::vector<double> action_of(const Answer& answer, const Tracker& tracker, JointVec q) {
  for (int i = 0; i < kLeads; ++i) q = tracker.step(answer.X_WT, as_span(q)).q;
  std::vector<double> out(q.data(), q.data() + q.size());
  out.push_back(answer.grip);
  return out;
}

episode::Verdict judged(const episode::TaskWorld& world) {
  episode::Verdict out = world.verdict();
  if (world.options().task == "reach") return out;
  const Pose X_WB = world.row().objects[world.scene().target];
  out.position = (X_WB.p - *world.scene().p_goal).norm();
  if (out.success() && !(out.position <= episode::kAtGoal)) out.reason = "off_goal";
  return out;
}

}  // namespace

Result<episode::Verdict> try_policy(episode::TaskWorld& world, std::uint64_t number,
                                    const rl::MixturePolicy& policy, const StopCheck& stop) {
  const int fps = world.options().fps;
  const Tracker tracker(world.robot().arm, {.dt = 1.0 / fps / kLeads});
  std::vector<float> numbers(static_cast<std::size_t>(policy.net.shape().observations));
  world.reset(number);
  int still = 0;
  for (int row = 0; row < kLongest * fps && still < kStill * fps; ++row) {
    if (is_stopped(stop)) return fail(stopped());
    const Observed seen = look(world);
    write_observation(seen, numbers);
    const Eigen::VectorXf out = policy.act(numbers);
    const Answer answer = read_answer(seen, {out.data(), static_cast<std::size_t>(out.size())});
    const bool moves = (answer.X_WT.p - seen.X_WT.p).norm() > kStillWay ||
                       std::abs(answer.grip - seen.grip) > kStillGrip;
    still = moves ? 0 : still + 1;
    const std::vector<double> action = action_of(answer, tracker, world.reference());
    if (auto done = world.step(action); !done) return fail(std::move(done.error()));
  }
  return judged(world);
}

}  // namespace mjarm::clone
