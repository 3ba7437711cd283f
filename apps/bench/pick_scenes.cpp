#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "apps/bench/pick.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm::app {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kHalfTurn = std::numbers::pi;
constexpr double kTable = 0.2;    // [m] height of the table
constexpr double kTray = 0.206;   // [m] height of the tray's floor
constexpr double kApart = 0.12;   // [m] between the middles of two objects
constexpr int kMaxDraws = 10000;  // of a place beside the others

/// How an object may rest: what is up then, and its middle's height.
struct Rest {
  Matrix3d R_WB;
  double height;
};

Matrix3d turned(double roll, double pitch) { return from_euler({roll, pitch, 0}); }

/// The ways in which objects of the shipped table rest.
std::vector<Rest> rests_of(const std::string& object) {
  if (object == "can") return {{turned(0, 0), 0.05}, {turned(kHalfTurn / 2, 0), 0.028}};
  if (object == "box") {
    return {
        {turned(0, 0), 0.03}, {turned(kHalfTurn / 2, 0), 0.02}, {turned(0, kHalfTurn / 2), 0.025}};
  }
  return {{turned(0, 0), 0.03}};
}

Pose resting(const Rest& rest, double x, double y, double floor, double yaw) {
  return {.p = {x, y, floor + rest.height}, .R = from_euler({0, 0, yaw}) * rest.R_WB};
}

PickProblem draw_table_scene(Rng& rng) {
  PickProblem out{.seed = rng.next()};
  std::vector<Rest> chosen;
  for (const char* name : {"box", "can", "house"}) {
    const std::vector<Rest> rests = rests_of(name);
    chosen.push_back(rests[rng.below(3) == 0 ? rng.below(rests.size()) : 0]);
    const auto is_apart = [&](const Pose& pose) {
      return std::ranges::all_of(out.objects, [&](const PlacedObject& other) {
        return (other.X_WB.p - pose.p).head<2>().norm() >= kApart;
      });
    };
    Pose pose;
    for (int draw = 0; draw == 0 || (!is_apart(pose) && draw < kMaxDraws); ++draw) {
      pose = resting(chosen.back(), rng.uniform(0.34, 0.64), rng.uniform(0.03, 0.34), kTable,
                     rng.uniform(-kHalfTurn, kHalfTurn));
    }
    out.objects.push_back({name, pose});
  }
  const std::size_t target = rng.below(out.objects.size());
  out.task.object = out.objects[target].name;
  out.task.place = program::PlaceGoal{
      .X_WB = resting(chosen[target], rng.uniform(0.44, 0.56), rng.uniform(-0.34, -0.18), kTray,
                      rng.uniform(-kHalfTurn, kHalfTurn)),
      .any_turn = false};
  return out;
}

}  // namespace

Result<PickSet> draw_table_scenes(const std::string& robot, int count, std::uint64_t seed) {
  const char* file =
      robot == "panda" ? "franka_emika_panda/pick.xml" : "universal_robots_ur5e/pick.xml";
  Result<Robot> loaded = mjarm::load_robot(file);
  if (!loaded) return fail(std::move(loaded.error()));
  PickSet out{.name = "table", .robot = robot, .loaded = std::move(*loaded), .problems = {}};
  for (int i = 0; i < count; ++i) {
    Rng rng(seed, static_cast<std::uint64_t>(i));
    out.problems.push_back(draw_table_scene(rng));
  }
  return out;
}

double turn_between(const std::string& object, const Matrix3d& A, const Matrix3d& B) {
  if (object == "can") return std::acos(std::min(1.0, std::abs(A.col(2).dot(B.col(2)))));
  double least = angle_between(A, B);
  for (int axis = object == "box" ? 0 : 2; axis < 3; ++axis) {
    const Eigen::AngleAxisd half(kHalfTurn, Vector3d::Unit(axis));
    least = std::min(least, angle_between(A * half.toRotationMatrix(), B));
  }
  return least;
}

}  // namespace mjarm::app
