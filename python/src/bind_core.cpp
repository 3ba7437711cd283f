// Poses, and the language of messages.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>

#include <cstdio>
#include <memory>
#include <numbers>

#include "mjarm/core/messages.hpp"
#include "mjarm/core/progress_sink.hpp"
#include "mjarm/core/rotation.hpp"
#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"

namespace mjarm::python {
namespace {

Eigen::Matrix3d rotation_of(nb::handle euler, nb::handle quat, nb::handle matrix) {
  if (!euler.is_none() + !quat.is_none() + !matrix.is_none() > 1) {
    refuse(msg::python_one_turn);
  }
  if (!euler.is_none()) {
    const Eigen::Vector3d angles = vector3(euler, "euler");
    if (angles.cwiseAbs().maxCoeff() > 2 * std::numbers::pi + 1e-9) {
      refuse(msg::python_degrees);
    }
    return from_euler(angles);
  }
  if (!quat.is_none()) {
    return rotation_of_quat(reals(quat, "quat", {4}).data(), "quat");
  }
  if (matrix.is_none()) return Eigen::Matrix3d::Identity();
  const Reals m = reals(matrix, "matrix", {3, 3});
  const Eigen::Matrix3d R =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(m.data());
  if (!is_rotation(R)) refuse(msg::python_no_rotation, "matrix");
  return R;
}

nb::object moved(const Pose& X, nb::handle what) {
  const Reals points = reals(what, "points");
  const bool one = points.ndim() == 1;
  if (points.ndim() == 0 || points.ndim() > 2 || points.shape(points.ndim() - 1) != 3) {
    refuse(msg::python_points);
  }
  std::vector<double> out(points.size());
  for (std::size_t i = 0; i < out.size(); i += 3) {
    const Eigen::Vector3d p =
        X * Eigen::Vector3d(points.data()[i], points.data()[i + 1], points.data()[i + 2]);
    std::copy(p.begin(), p.end(), out.begin() + static_cast<std::ptrdiff_t>(i));
  }
  if (one) return array(std::move(out), {3});
  return array(std::move(out), {points.shape(0), 3});
}

std::string shown(const Pose& X) {
  const Quat q = to_quat(X.R);
  char text[200];
  std::snprintf(text, sizeof text, "Pose([%.6g, %.6g, %.6g], quat=[%.6g, %.6g, %.6g, %.6g])",
                X.p[0], X.p[1], X.p[2], q.w(), q.x(), q.y(), q.z());
  return text;
}

void bind_pose(nb::module_& m) {
  nb::class_<Pose>(m, "Pose", R"(Pose of a frame in another: a position and a rotation.

Parameters
----------
pos : array_like, shape (3,)
    Position of the frame's origin [m].
euler : array_like, shape (3,), optional
    Angles [rad] about the fixed axes x, y, z, in this order (scipy's 'xyz', URDF's rpy).
quat : array_like, shape (4,), optional
    Quaternion (w, x, y, z); it is normalised.
matrix : array_like, shape (3, 3), optional
    Rotation matrix.

Raises
------
BadInput
    For another shape, angles that look like degrees, or a matrix that is no rotation.
)")
      .def(
          "__init__",
          [](Pose* self, nb::handle pos, nb::handle euler, nb::handle quat, nb::handle matrix) {
            new (self) Pose{pos.is_none() ? Eigen::Vector3d::Zero().eval() : vector3(pos, "pos"),
                            rotation_of(euler, quat, matrix)};
          },
          nb::arg("pos").none() = nb::none(), nb::kw_only(), nb::arg("euler").none() = nb::none(),
          nb::arg("quat").none() = nb::none(), nb::arg("matrix").none() = nb::none(),
          nb::sig(
              "def __init__(self, pos: ArrayLike | None = None, *, euler: ArrayLike | None = None, "
              "quat: ArrayLike | None = None, matrix: ArrayLike | None = None) -> None"))
      .def_static(
          "from_matrix", [](nb::handle matrix) { return pose_of(matrix, "matrix"); },
          nb::arg("matrix"), nb::sig("def from_matrix(matrix: ArrayLike) -> Pose"),
          "The pose of a homogeneous matrix, shape (4, 4).")
      .def_prop_ro(
          "pos", [](const Pose& X) { return array(X.p); }, nb::sig("def pos(self) -> Array"),
          "Position [m], shape (3,).")
      .def_prop_ro(
          "quat", [](const Pose& X) { return array(quat_values(X), {4}); },
          nb::sig("def quat(self) -> Array"), "Unit quaternion (w, x, y, z), shape (4,).")
      .def_prop_ro(
          "euler", [](const Pose& X) { return array(to_euler(X.R)); },
          nb::sig("def euler(self) -> Array"),
          "Angles [rad] about the fixed axes x, y, z, shape (3,).")
      .def_prop_ro(
          "rotation",
          [](const Pose& X) {
            const Eigen::Matrix3d rows = X.R.transpose();
            return array({rows.data(), 9}, {3, 3});
          },
          nb::sig("def rotation(self) -> Array"), "Rotation matrix, shape (3, 3).")
      .def_prop_ro(
          "matrix", [](const Pose& X) { return array(X); }, nb::sig("def matrix(self) -> Array"),
          "Homogeneous matrix, shape (4, 4).")
      .def("inverse", &Pose::inverse, "The pose of the other frame in this one.")
      .def(
          "__matmul__", [](const Pose& X, const Pose& other) { return X * other; },
          nb::arg("other"), "The pose after this one.")
      .def("__matmul__", &moved, nb::arg("other"),
           nb::sig("def __matmul__(self, other: ArrayLike) -> Array"),
           "Points [m] of shape (3,) or (n, 3) of its frame, seen from its base.")
      .def(
          "interpolate",
          [](const Pose& X, nb::handle to, double t) {
            if (!(t >= 0 && t <= 1)) refuse(msg::python_share, "t");
            return interpolate(X, pose_of(to, "to"), t);
          },
          nb::arg("to"), nb::arg("t"),
          nb::sig("def interpolate(self, to: PoseLike, t: float) -> Pose"),
          "On the straight line to another pose, at the share `t` (0 to 1) of the way.")
      .def(
          "difference",
          [](const Pose& X, nb::handle other) {
            const Pose Y = pose_of(other, "other");
            return std::pair((X.p - Y.p).norm(), angle_between(X.R, Y.R));
          },
          nb::arg("other"), nb::sig("def difference(self, other: PoseLike) -> tuple[float, float]"),
          "Distance [m] and angle [rad] to another pose.")
      .def(
          "__array__",
          [](const Pose& X, nb::handle dtype, nb::handle) {
            nb::object out = array(X);
            return dtype.is_none() ? out : nb::object(out.attr("astype")(dtype));
          },
          nb::arg("dtype").none() = nb::none(), nb::arg("copy").none() = nb::none(),
          nb::sig("def __array__(self, dtype: Any = None, copy: bool | None = None) -> Array"))
      .def(
          "__getstate__", [](const Pose& X) { return array(X); },
          nb::sig("def __getstate__(self) -> Array"))
      .def(
          "__setstate__",
          [](Pose& X, nb::handle matrix) { new (&X) Pose(pose_of(matrix, "matrix")); },
          nb::sig("def __setstate__(self, state: Array) -> None"))
      .def("__repr__", &shown);
}

/// Has progress go to a function of Python, from whatever thread.
void set_progress(nb::handle show) {
  if (show.is_none()) return set_progress_sink({});
  if (PyCallable_Check(show.ptr()) == 0) refuse(msg::python_callable, "show");
  const auto forget = [](nb::object* kept) {
    if (Py_IsInitialized() == 0) return;  // the program ends: nobody may touch it any more
    const nb::gil_scoped_acquire bound;
    const std::unique_ptr<nb::object> ends(kept);
  };
  const std::shared_ptr<nb::object> kept(new nb::object(nb::borrow(show)), forget);
  set_progress_sink([kept](const std::string& line) {
    const nb::gil_scoped_acquire bound;
    try {
      (*kept)(line);
    } catch (nb::python_error& error) {
      error.discard_as_unraisable("mjarm.set_progress");
    }
  });
}

}  // namespace

void bind_core(nb::module_& m) {
  bind_pose(m);
  m.def(
      "set_progress", &set_progress, nb::arg("show").none(),
      nb::sig("def set_progress(show: Callable[[str], object] | None) -> None"),
      "Has lines of progress of long calls go to a function, an empty one in the end; None: to the "
      "terminal, if there is one.\nIn notebooks they are shown from the beginning.");
  set_language(language_of_locale());
  m.def(
      "language", [] { return language() == Language::chinese ? "zh" : "en"; },
      "The language of messages, \"en\" or \"zh\".");
  m.def(
      "set_language",
      [](const std::string& name) {
        if (name != "en" && name.rfind("zh", 0) != 0) refuse(msg::python_language);
        set_language(language_of(name));
      },
      nb::arg("name"),
      "Sets the language of all messages, \"en\" or \"zh\"; it is that of the locale at first.");
}

}  // namespace mjarm::python
