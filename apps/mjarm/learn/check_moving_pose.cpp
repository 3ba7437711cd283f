#include <cmath>
#include <span>

#include "apps/mjarm/learn/exercise.hpp"
#include "apps/mjarm/learn/json_file.hpp"
#include "apps/mjarm/messages/learn.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/joint_values.hpp"

namespace mjarm::app {
namespace {

constexpr double kTogether = 1e-9;      // [m] joint values and place belong to one another
constexpr double kOneStep = 0.01;       // [m] as far as a tool may get in a step
constexpr double kRoundedPlace = 1e-3;  // [m]

/// Whether nobody wrote more than `digits` places after the point.
bool is_rounded(std::span<const double> values, int digits) {
  const double scale = std::pow(10, digits);
  for (const double value : values) {
    if (std::abs(value * scale - std::round(value * scale)) > 1e-6) return false;
  }
  return true;
}

double largest_difference(std::span<const double> a, std::span<const double> b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

}  // namespace

Result<LearnReport> check_moving_pose(const Exercise& exercise) {
  const Result<Robot> robot = robot_of(exercise, "ur5e");
  if (!robot) return fail(robot.error());
  const Arm& arm = robot->arm;
  const Result<JsonObject> object = read_json_file(exercise.file);
  if (!object) return fail(object.error());
  const auto q = number_list(**object, "q", static_cast<std::size_t>(arm.dof()));
  if (!q) return fail(in_file(exercise.file, q.error()));
  const auto pos = number_list(**object, "pos", 3);
  if (!pos) return fail(in_file(exercise.file, pos.error()));
  if (Result<void> fine = check_joint_units(*q, arm); !fine) {
    return fail(in_file(exercise.file, fine.error()));
  }

  LearnReport out;
  const Eigen::Vector3d p(pos->data());
  const double off = (fk(arm, *q).p - p).norm();
  const double from_home = (fk(arm, as_span(arm.home)).p - p).norm();
  if (largest_difference(*q, as_span(arm.home)) < 1e-6) {
    out.wrong(text(msg::learn_moving_home));
  } else if (off < kTogether) {
    out.right(text(msg::learn_moving_right, 1e3 * off));
  } else if (from_home < kTogether) {
    out.wrong(text(msg::learn_moving_place_of_home, 1e3 * off));
  } else if (off < kRoundedPlace && (is_rounded(*q, 5) || is_rounded(*pos, 5))) {
    out.wrong(text(msg::learn_moving_rounded, 1e3 * off));
  } else if (off < kOneStep) {
    out.wrong(text(msg::learn_moving_step_behind, 1e3 * off));
  } else {
    out.wrong(text(msg::learn_moving_elsewhere, 1e3 * off));
  }
  return out;
}

}  // namespace mjarm::app
