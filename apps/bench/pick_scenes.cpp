#include "apps/bench/pick_scenes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "mjarm/core/rotation.hpp"

namespace mjarm::app {
namespace {

using Eigen::Matrix3d;

constexpr double kHalfTurn = std::numbers::pi;
constexpr double kTable = 0.2;    // [m] height of the table
constexpr double kTray = 0.206;   // [m] height of the tray's floor
constexpr double kApart = 0.12;   // [m] between the middles of two objects
constexpr int kMaxDraws = 10000;  // of a place beside the others
constexpr double kMinX = 0.34, kMaxX = 0.64, kMinY = 0.03, kMaxY = 0.34;  // [m]

Pose resting(const Rest& rest, double x, double y, double floor, double yaw) {
  return {.p = {x, y, floor + rest.height}, .R = from_euler({0, 0, yaw}) * rest.R_WB};
}

double random_yaw(Rng& rng) { return rng.uniform(-kHalfTurn, kHalfTurn); }

PickProblem draw_table_scene(Rng& rng) {
  PickProblem out{.seed = rng.next()};
  std::vector<Rest> chosen;
  for (const char* name : {"box", "can", "house"}) {
    chosen.push_back(random_rest(rng, name));
    const auto is_apart = [&](const Pose& pose) {
      return std::ranges::all_of(out.objects, [&](const PlacedObject& other) {
        return (other.X_WB.p - pose.p).head<2>().norm() >= kApart;
      });
    };
    Pose pose;
    for (int draw = 0; draw == 0 || (!is_apart(pose) && draw < kMaxDraws); ++draw) {
      pose = somewhere_on_table(rng, chosen.back());
    }
    out.objects.push_back({name, pose});
  }
  const std::size_t target = rng.below(out.objects.size());
  out.task.object = out.objects[target].name;
  out.task.place = somewhere_in_tray(rng, chosen[target]);
  return out;
}

/// Whether it looks the same however it is turned about its z.
bool is_round(const std::string& object) { return object == "can" || object == "puck"; }

/// In how many ways about x, y and z it looks the same.
std::array<int, 3> folds_of(const std::string& object) {
  if (object == "box") return {2, 2, 2};
  if (object == "house") return {1, 1, 2};
  if (object == "cube") return {4, 4, 4};
  if (object == "bar") return {4, 2, 2};
  if (object == "prism") return {2, 2, 6};
  return {1, 1, 1};
}

}  // namespace

std::vector<Rest> rests_of(const std::string& object) {
  const auto turned = [](double roll, double pitch) { return from_euler({roll, pitch, 0}); };
  if (object == "can") return {{turned(0, 0), 0.05}, {turned(kHalfTurn / 2, 0), 0.028}};
  if (object == "box") {
    return {
        {turned(0, 0), 0.03}, {turned(kHalfTurn / 2, 0), 0.02}, {turned(0, kHalfTurn / 2), 0.025}};
  }
  if (object == "house") return {{turned(0, 0), 0.03}};
  if (object == "cube") return {{turned(0, 0), 0.016}};
  if (object == "bar") return {{turned(0, 0), 0.012}};
  if (object == "puck") return {{turned(0, 0), 0.014}};
  if (object == "prism") return {{turned(0, 0), 0.025}};
  return {{turned(0, 0), 0}};  // the bracket
}

Rest random_rest(Rng& rng, const std::string& object) {
  const std::vector<Rest> rests = rests_of(object);
  return rests[rng.below(3) == 0 ? rng.below(rests.size()) : 0];
}

bool is_on_table(double x, double y) {
  return x >= kMinX && x <= kMaxX && y >= kMinY && y <= kMaxY;
}

Pose on_table(const Rest& rest, double x, double y, double yaw) {
  return resting(rest, x, y, kTable, yaw);
}

Pose somewhere_on_table(Rng& rng, const Rest& rest) {
  const double x = rng.uniform(kMinX, kMaxX);
  const double y = rng.uniform(kMinY, kMaxY);
  return on_table(rest, x, y, random_yaw(rng));
}

program::PlaceGoal somewhere_in_tray(Rng& rng, const Rest& rest) {
  const double x = rng.uniform(0.44, 0.56);
  const double y = rng.uniform(-0.34, -0.18);
  return {.X_WB = resting(rest, x, y, kTray, random_yaw(rng)), .any_turn = false};
}

Result<PickSet> table_scenes(const std::string& robot, std::uint64_t seed) {
  const char* file =
      robot == "panda" ? "franka_emika_panda/pick.xml" : "universal_robots_ur5e/pick.xml";
  Result<Robot> loaded = mjarm::load_robot(file);
  if (!loaded) return fail(std::move(loaded.error()));
  return PickSet{.name = "table",
                 .robot = robot,
                 .loaded = std::move(*loaded),
                 .draw = [seed](std::uint64_t i) -> Result<PickProblem> {
                   Rng rng(seed, i);
                   return draw_table_scene(rng);
                 }};
}

double turn_between(const std::string& object, const Matrix3d& A, const Matrix3d& B) {
  if (is_round(object)) return std::acos(std::min(1.0, std::abs(A.col(2).dot(B.col(2)))));
  double least = angle_between(A, B);
  const auto [nx, ny, nz] = folds_of(object);
  for (int i = 0; i < nx * ny * nz; ++i) {
    const double x = 2 * kHalfTurn * (i % nx) / nx;
    const double y = 2 * kHalfTurn * (i / nx % ny) / ny;
    const double z = 2 * kHalfTurn * (i / nx / ny) / nz;
    least = std::min(least, angle_between(A * from_euler({x, y, z}), B));
  }
  return least;
}

}  // namespace mjarm::app
