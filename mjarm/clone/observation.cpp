#include "mjarm/clone/observation.hpp"

#include <algorithm>
#include <cassert>

#include "mjarm/core/rotation.hpp"

namespace mjarm::clone {
namespace {

constexpr double kWay = 0.05, kTurn = 0.2, kGrip = 0.2;  // [m], [rad], [1] units of an answer
constexpr double kNear = 0.02;                           // [m] below which places count finely

/// Appends numbers to a row.
class Row {
 public:
  explicit Row(std::span<float> out) : out_(out) {}
  void add(double value) { out_[at_++] = static_cast<float>(value); }
  void add(const Eigen::Vector3d& values) {
    for (const double value : values) add(value);
  }
  /// A place twice: as it is, and by its direction near 0, so that millimetres count there.
  void add_finely(const Eigen::Vector3d& p) {
    add(p);
    add(Eigen::Vector3d(p / (p.norm() + kNear)));
  }
  /// Two columns say all of a rotation, without jumps.
  void add(const Eigen::Matrix3d& R) {
    add(Eigen::Vector3d(R.col(0)));
    add(Eigen::Vector3d(R.col(2)));
  }
  [[nodiscard]] std::size_t size() const { return at_; }

 private:
  std::span<float> out_;
  std::size_t at_ = 0;
};

}  // namespace

int observation_size(std::size_t objects) {
  constexpr int kFixed = 3 + 6 + 1 + 6 + 6 + 6 + 6;
  return kFixed + static_cast<int>(objects) + 3 * (static_cast<int>(objects) - 1);
}

void write_observation(const Observed& seen, std::span<float> out) {
  Row row(out);
  const Pose X_TW = seen.X_WT.inverse();
  const Pose X_TB = X_TW * seen.objects[seen.target];
  row.add(seen.X_WT.p);
  row.add(seen.X_WT.R);
  row.add(seen.grip);
  row.add_finely(X_TB.p);
  row.add(X_TB.R);
  row.add_finely(X_TW * seen.p_place);
  row.add_finely(seen.p_place - seen.objects[seen.target].p);
  for (std::size_t i = 0; i < seen.objects.size(); ++i) row.add(i == seen.target ? 1 : 0);
  for (std::size_t i = 0; i < seen.objects.size(); ++i) {
    if (i != seen.target) row.add(X_TW * seen.objects[i].p);
  }
  assert(static_cast<int>(row.size()) == observation_size(seen.objects.size()));
}

void write_answer(const Observed& seen, const Answer& answer, std::span<float> out) {
  const Pose way = seen.X_WT.inverse() * answer.X_WT;
  Row row(out);
  row.add(Eigen::Vector3d(way.p / kWay));
  row.add(Eigen::Vector3d(rotation_log(way.R) / kTurn));
  row.add((answer.grip - seen.grip) / kGrip);
}

Answer read_answer(const Observed& seen, std::span<const float> numbers) {
  const auto vector = [&](std::size_t first, double unit) {
    return Eigen::Vector3d(unit *
                           Eigen::Vector3d(numbers[first], numbers[first + 1], numbers[first + 2]));
  };
  const Pose way{.p = vector(0, kWay), .R = rotation_exp(vector(3, kTurn))};
  return {.X_WT = seen.X_WT * way,
          .grip = std::clamp(seen.grip + kGrip * double(numbers[6]), 0.0, 1.0)};
}

}  // namespace mjarm::clone
