#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "mjarm/planning/verify_region_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr int kValues = 1000;              // of a mechanism that are tried all over its range
constexpr int kThirds = 60;                // of an interval, in the search for its best value
constexpr double kNearValues = 0.1;        // [rad or m] from one place to the next
constexpr double kClosestPlaces = 0x1p-9;  // share of the way from one place to the next

/// By how much more there is than is stated; what is not bounded is enough.
double more_than(double stated, double there) {
  return std::isinf(there) ? std::numeric_limits<double>::infinity() : there - stated;
}

bool goes_round(const Mechanism& mechanism) {
  return mechanism.type == JointType::hinge &&
         mechanism.max - mechanism.min >= 2 * std::numbers::pi * (1 - 1e-9);
}

}  // namespace

double RegionWatch::spare(const RegionRoom& room) const {
  return std::min(more_than(given_.room.place, room.place), more_than(given_.room.turn, room.turn));
}

double RegionWatch::spare(double value, const Pose& X_WT) const {
  return spare(room_in(standing_at(given_.region, value), X_WT));
}

/// Where there is one best value between these, that one.
double RegionWatch::best_between(double least, double most, const Pose& X_WT) const {
  for (int k = 0; k < kThirds; ++k) {
    const double a = least + (most - least) / 3, b = most - (most - least) / 3;
    if (spare(a, X_WT) < spare(b, X_WT)) {
      least = a;
    } else {
      most = b;
    }
  }
  return 0.5 * (least + most);
}

double RegionWatch::best_of_all(const Pose& X_WT) const {
  const Mechanism& mechanism = *given_.region.mechanism;
  const double step = (mechanism.max - mechanism.min) / kValues;
  const auto value = [&](int k) { return mechanism.min + std::clamp(k, 0, kValues) * step; };
  std::vector<double> spares;
  for (int k = 0; k <= kValues; ++k) spares.push_back(spare(value(k), X_WT));
  const auto at = [&](int k) {
    return spares[static_cast<std::size_t>(std::clamp(k, 0, kValues))];
  };
  double best = mechanism.min, most = at(0);
  const auto offer = [&](double tried, double there) {
    if (there <= most) return;
    best = tried;
    most = there;
  };
  for (int k = 0; k <= kValues; ++k) {
    if (at(k) < at(k - 1) || at(k) < at(k + 1)) continue;
    const double refined = best_between(value(k - 1), value(k + 1), X_WT);
    offer(value(k), at(k));
    offer(refined, spare(refined, X_WT));
  }
  return best;
}

/// Leaves the mechanism where it is, or moves it a little.
/// @return false where that does not do.
bool RegionWatch::follow(const Pose& X_WT) {
  const Mechanism& mechanism = *given_.region.mechanism;
  if (!value_) value_ = best_of_all(X_WT);
  if (spare(*value_, X_WT) >= -kRoomSlack) return true;
  double least = *value_ - kNearValues, most = *value_ + kNearValues;
  if (!goes_round(mechanism)) {
    least = std::max(least, mechanism.min);
    most = std::min(most, mechanism.max);
  }
  const double moved = best_between(least, most, X_WT);
  if (spare(moved, X_WT) < -kRoomSlack) return false;
  value_ = moved;
  return true;
}

RegionWatch::Found RegionWatch::look(const std::function<Pose(double)>& X_WT, double from,
                                     double to) {
  const Pose there = X_WT(to);
  const auto enough = [&](const RegionRoom& room) { return spare(room) >= -kRoomSlack; };
  if (!given_.region.mechanism) {
    const RegionRoom room = room_in(given_.region, there);
    return {.kept = enough(room), .room = room};
  }
  // In smaller and smaller steps, where the mechanism is lost from sight.
  const double closest = kClosestPlaces * (to - from);
  for (double step = to - from; !follow(there);) {
    while (step > closest && !follow(X_WT(from + step))) step *= 0.5;
    if (!(step > closest)) {
      value_ = best_of_all(there);
      const RegionRoom room = room_in(standing_at(given_.region, *value_), there);
      return {.kept = enough(room), .jumped = true, .room = room};
    }
    from += step;
    step = to - from;
  }
  return {.kept = true, .room = room_in(standing_at(given_.region, *value_), there)};
}

}  // namespace mjarm::detail
