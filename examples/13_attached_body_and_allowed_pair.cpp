// A cup in the hand goes where the hand goes: what it is attached to and may touch decides on
// paths.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <vector>

#include "mjarm/model/robot.hpp"
#include "mjarm/planning/planning_world.hpp"

namespace {

/// The UR5e with its wall, and a cup on a table where the tool is at `kStart`.
std::filesystem::path scene_with_a_cup() {
  const auto wall = mjarm::find_model_file("universal_robots_ur5e/wall.xml").value();
  const auto file = std::filesystem::temp_directory_path() / "mjarm_example_cup.xml";
  std::ofstream(file) << "<mujoco><include file=\"" << wall.string() << R"("/><worldbody>
    <geom name="table" type="box" size="0.1 0.1 0.04" pos="0.3 -0.45 0.04"/>
    <body name="cup" pos="0.3 -0.45 0.13"><freejoint/>
      <geom name="cup" type="cylinder" size="0.02 0.05"/></body></worldbody></mujoco>)";
  return file;
}

const std::vector<double> kStart = {-4.375, -1.2456, 1.9905, -2.3157, -1.5708, 0};  // [rad]
const std::vector<double> kGoal = {-5.551, -1.2456, 1.9905, -2.3157, -1.5708, 0};

/// Tells the path from start to goal, or why there is none; whether there is one.
bool plan(const char* what, const mjarm::Robot& robot, const mjarm::ContactRules& rules) {
  auto world = mjarm::PlanningWorld::create(robot, {.rules = rules});
  if (!world) return std::printf("%s: %s\n", what, world.error().what.c_str()), false;
  const auto path = world->plan(kStart, std::vector{mjarm::joint_vec(kGoal)});
  if (!path) return std::printf("%s: %s\n", what, path.error().what.c_str()), false;
  return std::printf("%s: %.2f rad\n", what, path->cost), true;
}

}  // namespace

int main() {
  // The scene includes a file outside of its folder.
  const auto robot =
      mjarm::load_robot(scene_with_a_cup().string(), {.load = {.allow_outside = true}});
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  const auto cup = mjarm::attach_in_place(robot->model, robot->arm, "cup", kStart);
  if (!cup) return std::fprintf(stderr, "%s\n", cup.error().what.c_str()), 1;

  // Attached, it overlaps the table that it stands on by a hair.
  const bool stuck = !plan("the cup is attached", *robot, {.attached = {*cup}});
  const bool carried = plan("and may touch the table", *robot,
                            {.attached = {*cup}, .allowed = {{{"cup", "table"}}}});
  return stuck && carried ? 0 : 1;
}
