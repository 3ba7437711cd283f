#include "mjarm/episode/task_world.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "mjarm/control/controller.hpp"
#include "mjarm/core/finite.hpp"
#include "mjarm/core/messages/episode.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/episode/plan_chain_internal.hpp"
#include "mjarm/episode/studio_internal.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/gripper_command.hpp"
#include "mjarm/sim/sim.hpp"
#include "mjarm/sim/stepper.hpp"

namespace mjarm::episode {
namespace {

constexpr double kOpenBelow = 0.5;  // command of the gripper

/// The angle of an axis from the vertical [rad].
double tilt(const Eigen::Vector3d& axis, double up) {
  return std::acos(std::clamp(axis.z() * up, -1.0, 1.0));
}

DrawRange range_of(std::string_view task, std::string_view name) {
  const std::vector<DrawRange> all = draw_ranges(task);
  return *std::ranges::find(all, name, [](const DrawRange& one) { return one.name; });
}

}  // namespace

struct TaskWorld::Impl {
  EpisodeOptions options;
  Robot robot;
  Pose X_TJ;
  Sim sim;
  Controller controller;
  Gripper gripper;
  DrawnScene scene = {};
  std::vector<int> bodies = {};
  std::optional<Stepper> stepper = {};
  std::optional<render::OffscreenRenderer> renderer = {};
  JointVec q_ref = {}, v_ref = {};  ///< (dof,) [rad], [rad/s] at this row
  JointVec q_before = {};           ///< a time step before it
  Eigen::Vector3d last_place = {};  ///< [m] subject() in the row before
  long long row = 0;

  /// What the task brings somewhere.
  [[nodiscard]] Pose subject() const {
    if (options.task != "reach") return sim.body_pose(bodies[scene.target]);
    return sim.tool(robot.arm) * X_TJ;
  }

  /// The nearest place where the subject may be.
  [[nodiscard]] Eigen::Vector3d goal(const Pose& X_WS) const {
    if (options.task == "reach") return *scene.p_goal;
    const DrawRange x = range_of(options.task, "place_x"), y = range_of(options.task, "place_y");
    return {std::clamp(X_WS.p.x(), x.lower, x.upper), std::clamp(X_WS.p.y(), y.lower, y.upper),
            scene.p_goal->z()};
  }

  /// Steps from one row to the next.
  [[nodiscard]] long long steps() const {
    const double rate = options.fps * robot.model.timestep();
    return std::llround(static_cast<double>(row + 1) / rate) -
           std::llround(static_cast<double>(row) / rate);
  }
};

TaskWorld::TaskWorld(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TaskWorld::~TaskWorld() = default;
TaskWorld::TaskWorld(TaskWorld&&) noexcept = default;
TaskWorld& TaskWorld::operator=(TaskWorld&&) noexcept = default;

Result<TaskWorld> TaskWorld::open(const EpisodeOptions& options) {
  Result<Robot> robot = load_task_robot(options);
  if (!robot) return fail(std::move(robot.error()));
  if (!draw_scene(*robot, options, 0).p_goal) {
    return fail(Errc::bad_input, text(msg::episode_no_world, options.task));
  }
  const Result<Jaws> jaws = find_jaws(robot->model, robot->arm);
  if (!jaws) return fail(jaws.error());
  auto controller = Controller::create(robot->model, robot->arm, ControlMode::computed_torque);
  if (!controller) return fail(std::move(controller.error()));
  const Gripper gripper = robot->arm.gripper.value();
  Sim sim(robot->model);
  TaskWorld out(std::make_unique<Impl>(Impl{.options = options,
                                            .robot = std::move(*robot),
                                            .X_TJ = jaws_pose(*jaws),
                                            .sim = std::move(sim),
                                            .controller = std::move(*controller),
                                            .gripper = gripper}));
  out.reset(0);
  return out;
}

void TaskWorld::reset(std::uint64_t number) {
  Impl& self = *impl_;
  self.scene = draw_scene(self.robot, self.options, number);
  self.bodies = place_scene(self.robot, self.scene, self.sim);
  self.controller.restart();
  self.stepper.emplace(self.sim, self.robot.arm);
  self.renderer.reset();
  self.q_ref = self.sim.arm_state(self.robot.arm).q;
  self.q_before = self.q_ref;
  self.v_ref = JointVec::Zero(self.q_ref.size());
  self.last_place = self.subject().p;
  self.row = 0;
}

Result<void> TaskWorld::step(std::span<const double> action) {
  Impl& self = *impl_;
  const auto dof = static_cast<std::size_t>(self.q_ref.size());
  if (action.size() != dof + 1 || !all_finite(action)) {
    return fail(Errc::bad_input, text(msg::episode_action, dof + 1));
  }
  const long long steps = self.steps();
  const double T = static_cast<double>(steps) * self.robot.model.timestep();
  const JointVec reach = T * self.robot.arm.limits.velocity;
  const JointVec q0 = self.q_ref, v0 = self.v_ref;
  JointVec q1 = clamp_to_limits(self.robot.arm, action.first(dof));
  q1 = q1.cwiseMax(q0 - reach).cwiseMin(q0 + reach);
  const JointVec v1 = (q1 - q0) / T;
  const double grip0 = grip_command(self.robot.arm, self.sim);
  const double grip1 = std::clamp(action[dof], 0.0, 1.0);
  self.last_place = self.subject().p;
  for (long long i = 1; i <= steps; ++i) {
    // Cubic Hermite: no jump of the velocity, which computed torque would answer with all it has.
    const double u = static_cast<double>(i) / static_cast<double>(steps);
    const JointVec q = q0 + u * u * (3 - 2 * u) * (q1 - q0) + u * (1 - u) * (1 - u) * T * v0 -
                       u * u * (1 - u) * T * v1;
    const double grip = grip0 + u * (grip1 - grip0);
    for (const GripperDrive& drive : self.gripper.drives) {
      self.sim.set_ctrl(drive.id, ctrl_for_grip(drive, grip));
    }
    const StepReference reference{.before = self.q_before, .now = self.q_ref, .next = q};
    if (auto done = self.stepper->step(self.sim, self.controller, reference, nullptr); !done) {
      return done;
    }
    self.q_before = std::exchange(self.q_ref, q);
  }
  self.v_ref = v1;
  ++self.row;
  return {};
}

TaskRow TaskWorld::row() const {
  const Impl& self = *impl_;
  const JointState arm = self.sim.arm_state(self.robot.arm);
  TaskRow out{.q = arm.q,
              .v = arm.v,
              .X_WT = self.sim.tool(self.robot.arm),
              .grip = grip_command(self.robot.arm, self.sim),
              .objects = {}};
  for (const int body : self.bodies) out.objects.push_back(self.sim.body_pose(body));
  return out;
}

Result<render::Image> TaskWorld::picture(std::string_view camera) {
  Impl& self = *impl_;
  const auto view = std::ranges::find(self.scene.views, camera, &DrawnView::name);
  if (view == self.scene.views.end()) {
    std::vector<std::string> names;
    for (const DrawnView& one : self.scene.views) names.push_back(one.name);
    return fail(Errc::bad_input, text(msg::episode_camera, camera, listed(names)));
  }
  if (!self.renderer) {
    auto opened = open_pictures(self.robot, self.options, self.scene);
    if (!opened) return fail(std::move(opened.error()));
    self.renderer = std::move(*opened);
  }
  return self.renderer->draw(self.sim.snapshot(), {.view = view->view});
}

Verdict TaskWorld::verdict() const {
  const Impl& self = *impl_;
  const bool reach = self.options.task == "reach";
  const Pose X_WS = self.subject();
  Verdict out{.reason = {},
              .position = (self.goal(X_WS) - X_WS.p).norm(),
              .rotation = tilt(X_WS.R.col(2), reach ? -1 : 1)};
  for (std::size_t i = 0; i < self.bodies.size(); ++i) {
    if (!reach && i == self.scene.target) continue;
    const Eigen::Vector3d p = self.sim.body_pose(self.bodies[i]).p;
    out.others = std::max(out.others, (p - self.scene.objects[i].X_WB.p).norm());
  }
  // The comparisons are false for what is no number.
  if (!(out.position <= kAtGoal && out.rotation <= kTurnedAtGoal)) {
    out.reason = "off_goal";
  } else if (!((X_WS.p - self.last_place).norm() <= kOthersMoved)) {
    out.reason = "moving";
  } else if (!(grip_command(self.robot.arm, self.sim) < kOpenBelow)) {
    out.reason = "closed";
  } else if (!(out.others <= kOthersMoved)) {
    out.reason = "others_moved";
  }
  return out;
}

const JointVec& TaskWorld::reference() const { return impl_->q_ref; }
const DrawnScene& TaskWorld::scene() const { return impl_->scene; }
const Robot& TaskWorld::robot() const { return impl_->robot; }
const EpisodeOptions& TaskWorld::options() const { return impl_->options; }

}  // namespace mjarm::episode
