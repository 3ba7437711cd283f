#include "mjarm/clone/trial.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "mjarm/control/controller.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/track.hpp"
#include "mjarm/model/scene_bodies.hpp"
#include "mjarm/sim/sim.hpp"
#include "mjarm/sim/stepper.hpp"

namespace mjarm::clone {
namespace {

constexpr double kLongest = 20;       // [s]
constexpr double kStill = 1;          // [s] after which it is taken to be done
constexpr double kStillWay = 5e-4;    // [m] of the tool in a row
constexpr double kStillGrip = 0.005;  // of the gripper's command
constexpr int kLeads = 10;            // steps of inverse kinematics a row
constexpr double kHeld = 0.5;         // of the gripper's command

class Trial {
 public:
  Trial(const Robot& robot, const Jaws& jaws, const rl::MixturePolicy& policy,
        const episode::EpisodeOptions& options, const episode::DrawnScene& scene)
      : robot_(robot),
        jaws_(jaws),
        policy_(policy),
        options_(options),
        scene_(scene),
        p_place_(place_of(options, scene)),
        sim_(robot.model),
        tracker_(robot.arm, {.dt = 1.0 / options.fps / kLeads}),
        grip_(robot.arm.gripper.value()) {
    sim_.reset_home();
    sim_.place(robot.arm, scene.q);
    sim_.hold_others(robot.arm);
    const SceneBodies bodies = scene_bodies(robot.model, robot.arm);
    for (const episode::DrawnObject& object : scene.objects) {
      sim_.place_free(object.name, object.X_WB);
      bodies_.push_back(std::ranges::find(bodies.objects, object.name, &SceneObject::name)->body);
    }
    before_ = q_ = sim_.arm_state(robot.arm).q;
    stepper_.emplace(sim_, robot.arm);
  }

  Result<episode::Verdict> run(const StopCheck& stop) {
    auto controller = Controller::create(robot_.model, robot_.arm, ControlMode::computed_torque);
    if (!controller) return fail(std::move(controller.error()));
    std::vector<float> numbers(static_cast<std::size_t>(policy_.net.shape().observations));
    int still = 0;
    for (int row = 0; row < kLongest * options_.fps && still < kStill * options_.fps; ++row) {
      if (is_stopped(stop)) return fail(stopped());
      const Observed seen = look();
      write_observation(seen, numbers);
      const Eigen::VectorXf out = policy_.act(numbers);
      const Answer answer = read_answer(seen, {out.data(), static_cast<std::size_t>(out.size())});
      const bool moves = (answer.X_WT.p - seen.X_WT.p).norm() > kStillWay ||
                         std::abs(answer.grip - seen.grip) > kStillGrip;
      still = moves ? 0 : still + 1;
      if (auto moved = move(answer, *controller); !moved) return fail(std::move(moved.error()));
    }
    return judged();
  }

 private:
  [[nodiscard]] Observed look() const {
    return {.X_WT = fk(robot_.arm, as_span(q_)),
            .grip = told_,
            .objects = poses(),
            .target = scene_.target,
            .p_place = p_place_};
  }

  [[nodiscard]] std::vector<Pose> poses() const {
    std::vector<Pose> out;
    for (const int body : bodies_) out.push_back(sim_.body_pose(body));
    return out;
  }

  /// To where the answer says, within a row: a cubic that begins as fast as the last one ended.
  Result<void> move(const Answer& answer, Controller& controller) {
    JointVec next = q_;
    for (int i = 0; i < kLeads; ++i) next = tracker_.step(answer.X_WT, as_span(next)).q;
    const double h = robot_.model.timestep();
    const auto steps = static_cast<int>(std::llround(1 / (options_.fps * h)));
    const JointVec come = q_ - before_, go = next - q_;  // ways of the rows before and now
    const auto at = [&](int step) {
      if (step < 0) return JointVec(q_ + (double(step) / steps) * come);
      const double s = double(step) / steps, rest = s * (1 - s);
      return JointVec(q_ + s * go + rest * (1 - s) * (come - go));
    };
    for (int i = 0; i < steps; ++i) {
      const double share = double(i + 1) / steps;
      const double grip = told_ + share * (answer.grip - told_);
      sim_.set_ctrl(grip_.id, grip_.ctrl_open + grip * (grip_.ctrl_closed - grip_.ctrl_open));
      const StepReference reference{at(i - 1), at(i), at(i + 1)};
      if (auto done = stepper_->step(sim_, controller, reference, nullptr); !done) return done;
    }
    before_ = q_;
    q_ = next;
    told_ = answer.grip;
    return {};
  }

  /// As it stands, but upright.
  [[nodiscard]] static Eigen::Matrix3d upright(const Eigen::Matrix3d& R,
                                               const Eigen::Vector3d& up) {
    return Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()).toRotationMatrix() * R;
  }

  [[nodiscard]] episode::Verdict judged() const {
    std::vector<Pose> before, after = poses();
    for (const episode::DrawnObject& object : scene_.objects) before.push_back(object.X_WB);
    if (options_.task == "reach") {
      Pose reached = sim_.tool(robot_.arm);
      reached.p = reached * jaws_.center_T;
      const Eigen::Matrix3d R = upright(reached.R, -(reached.R * jaws_.approach_T));
      return episode::judge(reached, {.p = p_place_, .R = R}, before, after);
    }
    const auto target = static_cast<std::ptrdiff_t>(scene_.target);
    const Pose reached = after[scene_.target];
    before.erase(before.begin() + target);
    after.erase(after.begin() + target);
    const Pose goal{.p = p_place_, .R = upright(reached.R, reached.R.col(2))};
    episode::Verdict out = episode::judge(reached, goal, before, after);
    if (told_ > kHeld) out.reason = "still_held";
    return out;
  }

  const Robot& robot_;
  const Jaws& jaws_;
  const rl::MixturePolicy& policy_;
  const episode::EpisodeOptions& options_;
  const episode::DrawnScene& scene_;
  Eigen::Vector3d p_place_;
  Sim sim_;
  Tracker tracker_;
  Gripper grip_;
  std::optional<Stepper> stepper_;
  std::vector<int> bodies_;
  JointVec before_, q_;  ///< references at the last two rows
  double told_ = 0;      ///< command of the gripper
};

}  // namespace

Result<episode::Verdict> try_policy(const Robot& robot, const Jaws& jaws,
                                    const rl::MixturePolicy& policy,
                                    const episode::EpisodeOptions& options,
                                    const episode::DrawnScene& scene, const StopCheck& stop) {
  return Trial(robot, jaws, policy, options, scene).run(stop);
}

}  // namespace mjarm::clone
