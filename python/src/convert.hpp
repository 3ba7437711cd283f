#pragma once

#include <nanobind/nanobind.h>

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "python/messages/python.hpp"
#include "python/src/arrays.hpp"

/// What all binding files share: arrays and poses in and out, failures into exceptions.
namespace mjarm::python {

namespace nb = nanobind;

/// Numbers of a caller.
using Reals = View<const double>;

/// Anything array-like; without a copy where it is such an array already.
/// @throws a BadInput that names the argument, where it holds no numbers or some that are not
/// finite.
[[nodiscard]] Reals reals(nb::handle value, const char* name);

/// The same of a given shape; a negative number stands for any.
/// @throws a BadInput with the shape that was expected and that which was given.
[[nodiscard]] Reals reals(nb::handle value, const char* name,
                          std::initializer_list<long long> shape);

/// (3,)
[[nodiscard]] Eigen::Vector3d vector3(nb::handle value, const char* name);

/// Text of a str or an os.PathLike.
[[nodiscard]] std::string path_text(nb::handle path);

/// Unit quaternion (w, x, y, z).
[[nodiscard]] std::vector<double> quat_values(const Pose& X);

[[nodiscard]] nb::object array(const JointVec& q);
/// (n, dof).
[[nodiscard]] nb::object array(std::span<const JointVec> rows, int dof);
/// (3,).
[[nodiscard]] nb::object array(const Eigen::Vector3d& v);
/// (4, 4).
[[nodiscard]] nb::object array(const Pose& X);

/// A homogeneous matrix, rows one after another.
using Homogeneous = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
[[nodiscard]] Homogeneous homogeneous(const Pose& X);

/// The rotation of (w, x, y, z), which is normalised.
/// @throws a BadInput that names the argument, where all are zero.
[[nodiscard]] Eigen::Matrix3d rotation_of_quat(const double* quat, const char* name);
/// Whether it is one, to 1e-6.
[[nodiscard]] bool is_rotation(const Eigen::Matrix3d& R);

/// A mjarm.Pose, or anything like an array of shape (4, 4).
/// @throws a BadInput that names the argument.
[[nodiscard]] Pose pose_of(nb::handle value, const char* name);
/// Many: a list of those, an array (n, 4, 4), or a pair of positions (n, 3) and quaternions (n, 4).
[[nodiscard]] std::vector<Pose> poses_of(nb::handle value, const char* name);

/// An exception class of mjarm.errors.
[[nodiscard]] nb::object error_class(const char* name);
[[noreturn]] void raise(nb::handle exception);
/// The exception of the failure's kind.
[[noreturn]] void raise(const Error& error);
[[noreturn]] void raise_bad_input(const std::string& what);
/// The same in the language in use.
template <class... Values>
[[noreturn]] void refuse(Msg message, const Values&... values) {
  raise_bad_input(text(message, values...));
}

/// The value, or the failure as an exception.
template <class T>
T value_of(Result<T>&& result) {
  if (!result) raise(result.error());
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

}  // namespace mjarm::python
