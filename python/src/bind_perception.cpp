// Cameras, and what they see: pictures with depth, objects, tags, and where a camera is.
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>

#include "mjarm/perception/find_objects.hpp"
#include "mjarm/render/rgbd.hpp"
#include "mjarm/session/see_scene.hpp"
#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"
#include "python/src/images.hpp"
#include "python/src/interrupt.hpp"
#include "python/src/robot.hpp"

namespace mjarm::python {
namespace {

using render::CameraIntrinsics;
using render::RgbdFrame;

CameraIntrinsics lens_of(int width, int height, double fx, double fy, double cx, double cy) {
  if (!(fx > 0 && fy > 0)) refuse(msg::python_positive, "fx, fy");
  return {.width = width, .height = height, .fx = fx, .fy = fy, .cx = cx, .cy = cy};
}

RgbdFrame frame_of(nb::handle color, nb::handle depth, double fx, double fy, double cx, double cy,
                   nb::handle pose) {
  RgbdFrame out{.color = image_of(color, "color")};
  const Reals given = [&] {
    // Where nothing was measured cameras write 0 or no number.
    const nb::object numpy = nb::module_::import_("numpy");
    return reals(numpy.attr("nan_to_num")(depth, nb::arg("nan") = 0.0, nb::arg("posinf") = 0.0,
                                          nb::arg("neginf") = 0.0),
                 "depth", {out.color.height, out.color.width});
  }();
  out.depth.assign(given.data(), given.data() + given.size());
  out.intrinsics = lens_of(out.color.width, out.color.height, fx, fy, cx, cy);
  if (!pose.is_none()) out.X_WC = pose_of(pose, "pose");
  return out;
}

/// `mjarm.Camera`: a camera of a robot's scene.
struct BoundCamera {
  Model model;
  render::RgbdCamera camera;
  Rng noise;
  Turn turn = {};
};

Snapshot snapshot_of(const Model& model, nb::handle qpos) {
  Sim sim(model);
  sim.reset_home();
  if (const std::vector<double> whole = qpos_of(qpos, model); !whole.empty()) {
    sim.set_state(whole, std::vector<double>(static_cast<std::size_t>(model.nv())));
  }
  return sim.snapshot();
}

BoundCamera open_camera(const BoundRobot& robot, const std::string& name, int width, int height,
                        double depth_sigma, std::uint64_t seed) {
  const Model& model = robot.robot.model;
  return {model,
          value_of(render::RgbdCamera::create(
              model, name, {.width = width, .height = height, .depth_sigma = depth_sigma})),
          Rng(seed)};
}

/// `mjarm.Eye`.
struct BoundEye {
  Robot robot;
  session::SceneEye eye;
  Turn turn = {};
};

/// `mjarm.ObjectFinder`.
struct BoundFinder {
  perception::ObjectFinder finder;
  Turn turn = {};
};

/// Of one look: what stands where.
struct Seen {
  perception::FoundScene found;
  std::map<std::string, std::string> unseen;
};

Seen seen_of(perception::FoundScene found) {
  Seen out{.found = std::move(found), .unseen = {}};
  for (const perception::FoundObject& object : out.found.objects) {
    if (!object.pose) out.unseen[object.name] = describe(object.pose.error().code);
  }
  return out;
}

Seen look_with(BoundEye& self, nb::handle qpos) {
  const SceneState scene{.qpos = qpos_of(qpos, self.robot.model)};
  const Arm& arm = self.robot.arm;
  const JointVec q = scene.qpos.empty() ? arm.home : joints_in(scene.qpos, arm);
  return value_of([&]() -> Result<Seen> {
    const nb::gil_scoped_release free;
    const auto turn = self.turn.lock();
    const auto seen = self.eye.look(scene, as_span(q));
    if (!seen) return fail(seen.error());
    return seen_of(self.eye.found());
  }());
}

perception::ObjectFinder make_finder(const BoundRobot& robot,
                                     const std::vector<std::string>& objects,
                                     const std::map<std::string, perception::ObjectTag>& tags,
                                     double depth_sigma, bool unknown) {
  if (objects.empty()) refuse(msg::python_empty, "objects");
  std::vector<perception::KnownObject> known;
  for (const std::string& name : objects) {
    known.push_back(value_of(perception::known_object(robot.robot.model, name)));
    if (const auto tag = tags.find(name); tag != tags.end()) known.back().tag = tag->second;
  }
  for (const auto& [name, tag] : tags) {
    if (std::ranges::find(objects, name) == objects.end()) refuse(msg::python_tag_of_none, name);
  }
  return value_of(perception::ObjectFinder::create(
      std::move(known), {.depth_sigma = depth_sigma, .unknown = unknown}));
}

std::string kind_word(perception::UnknownObject::Kind kind) {
  return kind == perception::UnknownObject::Kind::box ? "box" : "cylinder";
}

void bind_frame(nb::module_& m) {
  nb::class_<RgbdFrame>(
      m, "Frame", R"(What an RGB-D camera sees at one moment; a real camera's is made of its arrays.

Parameters
----------
color : array_like, shape (height, width, 3), uint8
    Red, green, blue; rows from the top.
depth : array_like, shape (height, width)
    Along the line of sight [m]; 0 or NaN where nothing was measured.
fx, fy, cx, cy : float
    Focal lengths and middle [px]; whole numbers are the middles of pixels.
pose : Pose, optional
    The camera in the world: x to the right, y down, z along the line of sight.
)")
      .def(
          "__init__",
          [](RgbdFrame* self, nb::handle color, nb::handle depth, double fx, double fy, double cx,
             double cy, nb::handle pose) {
            new (self) RgbdFrame(frame_of(color, depth, fx, fy, cx, cy, pose));
          },
          nb::arg("color"), nb::arg("depth"), nb::kw_only(), nb::arg("fx"), nb::arg("fy"),
          nb::arg("cx"), nb::arg("cy"), nb::arg("pose").none() = nb::none(),
          nb::sig(
              "def __init__(self, color: ArrayLike, depth: ArrayLike, *, fx: float, fy: float, cx: "
              "float, cy: float, pose: PoseLike | None = None) -> None"))
      .def_prop_ro(
          "color", [](const RgbdFrame& f) { return array_of(f.color); },
          nb::sig("def color(self) -> Pixels"), "(height, width, 3), uint8.")
      .def_prop_ro(
          "depth",
          [](const RgbdFrame& f) {
            return array<float>(f.depth, {static_cast<std::size_t>(f.color.height),
                                          static_cast<std::size_t>(f.color.width)});
          },
          nb::sig("def depth(self) -> Floats"),
          "Along the line of sight [m], (height, width), float32; 0 where nothing was measured.")
      .def_prop_ro(
          "intrinsics",
          [](const RgbdFrame& f) {
            const CameraIntrinsics& lens = f.intrinsics;
            return nb::make_tuple(lens.fx, lens.fy, lens.cx, lens.cy);
          },
          nb::sig("def intrinsics(self) -> tuple[float, float, float, float]"),
          "fx, fy, cx, cy [px].")
      .def_ro("pose", &RgbdFrame::X_WC, "The camera in the world.")
      .def("_repr_png_", [](const RgbdFrame& f) { return png_of(f.color); });
  nb::class_<BoundCamera>(m, "Camera", "A camera of a robot's scene, with depth.")
      .def(
          "look",
          [](BoundCamera& self, nb::handle qpos) {
            const Snapshot snapshot = snapshot_of(self.model, qpos);
            auto frame = [&] {
              const nb::gil_scoped_release free;
              const auto turn = self.turn.lock();
              return self.camera.look(snapshot, self.noise);
            }();
            return value_of(std::move(frame));
          },
          nb::arg("qpos") = nb::none(),
          nb::sig("def look(self, qpos: ArrayLike | None = None) -> Frame"),
          "What it sees while everything stands at `qpos`, (nq,); default: at home.");
}

void bind_seen(nb::module_& m) {
  using perception::UnknownObject;
  nb::class_<perception::FoundPose>(m, "FoundPose", "Where an object is.")
      .def_ro("pose", &perception::FoundPose::X_WO,
              "The object in the world; up to its shape's symmetry without a tag.")
      .def_ro("by_tag", &perception::FoundPose::by_tag, "Known by its tag.")
      .def_ro("seen", &perception::FoundPose::seen, "Share of what it would show that is seen.")
      .def_ro("residual", &perception::FoundPose::residual, "Root mean square of depth there [m].")
      .def_ro("uncertainty", &perception::FoundPose::uncertainty,
              "Standard deviation of its surface in the least certain direction [m].");
  nb::class_<UnknownObject>(
      m, "UnknownObject",
      "Something that is none of the objects: the upright solid that explains it best.")
      .def_prop_ro(
          "kind", [](const UnknownObject& o) { return kind_word(o.kind); },
          "\"box\" or \"cylinder\".")
      .def_ro("pose", &UnknownObject::X_WO, "Its middle in the world; z away from the table.")
      .def_prop_ro(
          "size", [](const UnknownObject& o) { return array(o.size); },
          nb::sig("def size(self) -> Array"), "Edges, or diameter twice and height [m], (3,).");
  nb::class_<Seen>(m, "Seen", "What one look tells.")
      .def_prop_ro(
          "objects",
          [](const Seen& seen) {
            nb::dict out;
            for (const perception::FoundObject& o : seen.found.objects) {
              if (o.pose) out[o.name.c_str()] = nb::cast(*o.pose);
            }
            return out;
          },
          nb::sig("def objects(self) -> dict[str, FoundPose]"), "Those that have a pose, by name.")
      .def_ro("missing", &Seen::unseen, "Why the others have none, by name.")
      .def_prop_ro(
          "unknown", [](const Seen& seen) { return seen.found.unknown; },
          "What is none of them, the largest in the picture first.")
      .def(
          "__getitem__",
          [](const Seen& seen, const std::string& name) {
            for (const perception::FoundObject& o : seen.found.objects) {
              if (o.name == name && o.pose) return o.pose->X_WO;
            }
            throw nb::key_error(name.c_str());
          },
          nb::arg("name"), "Pose of an object in the world.")
      .def(
          "__contains__",
          [](const Seen& seen, const std::string& name) {
            return std::ranges::any_of(seen.found.objects, [&](const perception::FoundObject& o) {
              return o.name == name && o.pose;
            });
          },
          nb::arg("name"))
      .def("__repr__", [](const Seen& seen) {
        return "<mjarm.Seen: " + std::to_string(seen.found.objects.size() - seen.unseen.size()) +
               " of " + std::to_string(seen.found.objects.size()) + " objects>";
      });
  nb::class_<BoundEye>(m, "Eye", "A camera that finds the objects of its robot's scene.")
      .def("look", &look_with, nb::arg("qpos") = nb::none(),
           nb::sig("def look(self, qpos: ArrayLike | None = None) -> Seen"),
           "Draws the scene at `qpos`, (nq,) (default: at home), and finds in the picture every "
           "body "
           "that can be carried.");
  nb::class_<BoundFinder>(
      m, "ObjectFinder",
      R"(Finds known objects in what an RGB-D camera sees: by their tags, else by their shapes.

Parameters
----------
robot : Robot
    Whose model has the objects.
objects : sequence of str
    Names of bodies.
tags : dict of str to ObjectTag, optional
    Those that have one.
depth_sigma : float, optional
    Standard deviation of depth 0.5 m away [m].
unknown : bool, optional
    Also measure what is none of them.
)")
      .def(
          "__init__",
          [](BoundFinder* self, const BoundRobot& robot, const std::vector<std::string>& objects,
             const std::map<std::string, perception::ObjectTag>& tags, double depth_sigma,
             bool unknown) {
            new (self) BoundFinder{make_finder(robot, objects, tags, depth_sigma, unknown)};
          },
          nb::arg("robot"), nb::arg("objects"), nb::kw_only(),
          nb::arg("tags") = std::map<std::string, perception::ObjectTag>(),
          nb::arg("depth_sigma") = perception::FindOptions().depth_sigma, nb::arg("unknown") = true)
      .def(
          "find",
          [](BoundFinder& self, const RgbdFrame& frame) {
            auto found = [&] {
              const nb::gil_scoped_release free;
              const auto turn = self.turn.lock();
              return self.finder.find(frame);
            }();
            return seen_of(value_of(std::move(found)));
          },
          nb::arg("frame"),
          "Every object has a pose with which the whole picture agrees, or a reason why not.");
}

}  // namespace

void bind_perception(nb::module_& m) {
  bind_frame(m);
  bind_seen(m);
  auto robot = nb::borrow<nb::class_<BoundRobot>>(m.attr("Robot"));
  robot
      .def("camera", &open_camera, nb::arg("name"), nb::kw_only(), nb::arg("width") = 1280,
           nb::arg("height") = 720, nb::arg("depth_sigma") = 0.001, nb::arg("seed") = 1,
           "A camera of the scene, by its name; depth's errors have the standard deviation "
           "`depth_sigma` [m] 0.5 m away.")
      .def(
          "eye",
          [](const BoundRobot& self, const std::string& name, double depth_sigma,
             std::uint64_t seed) {
            return BoundEye{self.robot,
                            value_of(session::SceneEye::open(
                                self.robot, name, {.depth_sigma = depth_sigma, .seed = seed}))};
          },
          nb::arg("camera"), nb::kw_only(), nb::arg("depth_sigma") = 0.001, nb::arg("seed") = 1,
          "A camera of the scene that finds the objects in it.");
}

}  // namespace mjarm::python
