#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "apps/mjarm/learn/exercise.hpp"
#include "apps/mjarm/messages/learn.hpp"
#include "mjarm/core/line_reader.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/core/units.hpp"

namespace mjarm::app {
namespace {

using Rotations = std::vector<Eigen::Matrix3d>;
using Wxyz = std::vector<double>;

constexpr std::size_t kTurnRows = 11;  // ten steps, both ends included
constexpr std::size_t kMaxTurnRows = 100000;
constexpr std::size_t kTurnLine = 4096;  // [bytes]
constexpr double kSameTurn = 1e-6;       // [rad]
constexpr double kUnitQuat = 1e-6;
const Eigen::Vector3d kTurnBegin(std::numbers::pi, 0, 0);
const Eigen::Vector3d kTurnEnd(std::numbers::pi, std::numbers::pi / 3, std::numbers::pi / 2);

double degrees(double angle) { return angle * kDegPerRad; }

/// Angles about axes that turn along, x first.
Eigen::Matrix3d about_moving_axes(const Eigen::Vector3d& euler) {
  const auto about = [&](int axis) {
    return rotation_exp(euler[axis] * Eigen::Vector3d::Unit(axis));
  };
  return about(0) * about(1) * about(2);
}

Result<std::vector<Wxyz>> read_quats(const std::string& file) {
  std::vector<Wxyz> out;
  const auto take = [&](const JsonValue& object) -> Result<void> {
    if (out.size() >= kMaxTurnRows) {
      return fail(Errc::bad_input, text(msg::learn_too_many_lines, kMaxTurnRows));
    }
    Result<Wxyz> quat = number_list(object, "quat", 4);
    if (!quat) return fail(std::move(quat.error()));
    out.push_back(std::move(*quat));
    return {};
  };
  if (Result<void> read = read_json_lines(file, kTurnLine, take); !read) return fail(read.error());
  if (out.size() < 2) return fail(Errc::bad_input, text(msg::learn_turn_too_few, file, out.size()));
  return out;
}

double norm_of(const Wxyz& quat) { return Quat(quat[0], quat[1], quat[2], quat[3]).norm(); }

/// The first line, from 0, that is no unit quaternion; the number of lines where all are.
std::size_t first_not_unit(const std::vector<Wxyz>& quats) {
  const auto bad = std::ranges::find_if(
      quats, [](const Wxyz& quat) { return !(std::abs(norm_of(quat) - 1) < kUnitQuat); });
  return static_cast<std::size_t>(bad - quats.begin());
}

/// @param w  which of the four comes first: 0, or 3 for x, y, z, w.
Rotations rotations_of(const std::vector<Wxyz>& quats, std::size_t w) {
  Rotations out;
  for (const Wxyz& q : quats) {
    const Quat quat = w == 0 ? Quat(q[0], q[1], q[2], q[3]) : Quat(q[3], q[0], q[1], q[2]);
    out.push_back(to_matrix(quat));
  }
  return out;
}

bool has_ends(const Rotations& way, const Eigen::Matrix3d& begin, const Eigen::Matrix3d& end) {
  return angle_between(way.front(), begin) < kSameTurn &&
         angle_between(way.back(), end) < kSameTurn;
}

/// Whether the three angles, not the rotation, went evenly from one end to the other.
bool is_euler_way(const Rotations& way) {
  for (std::size_t i = 0; i < way.size(); ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(way.size() - 1);
    const Eigen::Vector3d euler = kTurnBegin + t * (kTurnEnd - kTurnBegin);
    if (!(angle_between(way[i], from_euler(euler)) < kSameTurn)) return false;
  }
  return true;
}

/// Whether the four numbers went evenly from one end to the other, and were normalised.
bool is_nlerp_way(const Rotations& way) {
  const Quat begin = to_quat(way.front());
  Quat end = to_quat(way.back());
  if (begin.dot(end) < 0) end.coeffs() = -end.coeffs();
  for (std::size_t i = 0; i < way.size(); ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(way.size() - 1);
    const Quat between(begin.coeffs() + t * (end.coeffs() - begin.coeffs()));
    if (!(angle_between(way[i], to_matrix(between)) < kSameTurn)) return false;
  }
  return true;
}

void judge_ends(const std::vector<Wxyz>& quats, const Rotations& way, LearnReport& out) {
  const Eigen::Matrix3d begin = from_euler(kTurnBegin), end = from_euler(kTurnEnd);
  if (has_ends(way, begin, end)) {
    out.right(text(msg::learn_turn_ends));
  } else if (has_ends(rotations_of(quats, 3), begin, end)) {
    out.wrong(text(msg::learn_turn_w_last));
  } else if (has_ends(way, about_moving_axes(kTurnBegin), about_moving_axes(kTurnEnd))) {
    out.wrong(text(msg::learn_turn_moving_axes));
  } else if (has_ends(way, end, begin)) {
    out.wrong(text(msg::learn_turn_backwards));
  } else {
    out.wrong(text(msg::learn_turn_other_ends, degrees(angle_between(way.front(), begin)),
                   degrees(angle_between(way.back(), end))));
  }
}

/// Of a way between the right ends: how long it is, and how even.
void judge_way(const Rotations& way, LearnReport& out) {
  const double least = angle_between(way.front(), way.back());
  double length = 0, shortest = 4, longest = 0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const double step = angle_between(way[i - 1], way[i]);
    length += step;
    shortest = std::min(shortest, step);
    longest = std::max(longest, step);
  }
  const auto steps = static_cast<double>(way.size() - 1);
  if (length > least + kSameTurn * steps) {
    out.wrong(text(msg::learn_turn_long_way, degrees(length), degrees(least)));
    const bool is_round = std::abs(length + least - 2 * std::numbers::pi) < kSameTurn * steps;
    if (is_round) out.note(text(msg::learn_turn_flip_sign));
    if (is_euler_way(way)) out.note(text(msg::learn_turn_euler));
  } else if (longest - shortest > kSameTurn) {
    out.wrong(text(msg::learn_turn_uneven, degrees(shortest), degrees(longest)));
    if (is_nlerp_way(way)) out.note(text(msg::learn_turn_nlerp));
  } else {
    out.right(text(msg::learn_turn_right, degrees(least), degrees(least / steps)));
  }
}

}  // namespace

Result<LearnReport> check_turn(const Exercise& exercise) {
  const Result<std::vector<Wxyz>> quats = read_quats(exercise.file);
  if (!quats) return fail(quats.error());
  LearnReport out;
  if (quats->size() == kTurnRows) {
    out.right(text(msg::learn_turn_rows, kTurnRows));
  } else {
    out.wrong(text(msg::learn_turn_other_rows, quats->size(), kTurnRows));
  }
  if (const std::size_t bad = first_not_unit(*quats); bad < quats->size()) {
    out.wrong(text(msg::learn_turn_not_unit, bad + 1, norm_of((*quats)[bad])));
    return out;
  }
  const Rotations way = rotations_of(*quats, 0);
  judge_ends(*quats, way, out);
  if (has_ends(way, from_euler(kTurnBegin), from_euler(kTurnEnd))) judge_way(way, out);
  return out;
}

}  // namespace mjarm::app
