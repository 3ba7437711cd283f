#include <array>
#include <string>

#include "apps/mjarm/commands/program_run.hpp"
#include "apps/mjarm/demos/demo_stage.hpp"
#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/demos/program_demo.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/session/see_scene.hpp"

namespace mjarm::app {
namespace {

struct PickScene {
  const char* robot;
  const char* scene;
};
constexpr std::array<PickScene, 2> kScenes = {
    {{"ur5e", "universal_robots_ur5e/pick.xml"}, {"panda", "franka_emika_panda/pick.xml"}}};

}  // namespace

Result<Report> run_pick_place(const DemoOptions& options) {
  const auto scene = std::ranges::find(kScenes, options.robot.robot, &PickScene::robot);
  if (scene == kScenes.end()) return fail(Errc::usage, text(msg::demo_own_scenes, "pick_place"));
  Result<program::Program> program = demo_program("pick_place");
  if (!program) return fail(std::move(program.error()));
  program->scene = scene->scene;
  if (options.control) program->control = options.control;
  Result<Robot> robot = program::load_program_robot(*program, "pick_place.yaml");
  if (!robot) return fail(std::move(robot.error()));
  const auto loaded = program::plan_loaded("pick_place.yaml", std::move(*program),
                                           std::move(*robot), interrupted, session::see_scene);
  return loaded ? run_demo_plan(*loaded, options) : fail(loaded.error());
}

}  // namespace mjarm::app
