// Tags in pictures, and where a camera is.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <string>
#include <utility>
#include <vector>

#include "mjarm/perception/find_objects.hpp"
#include "mjarm/perception/hand_eye.hpp"
#include "mjarm/perception/tag_pose.hpp"
#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"
#include "python/src/images.hpp"

namespace mjarm::python {
namespace {

std::vector<perception::SeenTag> find_tags(nb::handle image) {
  const render::Image picture = image_of(image, "image");
  auto detector = value_of(perception::TagDetector::create());
  const nb::gil_scoped_release free;
  return detector.find(picture);
}

perception::HandEye calibrate(const std::vector<perception::BoardTag>& board,
                              const std::vector<std::vector<perception::SeenTag>>& seen,
                              nb::handle tool_poses, const std::string& mount,
                              const render::RgbdFrame& frame) {
  const std::vector<Pose> tools = poses_of(tool_poses, "tool_poses");
  if (tools.size() != seen.size()) refuse(msg::python_as_many, "tool_poses", seen.size());
  if (mount != "wrist" && mount != "fixed") refuse(msg::python_mount, mount);
  std::vector<perception::HandEyeView> views;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    views.push_back({.X_WT = tools[i], .corners = perception::board_corners(board, seen[i])});
  }
  const auto found = perception::calibrate_hand_eye(
      views, mount == "wrist" ? perception::CameraMount::wrist : perception::CameraMount::fixed,
      frame.intrinsics);
  if (!found) raise(Error{Errc::impossible, describe(found.error())});
  return *found;
}

}  // namespace

void bind_tags(nb::module_& m) {
  using perception::BoardTag;
  using perception::HandEye;
  using perception::ObjectTag;
  using perception::SeenTag;
  nb::class_<ObjectTag>(m, "ObjectTag", "A tag (tag36h11) on an object.")
      .def(
          "__init__",
          [](ObjectTag* self, int id, double size, nb::handle pose) {
            new (self) ObjectTag{id, size, pose_of(pose, "pose")};
          },
          nb::arg("id"), nb::arg("size"), nb::arg("pose"),
          nb::sig("def __init__(self, id: int, size: float, pose: PoseLike) -> None"),
          "Its number, the edge of its black square [m], and the tag on the object: x right, y up, "
          "z out "
          "of it.");
  nb::class_<BoardTag>(m, "BoardTag", "A tag of a board for calibration.")
      .def(
          "__init__",
          [](BoardTag* self, int id, double size, nb::handle pose) {
            new (self) BoardTag{id, size, pose_of(pose, "pose")};
          },
          nb::arg("id"), nb::arg("size"), nb::arg("pose"),
          nb::sig("def __init__(self, id: int, size: float, pose: PoseLike) -> None"),
          "Its number, the edge of its black square [m], and the tag on the board.");
  nb::class_<SeenTag>(m, "SeenTag", "A tag in a picture.")
      .def_ro("id", &SeenTag::id, "Its number.")
      .def_prop_ro(
          "corners",
          [](const SeenTag& tag) {
            std::vector<double> values;
            for (const Eigen::Vector2d& at : tag.corners) {
              values.insert(values.end(), at.begin(), at.end());
            }
            return array(std::move(values), {4, 2});
          },
          nb::sig("def corners(self) -> Array"),
          "Of the black square [px], (4, 2): lower left, lower right, upper right, upper left as "
          "it is "
          "printed.")
      .def(
          "pose",
          [](const SeenTag& tag, double size, const render::RgbdFrame& frame, double depth_sigma) {
            const auto found = perception::tag_pose(tag, size, frame, depth_sigma);
            if (!found) raise(Error{Errc::impossible, describe(found.error())});
            return frame.X_WC * found->X_CT;
          },
          nb::arg("size"), nb::arg("frame"), nb::arg("depth_sigma") = 0.001,
          "The tag in the world, from its corners and from depth; `size` [m] is the edge of its "
          "black square.");
  nb::class_<HandEye>(m, "HandEye", "Where a camera is.")
      .def_ro("camera", &HandEye::X_PC, "On the tool (wrist), or in the world (fixed).")
      .def_ro("board", &HandEye::X_QB, "The board in the world (wrist), or on the tool (fixed).")
      .def_ro("views", &HandEye::views, "That saw the board.")
      .def_ro("residual", &HandEye::residual, "Root mean square of all corners [px].");
  m.def("find_tags", &find_tags, nb::arg("image"),
        nb::sig("def find_tags(image: ArrayLike) -> list[SeenTag]"),
        "All tags (tag36h11) in a picture, (height, width, 3) uint8, by AprilTag 3.");
  m.def(
      "tag_picture",
      [](int id, int pixels) { return array_of(value_of(perception::tag_picture(id, pixels))); },
      nb::arg("id"), nb::arg("pixels") = 20,
      nb::sig("def tag_picture(id: int, pixels: int = 20) -> Pixels"),
      "The picture of a tag with its white rim, of 10 x 10 cells, `pixels` across each.");
  m.def("calibrate_hand_eye", &calibrate, nb::arg("board"), nb::arg("seen"), nb::arg("tool_poses"),
        nb::arg("mount"), nb::arg("frame"),
        nb::sig(
            "def calibrate_hand_eye(board: Sequence[BoardTag], seen: Sequence[Sequence[SeenTag]], "
            "tool_poses: PosesLike, mount: str, frame: Frame) -> HandEye"),
        "Where a camera is, from views of a board of tags: the tags that each picture shows and "
        "where the "
        "tool was; `mount` is\n\"wrist\" or \"fixed\", `frame` any of the frames.");
}

}  // namespace mjarm::python
