// Demonstrations: the scenes and actions of `mjarm record`, to act in.
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <memory>

#include "mjarm/episode/task_world.hpp"
#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"
#include "python/src/images.hpp"

namespace mjarm::python {
namespace {

using episode::EpisodeOptions;
using episode::TaskWorld;

std::unique_ptr<TaskWorld> open_world(const std::string& task, const std::string& robot,
                                      std::uint64_t seed, int size, int fps) {
  return std::make_unique<TaskWorld>(value_of(
      TaskWorld::open({.task = task, .robot = robot, .seed = seed, .size = size, .fps = fps})));
}

/// x y z qw qx qy qz, as the columns of an episode have a pose.
void append_pose(const Pose& X, std::vector<double>& out) {
  out.insert(out.end(), X.p.begin(), X.p.end());
  const std::vector<double> quat = quat_values(X);
  out.insert(out.end(), quat.begin(), quat.end());
}

nb::object tool_of(const TaskWorld& world) {
  std::vector<double> out;
  append_pose(world.row().X_WT, out);
  return array(out, {out.size()});
}

nb::object objects_of(const TaskWorld& world) {
  std::vector<double> out;
  for (const Pose& X : world.row().objects) append_pose(X, out);
  return array(out, {out.size()});
}

std::vector<std::string> joint_names(const TaskWorld& world) {
  std::vector<std::string> out;
  for (const ArmJoint& joint : world.robot().arm.joints) out.push_back(joint.name);
  return out;
}

std::vector<std::string> object_names(const TaskWorld& world) {
  std::vector<std::string> out;
  for (const episode::DrawnObject& object : world.scene().objects) out.push_back(object.name);
  return out;
}

std::vector<std::string> cameras_of(const TaskWorld& world) {
  std::vector<std::string> out;
  for (const episode::DrawnView& view : world.scene().views) out.push_back(view.name);
  return out;
}

void bind_rows(nb::class_<TaskWorld>& world) {
  world
      .def_prop_ro(
          "joint_position", [](const TaskWorld& w) { return array(w.row().q); },
          nb::sig("def joint_position(self) -> Array"), "(dof,) [rad].")
      .def_prop_ro(
          "joint_reference", [](const TaskWorld& w) { return array(w.reference()); },
          nb::sig("def joint_reference(self) -> Array"), "(dof,) [rad] where they are to be.")
      .def_prop_ro("tool_pose", &tool_of, nb::sig("def tool_pose(self) -> Array"),
                   "(7,) x y z qw qx qy qz in the world.")
      .def_prop_ro(
          "gripper", [](const TaskWorld& w) { return w.row().grip; },
          "Its command, 0 open to 1 closed.")
      .def_prop_ro("object_poses", &objects_of, nb::sig("def object_poses(self) -> Array"),
                   "Seven numbers an object, one after another.")
      .def_prop_ro(
          "reason", [](const TaskWorld& w) { return w.verdict().reason; },
          "What is not as the task wants it; empty where it is done.")
      .def(
          "picture",
          [](TaskWorld& w, const std::string& camera) {
            return array_of(value_of(w.picture(camera)));
          },
          nb::arg("camera"), nb::sig("def picture(self, camera: str) -> Pixels"),
          "What a camera sees, (size, size, 3).");
}

}  // namespace

void bind_episode(nb::module_& m) {
  const EpisodeOptions usual;
  nb::class_<TaskWorld> world(m, "TaskWorld",
                              "The scenes of `mjarm record`, to act in; `mjarm.tasks` has it.");
  world
      .def(nb::new_(&open_world), nb::kw_only(), nb::arg("task") = usual.task,
           nb::arg("robot") = usual.robot, nb::arg("seed") = usual.seed,
           nb::arg("size") = usual.size, nb::arg("fps") = usual.fps)
      .def_prop_ro("joint_names", &joint_names, "From base to tip.")
      .def_prop_ro("object_names", &object_names, "In the order of `object_poses`.")
      .def_prop_ro("cameras", &cameras_of, "Their names.")
      .def_prop_ro(
          "english", [](const TaskWorld& w) { return w.scene().english; }, "The task in words.")
      .def_prop_ro(
          "chinese", [](const TaskWorld& w) { return w.scene().chinese; }, "The same in Chinese.")
      .def("reset", &TaskWorld::reset, nb::arg("number"), "Begins the scene of that episode.")
      .def(
          "step",
          [](TaskWorld& w, nb::handle action) {
            value_of(w.step(reals(action, "action", {w.robot().arm.dof() + 1}).span()));
          },
          nb::arg("action"), nb::sig("def step(self, action: ArrayLike) -> None"),
          "Goes on to the next row; joints [rad] and the gripper's command there, (dof + 1,).");
  bind_rows(world);
}

}  // namespace mjarm::python
