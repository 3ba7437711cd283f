#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "mjarm/episode/archive_internal.hpp"
#include "mjarm/model/mujoco_library.hpp"
#include "mjarm/render/free_camera.hpp"

namespace mjarm::episode {
namespace {

JsonDoc vector_doc(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

JsonDoc color_doc(const std::array<float, 4>& rgba) {
  return std::vector<double>(rgba.begin(), rgba.end());
}

JsonDoc objects_doc(const DrawnScene& scene) {
  std::vector<JsonDoc> out;
  for (const DrawnObject& object : scene.objects) {
    JsonDoc one = pose_json(object.X_WB);
    one.set("name", object.name);
    one.set("color", object.color);
    one.set("rgba", color_doc(object.rgba));
    out.push_back(std::move(one));
  }
  return out;
}

JsonDoc looks_doc(const LooksChange& looks) {
  std::vector<JsonDoc> geoms, lights;
  for (const auto& geom : looks.geoms) {
    geoms.push_back({{"name", geom.name}, {"rgba", color_doc(geom.rgba)}});
  }
  for (const auto& light : looks.lights) {
    lights.push_back({{"name", light.name},
                      {"direction", vector_doc(light.direction_W)},
                      {"diffuse", vector_doc(light.diffuse)}});
  }
  return {{"geoms", std::move(geoms)}, {"lights", std::move(lights)}};
}

/// The drawn scene; furniture and joints where any were drawn.
JsonDoc scene_doc(const DrawnScene& scene) {
  JsonDoc out{{"objects", objects_doc(scene)},
              {"target", scene.objects[scene.target].name},
              {"start", scene.q},
              {"looks", looks_doc(scene.looks)}};
  std::vector<JsonDoc> places, joints;
  for (const PlacedBody& place : scene.places) {
    JsonDoc one = pose_json(place.X_PB);
    one.set("name", place.body);
    places.push_back(std::move(one));
  }
  for (const DrawnJoint& joint : scene.joints) {
    joints.push_back({{"name", joint.name}, {"value", joint.value}});
  }
  if (!places.empty()) out.set("places", std::move(places));
  if (!joints.empty()) out.set("joints", std::move(joints));
  return out;
}

JsonDoc executed_doc(const Demonstration& done) {
  const Verdict& verdict = done.verdict;
  JsonDoc out{{"tool_error_max", done.tool_error},
              {"joint_error_max", done.joint_error},
              {"goal_position_error", verdict.position},
              {"goal_rotation_error", verdict.rotation},
              {"others_moved", verdict.others}};
  for (const auto& [name, value] : verdict.facts) out.set(name, value);
  return out;
}

/// Pinhole cameras: u = cx + fx * x / -z, v = cy - fy * y / -z of a point (x, y, z) in the camera.
JsonDoc cameras_doc(const Robot& robot, const DrawnScene& scene, int size) {
  const double half = 0.5 * size;
  const double focal = half / std::tan(0.5 * render::free_camera_fovy(robot.model));
  std::vector<JsonDoc> out;
  for (const DrawnView& one : scene.views) {
    out.push_back({{"name", one.name},
                   {"width", size},
                   {"height", size},
                   {"fx", focal},
                   {"fy", focal},
                   {"cx", half},
                   {"cy", half},
                   {"pose", pose_json(render::camera_pose(one.view))}});
  }
  return out;
}

/// The motions, with the joint values of the proved way where there is one.
JsonDoc plan_doc(const program::ProgramPlan& plan) {
  std::vector<JsonDoc> out;
  for (const PlannedMove& move : plan.moves) {
    std::vector<JsonDoc> corners;
    for (const JointVec& q : move.corners) corners.emplace_back(q);
    JsonDoc one{{"word", move.word},
                {"duration", move.trajectory.duration()},
                {"corners", std::move(corners)}};
    if (move.measures) {
      one.set("clearance", move.measures->clearance);
      one.set("singular_value", move.measures->singularity.smallest);
      one.set("limit_room", move.measures->limit_room);
    }
    if (move.close) one.set("close", *move.close);
    out.push_back(std::move(one));
  }
  return {{"duration", plan.moves.empty() ? 0.0 : plan.duration()}, {"motions", std::move(out)}};
}

/// What planning has proved: no contact on any motion that moves the arm, and how near it comes.
JsonDoc certificate_doc(const program::ProgramPlan& plan) {
  double clearance = std::numeric_limits<double>::infinity();
  for (const PlannedMove& move : plan.moves) {
    if (move.measures) clearance = std::min(clearance, move.measures->clearance);
  }
  return {{"proved", !plan.moves.empty() && plan.ok()}, {"clearance", clearance}};
}

}  // namespace

std::string episode_json(const Robot& robot, const Origin& origin, const Task& task,
                         const Demonstration& done) {
  const DrawnScene& scene = task.scene();
  const EpisodeOptions& options = origin.options;
  std::vector<std::string> joints;
  for (const ArmJoint& joint : robot.arm.joints) joints.push_back(joint.name);
  const Verdict& verdict = done.verdict;
  JsonDoc doc{{"schema", kSchema},
              {"task", options.task},
              {"language", {{"en", scene.english}, {"zh", scene.chinese}}},
              {"robot", options.robot},
              {"seed", static_cast<std::size_t>(options.seed)},
              {"number", static_cast<std::size_t>(origin.number)},
              {"size", options.size},
              {"fps", options.fps},
              {"rows", done.samples.size()},
              {"success", verdict.success()},
              {"reason", verdict.reason}};
  doc.set_all({{"model", std::string(robot.model.name())},
               {"model_hash", origin.model_hash},
               {"mujoco", mujoco_library().version},
               {"timestep", robot.model.timestep()},
               {"tool", robot.arm.tip},
               {"joints", joints},
               {"columns", columns_doc()},
               {"cameras", cameras_doc(robot, scene, options.size)}});
  doc.set_all({{"scene", scene_doc(scene)},
               {"goal", task.goal_json(done.goal)},
               {"plan", plan_doc(done.plan)},
               {"certificate", certificate_doc(done.plan)},
               {"executed", executed_doc(done)}});
  return doc.document();
}

}  // namespace mjarm::episode
