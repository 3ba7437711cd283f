#include "mjarm/kinematics/seven_axis.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/kinematics/seven_axis_search_internal.hpp"

namespace mjarm::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kMeet = 1e-7;    // [m] axes that come so near to each other meet
constexpr double kTwist = 1e-3;   // sine of the least angle between neighbouring axes that meet
constexpr double kOffset = 1e-4;  // [m^2] least product of the two arms of the elbow

/// Where the z axis of frame A meets that of frame B: its height on either.
struct Meeting {
  double on_a = 0;
  double on_b = 0;
};

std::optional<Meeting> meeting(const Pose& X_AB) {
  const Vector3d b = X_AB.R.col(2);
  const double sine2 = b.x() * b.x() + b.y() * b.y();
  if (sine2 < kTwist * kTwist) return std::nullopt;
  const double on_b = -(b.x() * X_AB.p.x() + b.y() * X_AB.p.y()) / sine2;
  const Vector3d point = X_AB.p + on_b * b;
  if (std::hypot(point.x(), point.y()) > kMeet) return std::nullopt;
  return Meeting{point.z(), on_b};
}

void copy(const Matrix3d& from, double* to) { std::copy_n(from.data(), 9, to); }
void copy(const Vector3d& from, double* to) { std::copy_n(from.data(), 3, to); }

}  // namespace

std::optional<SevenAxis> SevenAxis::recognise(const Chain& chain) {
  if (chain.dof != 7) return std::nullopt;
  if (std::any_of(chain.slide.begin(), chain.slide.begin() + 7, [](bool slide) { return slide; })) {
    return std::nullopt;
  }
  SevenAxis out(chain);
  if (!out.set_geometry()) return std::nullopt;
  return out;
}

bool SevenAxis::set_geometry() {
  const auto& X = chain_.X_PJ;
  const auto first = meeting(X[1]);
  const auto second = meeting(X[2]);
  const auto wrist = meeting(X[5]);
  if (!first || !second || !wrist) return false;
  if (std::abs(first->on_b - second->on_a) > kMeet) return false;
  const Vector3d p_3uS = X[3].inverse() * Vector3d(0, 0, second->on_b);
  const Vector3d p_3W = X[4] * Vector3d(0, 0, wrist->on_a);
  if (p_3uS.head<2>().norm() * p_3W.head<2>().norm() < kOffset) return false;
  copy(p_3uS, geometry_.p_3uS);
  copy(p_3W, geometry_.p_3W);
  copy(X[6].inverse() * Vector3d(0, 0, wrist->on_b), geometry_.p_6uW);
  copy(X[0] * Vector3d(0, 0, first->on_a), geometry_.p_WS);
  geometry_.X_T6 = chain_.X_JT.inverse();
  double* const to[] = {geometry_.R_W0, geometry_.R_01, geometry_.R_12, geometry_.R_23,
                        geometry_.R_34, geometry_.R_45, geometry_.R_56};
  for (std::size_t i = 0; i < 7; ++i) {
    copy(X[i].R, to[i]);
    const bool free = chain_.full_turn[i];
    const double middle = free ? 0 : 0.5 * (chain_.lower[i] + chain_.upper[i]);
    geometry_.middle[i] = middle;
    geometry_.middle_cos[i] = std::cos(middle);
    geometry_.middle_sin[i] = std::sin(middle);
    geometry_.half_cos[i] = free ? -2 : std::cos(0.5 * (chain_.upper[i] - chain_.lower[i]));
  }
  return true;
}

void SevenAxis::branches(const BranchQuery& query, Branches& out) const noexcept {
  SevenSearch(geometry_, chain_, query, out).run();
}

}  // namespace mjarm::detail
