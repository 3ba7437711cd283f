// Sets of poses of the tool.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <numbers>
#include <string>
#include <vector>

#include "mjarm/planning/task_region.hpp"
#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"

namespace mjarm::python {
namespace {

Eigen::Vector3d triple(nb::handle value, const char* name, const Eigen::Vector3d& usual) {
  if (value.is_none()) return usual;
  // Bounds may be infinite.
  const auto values = nb::cast<std::vector<double>>(
      nb::module_::import_("numpy").attr("asarray")(value, "float64").attr("tolist")());
  if (values.size() != 3)
    refuse(msg::python_shape, name, "(3,)", "(" + std::to_string(values.size()) + ",)");
  return {values[0], values[1], values[2]};
}

TaskRegion sound_region(TaskRegion region) {
  if (!is_sound(region)) refuse(msg::python_region);
  return region;
}

/// The region on a hinge or a slide.
TaskRegion hung(const TaskRegion& region, JointType type, nb::handle p, nb::handle axis, double min,
                double max) {
  const Eigen::Vector3d none = Eigen::Vector3d::Zero(), along = triple(axis, "axis", none);
  TaskRegion out = region;
  out.mechanism = Mechanism{.type = type,
                            .p_W = triple(p, "pos", none),
                            .axis_W = along.norm() > 0 ? along.normalized() : along,
                            .min = min,
                            .max = max};
  return sound_region(out);
}

void bind_mechanism(nb::class_<TaskRegion>& type) {
  type.def(
          "on_hinge",
          [](const TaskRegion& self, nb::handle pos, nb::handle axis, double least, double most) {
            return hung(self, JointType::hinge, pos, axis, least, most);
          },
          nb::arg("pos"), nb::arg("axis"), nb::arg("least"), nb::arg("most"),
          nb::sig("def on_hinge(self, pos: ArrayLike, axis: ArrayLike, least: float, most: float) "
                  "-> Region"),
          "The same region on a door, which may stand anywhere from `least` to `most` [rad], about "
          "an axis in the world\nthrough `pos` [m]; where it stands at 0 the region is as it is "
          "here.")
      .def(
          "on_slide",
          [](const TaskRegion& self, nb::handle axis, double least, double most) {
            return hung(self, JointType::slide, nb::none(), axis, least, most);
          },
          nb::arg("axis"), nb::arg("least"), nb::arg("most"),
          nb::sig("def on_slide(self, axis: ArrayLike, least: float, most: float) -> Region"),
          "The same region on a drawer, which may stand anywhere from `least` to `most` [m] along "
          "an axis in the world.")
      .def(
          "standing_at",
          [](const TaskRegion& self, double value) { return standing_at(self, value); },
          nb::arg("value"), nb::sig("def standing_at(self, value: float) -> Region"),
          "The region while its door or drawer stands at this value [rad] or [m].")
      .def(
          "value",
          [](const TaskRegion& self, nb::handle pose) {
            return value_for(self, pose_of(pose, "pose"));
          },
          nb::arg("pose"), nb::sig("def value(self, pose: PoseLike) -> float"),
          "Where its door or drawer stands when the tool is at this pose [rad] or [m]; 0 where "
          "there is none.");
}

}  // namespace

void bind_region(nb::module_& m) {
  nb::class_<TaskRegion> type(m, "Region", R"(A set of poses of the tool, as a goal or to stay in.

The tool may be off `pose` by `half` along its axes to both sides, lean by `lean` and be turned about its z axis by `turn`.

Parameters
----------
pose : Pose
half : array_like, shape (3,), optional
    [m]
lean, turn : float, optional
    0 to pi [rad].
)");
  type.def(
          "__init__",
          [](TaskRegion* self, nb::handle pose, nb::handle half, double lean, double turn) {
            new (self) TaskRegion(sound_region(region_about(
                pose_of(pose, "pose"), triple(half, "half", Eigen::Vector3d::Zero()), lean, turn)));
          },
          nb::arg("pose"), nb::kw_only(), nb::arg("half").none() = nb::none(),
          nb::arg("lean") = 0.0, nb::arg("turn") = 0.0,
          nb::sig("def __init__(self, pose: PoseLike, *, half: ArrayLike | None = None, lean: "
                  "float = 0.0, "
                  "turn: float = 0.0) -> None"))
      .def_static(
          "bounds",
          [](nb::handle frame, nb::handle tool, nb::handle place_min, nb::handle place_max,
             nb::handle turn_min, nb::handle turn_max, double lean) {
            const Eigen::Vector3d none = Eigen::Vector3d::Zero();
            return sound_region({.X_WR = pose_of(frame, "frame"),
                                 .X_FT = tool.is_none() ? Pose() : pose_of(tool, "tool"),
                                 .place_min = triple(place_min, "place_min", none),
                                 .place_max = triple(place_max, "place_max", none),
                                 .turn_min = triple(turn_min, "turn_min", none),
                                 .turn_max = triple(turn_max, "turn_max", none),
                                 .lean = lean});
          },
          nb::arg("frame"), nb::kw_only(), nb::arg("tool").none() = nb::none(),
          nb::arg("place_min").none() = nb::none(), nb::arg("place_max").none() = nb::none(),
          nb::arg("turn_min").none() = nb::none(), nb::arg("turn_max").none() = nb::none(),
          nb::arg("lean") = std::numbers::pi,
          nb::sig("def bounds(frame: PoseLike, *, tool: PoseLike | None = None, place_min: "
                  "ArrayLike | None = "
                  "None, place_max: ArrayLike | None = None, turn_min: ArrayLike | None = None, "
                  "turn_max: "
                  "ArrayLike | None = None, lean: float = 3.141592653589793) -> Region"),
          "A task space region (D. Berenson, S. Srinivasa, J. Kuffner, IJRR 30 (2011) 1435): a "
          "frame in "
          "which the tool stands at\n`tool` moves within bounds in `frame`: place [m], inf for "
          "none; roll, "
          "pitch, yaw [rad]; the lean of its z axis [rad].")
      .def(
          "room",
          [](const TaskRegion& region, nb::handle pose) {
            const RegionRoom room = room_in(region, pose_of(pose, "pose"));
            return nb::make_tuple(room.place, room.turn);
          },
          nb::arg("pose"), nb::sig("def room(self, pose: PoseLike) -> tuple[float, float]"),
          "How far inside of its nearest bounds a pose is [m], [rad]; below 0: outside.")
      .def(
          "nearest",
          [](const TaskRegion& region, nb::handle pose) {
            return nearest_in(region, pose_of(pose, "pose"));
          },
          nb::arg("pose"), nb::sig("def nearest(self, pose: PoseLike) -> Pose"),
          "A pose in it that is near to this one.")
      .def_prop_ro(
          "middle", [](const TaskRegion& region) { return middle_of(region); },
          "The pose in its middle.");
  bind_mechanism(type);
}

}  // namespace mjarm::python
