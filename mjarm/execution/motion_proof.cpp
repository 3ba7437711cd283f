#include <algorithm>
#include <cmath>
#include <vector>

#include "mjarm/execution/motion_proof_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kStep = 0.1;  // [s] between moments at first
// [rad or m] Joints that leave a straight way by no more move nothing by more than
// WayProver::kSpare.
constexpr double kLeastOff = 1e-6;

class MotionProof {
 public:
  MotionProof(const Trajectory& motion, const WayProver& prover)
      : motion_(motion), prover_(prover) {}

  bool run() const {
    const double duration = motion_.duration();
    const int parts = std::max(1, static_cast<int>(std::ceil(duration / kStep)));
    std::vector<Moment> moments;
    for (int i = 0; i <= parts; ++i) moments.push_back(moment(duration * i / parts));
    // Most of what hits shows here.
    const auto is_free = [&](const Moment& at) { return prover_.is_free(at.q); };
    if (!std::ranges::all_of(moments, is_free)) return false;
    for (std::size_t i = 1; i < moments.size(); ++i) {
      if (!is_proved(moments[i - 1], moments[i])) return false;
    }
    return true;
  }

 private:
  struct Moment {
    double t;
    JointVec q;
  };
  Moment moment(double t) const { return {t, motion_.at(t).q}; }

  bool is_proved(const Moment& from, const Moment& to) const {
    const double h = to.t - from.t;
    const JointVec off = h * h / 8 * largest_acceleration(from.t, to.t);
    if (off.maxCoeff() <= kLeastOff) return prover_.is_proved(from.q, to.q);
    if (prover_.is_proved(from.q, to.q, off)) return true;
    const Moment middle = moment(0.5 * (from.t + to.t));
    return prover_.is_free(middle.q) && is_proved(from, middle) && is_proved(middle, to);
  }

  std::size_t piece_at(double t) const {
    std::size_t first = 0, end = motion_.pieces();
    while (end - first > 1) {
      const std::size_t middle = (first + end) / 2;
      (motion_.piece(middle).start <= t ? first : end) = middle;
    }
    return first;
  }

  /// Of each joint. A cubic is nowhere beyond its coefficients in Bernstein's form.
  JointVec largest_acceleration(double from, double to) const {
    JointVec out = JointVec::Zero(motion_.dof());
    for (std::size_t i = piece_at(from); i < motion_.pieces(); ++i) {
      const Trajectory::Piece piece = motion_.piece(i);
      if (piece.start >= to) break;
      const double first = std::max(from - piece.start, 0.0);
      const double last = std::min(to - piece.start, piece.duration);
      const auto a = [&](double x) -> JointVec {
        return 2 * piece.c.col(2) +
               x * (6 * piece.c.col(3) + x * (12 * piece.c.col(4) + x * 20 * piece.c.col(5)));
      };
      const auto third_of_change = [&](double x) -> JointVec {
        return (last - first) / 3 *
               (6 * piece.c.col(3) + x * (24 * piece.c.col(4) + x * 60 * piece.c.col(5)));
      };
      const JointVec a0 = a(first), a3 = a(last);
      const JointVec a1 = a0 + third_of_change(first), a2 = a3 - third_of_change(last);
      for (const JointVec* each : {&a0, &a1, &a2, &a3}) out = out.cwiseMax(each->cwiseAbs());
    }
    return out;
  }

  const Trajectory& motion_;
  const WayProver& prover_;
};

}  // namespace

bool is_proved(const Trajectory& motion, const WayProver& prover) {
  return MotionProof(motion, prover).run();
}

}  // namespace mjarm::detail
