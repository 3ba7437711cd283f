#include <algorithm>

#include "mjarm/episode/studio_internal.hpp"
#include "mjarm/episode/task_internal.hpp"
#include "mjarm/model/gripper_command.hpp"
#include "mjarm/model/looks.hpp"
#include "mjarm/model/scene_bodies.hpp"

namespace mjarm::episode {

namespace {

/// Joints of the scene, before anything else: those of the arm and of free bodies come then.
void put_joints(const Model& model, const DrawnScene& scene, Sim& sim) {
  if (scene.joints.empty()) return;
  std::vector<double> qpos(sim.qpos().begin(), sim.qpos().end());
  const std::vector<double> rest(sim.qvel().size(), 0.0);
  for (const DrawnJoint& joint : scene.joints) qpos[qpos_of(model, joint.name)] = joint.value;
  sim.set_state(qpos, rest);
}

}  // namespace

std::vector<int> place_scene(const Robot& robot, const DrawnScene& scene, Sim& sim) {
  sim.reset_home();
  put_joints(robot.model, scene, sim);
  sim.place(robot.arm, scene.q);
  sim.hold_others(robot.arm);
  const SceneBodies bodies = scene_bodies(robot.model, robot.arm);
  std::vector<int> out;
  for (const DrawnObject& object : scene.objects) {
    sim.place_free(object.name, object.X_WB);
    const auto found = std::ranges::find(bodies.name, object.name);
    out.push_back(static_cast<int>(found - bodies.name.begin()));
  }
  return out;
}

double grip_command(const Arm& arm, const Sim& sim) {
  if (!arm.gripper) return 0;
  return grip_of(*arm.gripper, sim.ctrl());
}

Result<render::OffscreenRenderer> open_pictures(const Robot& robot, const EpisodeOptions& options,
                                                const DrawnScene& scene) {
  const Result<Model> looks = with_looks(robot.model, scene.looks);
  if (!looks) return fail(looks.error());
  return render::OffscreenRenderer::create(*looks, {.width = options.size,
                                                    .height = options.size,
                                                    .quality = render::RenderQuality::low,
                                                    .sites = false});
}

}  // namespace mjarm::episode
