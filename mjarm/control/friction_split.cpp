#include "mjarm/control/friction_split.hpp"

#include <algorithm>

namespace mjarm {
namespace {

/// Relative to the largest torque of a joint.
constexpr double kPrior = 0.1;           // standard deviation of load and friction at first
constexpr double kLoadDrift = 0.03;      // of the load after a second, [1/sqrt(s)]
constexpr double kFrictionDrift = 3e-3;  // of the friction
constexpr double kNoise = 3e-3;          // of a measurement of kNoiseTime
constexpr double kNoiseTime = 0.02;      // [s]
constexpr double kMaxFriction = 0.2;     // more is no friction, but something in the way

double square(double x) { return x * x; }

}  // namespace

FrictionSplit::FrictionSplit(double scale)
    : scale_(scale), p_ll_(square(kPrior * scale)), p_ff_(square(kPrior * scale)) {}

void FrictionSplit::drift(double timestep) {
  p_ll_ += square(kLoadDrift * scale_) * timestep;
  p_ff_ += square(kFrictionDrift * scale_) * timestep;
}

double FrictionSplit::measure(double disturbance, double s, double timestep) {
  const double l = p_ll_ - s * p_lf_, f = p_lf_ - s * p_ff_;  // covariance with the measurement
  const double variance = l - s * f + square(kNoise * scale_) * kNoiseTime / timestep;
  const double surprise = disturbance - (load_ - s * friction_);
  const double before = friction_;
  load_ += l / variance * surprise;
  friction_ = std::clamp(friction_ + f / variance * surprise, 0.0, kMaxFriction * scale_);
  p_ll_ -= l * l / variance;
  p_lf_ -= l * f / variance;
  p_ff_ -= f * f / variance;
  return friction_ - before;
}

}  // namespace mjarm
