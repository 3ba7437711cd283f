#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/planning/search_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr int kMaxFailed = 30;        // cuts in a row that did not work: enough
constexpr int kPulls = 1;             // rounds over all corners at most
constexpr double kLeastPull = 0.4;    // share of the way to the straight line
constexpr double kLeastGain = 1e-3;   // share of the length that a cut must save
constexpr double kFirstStep = 0.2;    // [rad or m, L2] that a corner is moved by at first,
constexpr double kLeastStep = 1e-3;   // and at least;
constexpr double kLeastSaved = 0.02;  // of a step: less does not count
constexpr double kLonger = 1.5, kShorter = 0.85;  // the next step after one that worked or failed
constexpr int kKeptCuts = 8;                      // times as many attempts, and
constexpr int kKeptPulls = 12;  // so many rounds, where keeping to regions needs many corners

class Shortener {
 public:
  Shortener(const FastChecker& checker, const PathKeeper* keeper, const PlanOptions& options,
            RawPath& path)
      : q_(path.q),
        keeper_(keeper),
        prover_(checker, keeper, options, path.counts),
        rng_(options.seed, 1) {}

  void run(int attempts) {
    skip_corners();
    int failed = 0;
    if (keeper_ != nullptr) attempts *= kKeptCuts;
    for (int k = 0; k < attempts && q_.size() > 2 && failed < kMaxFailed; ++k) {
      failed = cut() ? 0 : failed + 1;
    }
    const int pulls = keeper_ != nullptr ? kKeptPulls : kPulls;
    for (int round = 0; round < pulls && pull_corners(); ++round) continue;
  }

  /// Moves corners by random steps that make the path shorter, also along what is in the way.
  void slide(int attempts) {
    double step = kFirstStep;
    for (int k = 0; k < attempts && q_.size() > 2 && step > kLeastStep; ++k) {
      const std::size_t i = 1 + static_cast<std::size_t>(rng_.below(q_.size() - 2));
      step *= slide_corner(i, step) ? kLonger : kShorter;
    }
  }

 private:
  /// Leaves out corners as long as that works, the most at once first.
  void skip_corners() {
    for (std::size_t i = 0; i + 2 < q_.size(); ++i) {
      for (std::size_t j = q_.size() - 1; j > i + 1; --j) {
        if (!prover_.is_free(as_span(q_[i]), as_span(q_[j]))) continue;
        q_.erase(at(i + 1), at(j));
        break;
      }
    }
  }

  /// Replaces what is between two random places of different edges by a straight edge.
  bool cut() {
    std::array<double, 64> ends;
    double length = 0;
    const std::size_t edges = std::min(q_.size() - 1, ends.size());
    for (std::size_t i = 0; i < edges; ++i) {
      length += (q_[i + 1] - q_[i]).norm();
      ends[i] = length;
    }
    double a = rng_.uniform() * length, b = rng_.uniform() * length;
    if (a > b) std::swap(a, b);
    const std::size_t i = edge_at({ends.data(), edges}, a), j = edge_at({ends.data(), edges}, b);
    if (i == j) return false;
    const JointVec from = place(i, a - (i > 0 ? ends[i - 1] : 0));
    const JointVec to = place(j, b - (j > 0 ? ends[j - 1] : 0));
    const double max = (1 - kLeastGain) * (b - a);
    if ((to - from).norm() > max) return false;
    std::vector<JointVec> way{from, to};
    if (!prover_.is_free(as_span(from), as_span(to)) && !walk(max, way)) return false;
    // The halves of a proved edge are proved again at the end.
    q_.erase(at(i + 1), at(j + 1));
    q_.insert(at(i + 1), way.begin(), way.end());
    return true;
  }

  /// Within regions of the tool: fills in short steps between both ends of `way`, which may become
  /// as long as `max`.
  bool walk(double max, std::vector<JointVec>& way) {
    if (keeper_ == nullptr) return false;
    const JointVec to = way.back();
    way.pop_back();
    const double range = keeper_->range();
    double left = (to - way.back()).norm();
    for (; left > range; left = (to - way.back()).norm()) {
      JointVec next(to.size());
      const std::span<double> out(next.data(), static_cast<std::size_t>(next.size()));
      const auto length = keeper_->step(as_span(way.back()), as_span(to), range, out);
      if (!length || *length + (to - next).norm() > max) return false;
      max -= *length;
      if (!prover_.is_free(as_span(way.back()), as_span(next))) return false;
      way.push_back(next);
    }
    if (left > max || !prover_.is_free(as_span(way.back()), as_span(to))) return false;
    way.push_back(to);
    return true;
  }

  /// Moves every corner towards the straight line between its neighbours.
  bool pull_corners() {
    bool moved = false;
    for (std::size_t i = 1; i + 1 < q_.size(); ++i) moved = pull(i) || moved;
    return moved;
  }

  bool pull(std::size_t i) {
    const JointVec a = q_[i - 1], b = q_[i + 1];
    const double to_a = (q_[i] - a).norm(), to_b = (q_[i] - b).norm();
    const JointVec straight = a + to_a / (to_a + to_b) * (b - a);
    for (double share = 1; share > kLeastPull; share *= 0.5) {
      JointVec moved = q_[i] + share * (straight - q_[i]);
      if (keeper_ != nullptr && !put_back(a, b, to_a + to_b, moved)) continue;
      if (!prover_.is_free(as_span(a), as_span(moved)) ||
          !prover_.is_free(as_span(moved), as_span(b))) {
        continue;
      }
      q_[i] = moved;
      return true;
    }
    return false;
  }

  bool slide_corner(std::size_t i, double step) {
    const JointVec &a = q_[i - 1], &b = q_[i + 1];
    const double length = (q_[i] - a).norm() + (q_[i] - b).norm();
    const JointVec shorter = (a - q_[i]).normalized() + (b - q_[i]).normalized();
    JointVec way(q_[i].size());
    for (double& x : way) x = rng_.normal();
    way *= (way.dot(shorter) < 0 ? -step : step) / std::max(way.norm(), 1e-9);
    JointVec moved = q_[i] + way;
    if (keeper_ != nullptr && !put_back(a, b, length, moved)) return false;
    if ((moved - a).norm() + (moved - b).norm() > length - kLeastSaved * step) return false;
    if (!prover_.is_free(as_span(a), as_span(moved)) ||
        !prover_.is_free(as_span(moved), as_span(b))) {
      return false;
    }
    q_[i] = moved;
    return true;
  }

  /// Puts a corner back within the regions of the tool, if the way over it is still shorter.
  bool put_back(const JointVec& a, const JointVec& b, double length, JointVec& corner) const {
    if (!keeper_->project({corner.data(), static_cast<std::size_t>(corner.size())})) return false;
    return (corner - a).norm() + (corner - b).norm() < (1 - kLeastGain) * length;
  }

  static std::size_t edge_at(std::span<const double> ends, double length) {
    const auto found = std::upper_bound(ends.begin(), ends.end() - 1, length);
    return static_cast<std::size_t>(found - ends.begin());
  }
  JointVec place(std::size_t edge, double along) const {
    const double length = (q_[edge + 1] - q_[edge]).norm();
    return q_[edge] + along / length * (q_[edge + 1] - q_[edge]);
  }
  std::vector<JointVec>::iterator at(std::size_t i) {
    return q_.begin() + static_cast<std::ptrdiff_t>(i);
  }

  std::vector<JointVec>& q_;
  const PathKeeper* keeper_;
  EdgeProver prover_;
  Rng rng_;
};

}  // namespace

void shorten(const FastChecker& checker, const PathKeeper* keeper, const PlanOptions& options,
             int attempts, RawPath& path) {
  if (path.q.size() > 2) Shortener(checker, keeper, options, path).run(attempts);
}

void slide_corners(const FastChecker& checker, const PathKeeper* keeper, const PlanOptions& options,
                   int attempts, RawPath& path) {
  if (path.q.size() > 2) Shortener(checker, keeper, options, path).slide(attempts);
}

}  // namespace mjarm::detail
