#include <algorithm>

#include "mjarm/episode/studio_internal.hpp"
#include "mjarm/model/looks.hpp"
#include "mjarm/model/scene_bodies.hpp"

namespace mjarm::episode {

const char* scene_file(const std::string& robot) {
  return robot == "panda" ? "franka_emika_panda/pick.xml" : "universal_robots_ur5e/pick.xml";
}

Pose jaws_frame(const Jaws& jaws) {
  Pose X_TJ{.p = jaws.center_T};
  X_TJ.R.col(0) = -jaws.side_T();  // close x approach
  X_TJ.R.col(1) = jaws.close_T;
  X_TJ.R.col(2) = jaws.approach_T;
  return X_TJ;
}

std::vector<int> place_scene(const Robot& robot, const DrawnScene& scene, Sim& sim) {
  sim.reset_home();
  sim.place(robot.arm, scene.q);
  sim.hold_others(robot.arm);
  const SceneBodies all = scene_bodies(robot.model, robot.arm);
  std::vector<int> out;
  for (const DrawnObject& object : scene.objects) {
    sim.place_free(object.name, object.X_WB);
    out.push_back(std::ranges::find(all.objects, object.name, &SceneObject::name)->body);
  }
  return out;
}

double grip_command(const Gripper& gripper, const Sim& sim) {
  const double ctrl = sim.ctrl()[static_cast<std::size_t>(gripper.id)];
  return 0.0 + (ctrl - gripper.ctrl_open) / (gripper.ctrl_closed - gripper.ctrl_open);  // no -0
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
