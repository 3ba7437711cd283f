#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/bench/plan_near.hpp"

namespace mjarm::app {
namespace {

constexpr double kPi = std::numbers::pi;

/// A frame on the floor, seen from the base: x outwards.
struct Place {
  double x = 0, y = 0;  ///< [m]
  double yaw = 0;       ///< [rad]

  /// So much farther out and to the left, turned by so much.
  [[nodiscard]] Place moved(double out, double left, double turn = 0) const {
    return {x + out * std::cos(yaw) - left * std::sin(yaw),
            y + out * std::sin(yaw) + left * std::cos(yaw), yaw + turn};
  }
};

Place draw_place(double nearest, double farthest, Rng& rng) {
  const Place direction{.yaw = rng.uniform(-kPi, kPi)};
  return direction.moved(rng.uniform(nearest, farthest), 0);
}

/// Adds one geom after another, each with a name of its own.
class Builder {
 public:
  void box(const Place& at, double z, double half_x, double half_y, double half_z) {
    add("box", at, z, fmt::format("{:.6f} {:.6f} {:.6f}", half_x, half_y, half_z));
  }
  /// Stands upright on height z.
  void can(const Place& at, double z, double radius, double half) {
    add("cylinder", at, z + half, fmt::format("{:.6f} {:.6f}", radius, half));
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void add(const char* type, const Place& at, double z, const std::string& size) {
    text_ += fmt::format(
        "<geom name=\"thing_{}\" type=\"{}\" size=\"{}\" pos=\"{:.6f} {:.6f} {:.6f}\" "
        "quat=\"{:.9f} 0 0 {:.9f}\"/>\n",
        ++count_, type, size, at.x, at.y, z, std::cos(at.yaw / 2), std::sin(at.yaw / 2));
  }
  int count_ = 0;
  std::string text_;
};

/// Rests on height z.
void draw_small_box(Builder& add, const Place& at, double z, Rng& rng) {
  const double half = rng.uniform(0.02, 0.1);
  add.box(at.moved(0, 0, rng.uniform(-kPi, kPi)), z + half, rng.uniform(0.02, 0.07),
          rng.uniform(0.02, 0.07), half);
}

void draw_small_can(Builder& add, const Place& at, double z, Rng& rng) {
  add.can(at, z, rng.uniform(0.02, 0.04), rng.uniform(0.04, 0.1));
}

/// A slab on four legs, cans and boxes on it.
double draw_table(Builder& add, Rng& rng) {
  constexpr double kHalfX = 0.22, kHalfY = 0.4, kHalfZ = 0.015, kLeg = 0.02;
  const Place at = draw_place(0.5, 0.65, rng);
  const double top = rng.uniform(0.05, 0.3);
  add.box(at, top - kHalfZ, kHalfX, kHalfY, kHalfZ);
  const double leg = (top - 2 * kHalfZ) / 2;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      add.box(at.moved(x * (kHalfX - kLeg), y * (kHalfY - kLeg)), leg, kLeg, kLeg, leg);
    }
  }
  for (int i = 0; i < 8; ++i) {
    const Place on = at.moved(rng.uniform(-0.15, 0.15), rng.uniform(-0.33, 0.33));
    i % 2 == 0 ? draw_small_can(add, on, top, rng) : draw_small_box(add, on, top, rng);
  }
  return top;
}

/// Three boards between two sides and a back, open towards the base, cans on the boards.
double draw_shelf(Builder& add, Rng& rng) {
  constexpr double kHalfX = 0.14, kHalfY = 0.38, kHalfZ = 0.01;
  const Place at = draw_place(0.6, 0.75, rng);
  const double lowest = rng.uniform(0.1, 0.2), gap = rng.uniform(0.28, 0.36);
  const double half = (lowest + 2 * gap) / 2;
  for (const double side : {-1.0, 1.0}) {
    add.box(at.moved(0, side * (kHalfY + kHalfZ)), half, kHalfX, kHalfZ, half);
  }
  add.box(at.moved(kHalfX + kHalfZ, 0), half, kHalfZ, kHalfY, half);
  for (int board = 0; board < 3; ++board) {
    const double z = lowest + board * gap;
    add.box(at, z - kHalfZ, kHalfX, kHalfY, kHalfZ);
    for (int i = 0; i < 2; ++i) {
      draw_small_can(add, at.moved(rng.uniform(-0.1, 0.1), rng.uniform(-0.33, 0.33)), z, rng);
    }
  }
  return 0;
}

/// Large cans that stand round the arm.
double draw_cans(Builder& add, Rng& rng) {
  for (int i = 0; i < 9; ++i) {
    add.can(draw_place(0.32, 0.8, rng), 0, rng.uniform(0.03, 0.07), rng.uniform(0.1, 0.4));
  }
  return 0;
}

/// Boxes in the air all round the arm.
double draw_boxes(Builder& add, Rng& rng) {
  for (int i = 0; i < 9; ++i) {
    const Place at = draw_place(0.32, 0.8, rng).moved(0, 0, rng.uniform(-kPi, kPi));
    add.box(at, rng.uniform(0.05, 0.9), rng.uniform(0.04, 0.12), rng.uniform(0.04, 0.12),
            rng.uniform(0.04, 0.12));
  }
  return 0;
}

/// Three walls round the arm.
double draw_walls(Builder& add, Rng& rng) {
  constexpr double kHalfX = 0.015;
  const double first = rng.uniform(-kPi, kPi);
  for (int i = 0; i < 3; ++i) {
    const Place direction{.yaw = first + 2 * kPi / 3 * (i + rng.uniform(-0.2, 0.2))};
    const double half = rng.uniform(0.2, 0.45);
    add.box(direction.moved(rng.uniform(0.4, 0.6), 0), half, kHalfX, rng.uniform(0.25, 0.45), half);
  }
  return 0;
}

struct Kind {
  const char* name;
  double (*draw)(Builder& add, Rng& rng);  ///< gives the height that nothing is walled in above
};
constexpr Kind kKinds[kNearKinds] = {{"table", draw_table},
                                     {"shelf", draw_shelf},
                                     {"cans", draw_cans},
                                     {"boxes", draw_boxes},
                                     {"walls", draw_walls}};

}  // namespace

NearThings draw_near_things(int kind, Rng& rng) {
  constexpr double kFloor = 0.1;  // [m] the least height of wrist and tool anywhere
  Builder add;
  const double top = kKinds[kind].draw(add, rng);
  return {add.text(), std::max(kFloor, top)};
}

const char* near_kind_name(int kind) { return kKinds[kind].name; }

}  // namespace mjarm::app
