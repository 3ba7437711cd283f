// The model never changes, the data is what changes; and two ways to hold an arm up.
#include <mujoco/mujoco.h>

#include <cstdio>
#include <memory>
#include <vector>

#include "mjarm/control/controller.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/robot.hpp"

namespace {

/// How far the tool is from home [m], when the arm should have stood still for two seconds.
double error_after_2s(const mjarm::Robot& robot, mjarm::ControlMode mode) {
  const auto& [model, arm] = robot;
  const std::unique_ptr<mjData, decltype(&mj_deleteData)> data(mj_makeData(model.raw()),
                                                               mj_deleteData);
  mj_resetDataKeyframe(model.raw(), data.get(), 0);  // it also puts ctrl to the posture
  auto controller = mjarm::Controller::create(model, arm, mode);
  if (!controller) return 1;
  const auto size = [](int n) { return static_cast<std::size_t>(n); };
  while (data->time < 2) {
    controller->command({data->qpos, size(model.nq())}, {data->qvel, size(model.nv())},
                        mjarm::hold(mjarm::as_span(arm.home)), {data->ctrl, size(model.nu())});
    mj_step(model.raw(), data.get());
  }
  const std::span<const double> q(data->qpos, size(arm.dof()));
  return (mjarm::fk(arm, q).p - mjarm::fk(arm, mjarm::as_span(arm.home)).p).norm();
}

}  // namespace

int main() {
  const auto robot = mjarm::load_robot("ur5e");
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  const mjModel* model = robot->model.raw();
  mjData* data = mj_makeData(model);
  mj_resetDataKeyframe(model, data, 0);
  mj_forward(model, data);
  const mjtNum* tool = data->site_xpos + 3 * mj_name2id(model, mjOBJ_SITE, "attachment_site");
  const double before = tool[0];
  data->qpos[0] += 0.5;
  const double stale = tool[0];
  mj_forward(model, data);
  const double fresh = tool[0];
  mj_deleteData(data);
  std::printf("x of the tool: before %.3f, stale %.3f, mj_forward %.3f m\n", before, stale, fresh);

  const double servo = error_after_2s(*robot, mjarm::ControlMode::servo);
  const double ours = error_after_2s(*robot, mjarm::ControlMode::computed_torque);
  std::printf("held for 2 s: servo %.2f mm off, computed torque %.4f mm\n", 1e3 * servo,
              1e3 * ours);
  return before == stale && fresh < before - 0.1 && ours < 1e-6 && servo > 1e-3 ? 0 : 1;
}
