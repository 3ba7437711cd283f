// From the camera to the can in the tray: look, plan, execute; and what each layer answers when it
// cannot.
#include <cstdio>

#include "mjarm/core/rotation.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/planning/planning_world.hpp"
#include "mjarm/session/pick_and_place.hpp"
#include "mjarm/session/see_scene.hpp"

int main() {
  using namespace mjarm;
  const auto robot = load_robot("universal_robots_ur5e/pick.xml");
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  const auto& [model, arm] = *robot;
  auto eye = session::SceneEye::open(*robot, "rgbd");
  if (!eye && eye.error().code == Errc::not_available) {
    return std::printf("no picture on this machine: %s\n", eye.error().what.c_str()), 0;
  }
  if (!eye) return std::fprintf(stderr, "%s\n", eye.error().what.c_str()), 1;
  const session::Look look = [&](const SceneState& scene, std::span<const double> q) {
    return eye->look(scene, q);
  };

  // Looks, plans, executes, notices by fingers and joints what goes wrong, and tries again.
  Sim sim(model);
  sim.reset_home();
  const Pose place{.p = {0.56, -0.33, 0.256}};
  const program::PickTask task{.object = "can", .place = {{.X_WB = place, .any_turn = true}}};
  const auto done = session::pick_and_place(*robot, sim, look, task);
  if (!done) return std::fprintf(stderr, "%s\n", done.error().what.c_str()), 1;
  const double off = (frame_pose(model, "can", sim.qpos())->p - place.p).norm();
  std::printf("%s with %zu grasp, can %s than 2 mm from its place\n",
              done->done ? "done" : "given up", done->tries.size(), off < 0.002 ? "less" : "more");

  // It stands behind the fence now: the camera cannot see it.
  const auto again = session::pick_and_place(*robot, sim, look, task);
  const bool unseen =
      again && again->failure && again->failure->code == program::PickErrc::not_seen;
  std::printf("camera: %s\n", unseen ? again->failure->what.c_str() : "seen");

  const auto home = as_span(arm.home);
  auto world = PlanningWorld::create(*robot);
  const Pose into_table{{0.5, -0.33, 0.15}, from_euler({3.14159265, 0, 0})};
  const auto path = world->plan(home, into_table);
  std::printf("planner: %s\n", path ? "a path" : path.error().what.c_str());
  const auto q = IkSolver(arm).solve({.p = {1.5, 0, 0.3}}, home);
  std::printf("inverse kinematics: %s\n", q ? "an answer" : describe(q.error(), arm).c_str());
  return done->done && off < 0.002 && unseen && !path && !q ? 0 : 1;
}
