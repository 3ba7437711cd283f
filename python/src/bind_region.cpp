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

}  // namespace

void bind_region(nb::module_& m) {
  nb::class_<TaskRegion>(m, "Region", R"(A set of poses of the tool, as a goal or to stay in.

The tool may be off `pose` by `half` along its axes to both sides, lean by `lean` and be turned about its z axis by `turn`.

Parameters
----------
pose : Pose
half : array_like, shape (3,), optional
    [m]
lean, turn : float, optional
    0 to pi [rad].
)")
      .def(
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
}

}  // namespace mjarm::python
