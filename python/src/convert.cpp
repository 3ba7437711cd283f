#include "python/src/convert.hpp"

#include <nanobind/stl/string.h>

#include <algorithm>
#include <memory>

#include "mjarm/core/finite.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm::python {
namespace {

std::string shape_text(const Reals& array) {
  std::string out = "(";
  for (std::size_t i = 0; i < array.ndim(); ++i) {
    out += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
  }
  return out + (array.ndim() == 1 ? ",)" : ")");
}

std::string shape_text(std::span<const long long> shape) {
  std::string out = "(";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    out += (i > 0 ? ", " : "") + (shape[i] < 0 ? "n" : std::to_string(shape[i]));
  }
  return out + (shape.size() == 1 ? ",)" : ")");
}

bool has_shape(const Reals& array, std::span<const long long> shape) {
  if (array.ndim() != shape.size()) return false;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    if (shape[i] >= 0 && array.shape(i) != static_cast<std::size_t>(shape[i])) return false;
  }
  return true;
}

Pose pose_of_matrix(const double* m, const char* name) {
  const Eigen::Map<const Homogeneous> matrix(m);
  const Pose X{matrix.topRightCorner<3, 1>(), matrix.topLeftCorner<3, 3>()};
  const Eigen::RowVector4d last(0, 0, 0, 1);
  if (!is_rotation(X.R) || !(matrix.row(3) - last).isZero(1e-9)) refuse(msg::python_no_pose, name);
  return X;
}

}  // namespace

Reals reals(nb::handle value, const char* name) {
  std::optional<Reals> out = Reals::of(value);
  if (!out) {
    nb::object made;
    try {
      // Text is no number to us, though numpy reads some.
      made = nb::module_::import_("numpy").attr("asarray")(value);
      if (nb::cast<std::string>(made.attr("dtype").attr("kind")).find_first_of("buif") != 0) {
        throw nb::type_error("");
      }
      made = nb::module_::import_("numpy").attr("asarray")(made, "float64", "C");
    } catch (const std::exception&) {
      refuse(msg::python_no_numbers, name,
             nb::cast<std::string>(nb::str(nb::handle(value).type().attr("__name__"))));
    }
    out = Reals::of(made);
  }
  if (!all_finite(out->span())) refuse(msg::python_not_finite, name);
  return std::move(*out);
}

Reals reals(nb::handle value, const char* name, std::initializer_list<long long> shape) {
  Reals out = reals(value, name);
  const std::span<const long long> wanted(shape.begin(), shape.size());
  if (!has_shape(out, wanted)) {
    refuse(msg::python_shape, name, shape_text(wanted), shape_text(out));
  }
  return out;
}

Eigen::Vector3d vector3(nb::handle value, const char* name) {
  return Eigen::Map<const Eigen::Vector3d>(reals(value, name, {3}).data());
}

std::string path_text(nb::handle path) {
  return nb::cast<std::string>(nb::module_::import_("os").attr("fspath")(path));
}

std::vector<double> quat_values(const Pose& X) {
  const Quat q = to_quat(X.R);
  return {q.w(), q.x(), q.y(), q.z()};
}

nb::object array(const JointVec& q) {
  return array<double>(q, {static_cast<std::size_t>(q.size())});
}

nb::object array(std::span<const JointVec> rows, int dof) {
  const NewArray<double> made({rows.size(), static_cast<std::size_t>(dof)});
  double* to = made.data;
  for (const JointVec& row : rows) to = std::copy(row.begin(), row.end(), to);
  return made.object;
}

nb::object array(const Eigen::Vector3d& v) { return array<double>(v, {3}); }

nb::object array(const Pose& X) {
  const NewArray<double> made({4, 4});
  Eigen::Map<Homogeneous>(made.data) = homogeneous(X);
  return made.object;
}

Homogeneous homogeneous(const Pose& X) {
  Homogeneous out = Homogeneous::Identity();
  out.topLeftCorner<3, 3>() = X.R;
  out.topRightCorner<3, 1>() = X.p;
  return out;
}

Eigen::Matrix3d rotation_of_quat(const double* quat, const char* name) {
  const Quat turn(quat[0], quat[1], quat[2], quat[3]);
  if (turn.norm() < 1e-9) refuse(msg::python_zero_quat, name);
  return to_matrix(turn);
}

bool is_rotation(const Eigen::Matrix3d& R) {
  const double off = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  return off <= 1e-6 && R.determinant() > 0;
}

Pose pose_of(nb::handle value, const char* name) {
  if (nb::isinstance<Pose>(value)) return nb::cast<const Pose&>(value);
  return pose_of_matrix(reals(value, name, {4, 4}).data(), name);
}

std::vector<Pose> poses_of(nb::handle value, const char* name) {
  std::vector<Pose> out;
  if (nb::isinstance<nb::tuple>(value) && nb::len(value) == 2 && !nb::isinstance<Pose>(value[0]) &&
      reals(value[0], name).ndim() == 2 && reals(value[0], name).shape(1) == 3) {
    const Reals pos = reals(value[0], name, {-1, 3});
    const Reals quat = reals(value[1], name, {static_cast<long long>(pos.shape(0)), 4});
    for (std::size_t i = 0; i < pos.shape(0); ++i) {
      out.push_back({Eigen::Map<const Eigen::Vector3d>(pos.data() + 3 * i),
                     rotation_of_quat(quat.data() + 4 * i, name)});
    }
    return out;
  }
  if (nb::isinstance<nb::sequence>(value) && nb::len(value) > 0 && nb::isinstance<Pose>(value[0])) {
    for (const nb::handle one : value) out.push_back(pose_of(one, name));
    return out;
  }
  const Reals matrices = reals(value, name, {-1, 4, 4});
  out.reserve(matrices.shape(0));
  for (std::size_t i = 0; i < matrices.shape(0); ++i) {
    out.push_back(pose_of_matrix(matrices.data() + 16 * i, name));
  }
  return out;
}

nb::object error_class(const char* name) { return nb::module_::import_("mjarm.errors").attr(name); }

void raise(nb::handle exception) {
  PyErr_SetObject(exception.type().ptr(), exception.ptr());
  throw nb::python_error();
}

void raise(const Error& error) {
  const char* const kind = [&] {
    switch (error.code) {
      case Errc::bad_input:
        return "BadInput";
      case Errc::usage:
        return "Usage";
      case Errc::impossible:
        return "Impossible";
      case Errc::system:
        return "SystemFault";
      case Errc::not_available:
        return "NotAvailable";
    }
    return "Error";
  }();
  raise(error_class(kind)(error.what));
}

void raise_bad_input(const std::string& what) { raise(Error{Errc::bad_input, what}); }

}  // namespace mjarm::python
