#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mjarm/trajectory/reference_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kMaxCells = 5000;  // of the time law, where waypoints do not ask for more

/// Time at which `smooth` meets `s`, within [from, to]: Newton's method kept between bounds.
double time_of(const SmoothProfile& smooth, double s, double from, double to) {
  double t = 0.5 * (from + to);
  for (int k = 0; k < 60 && to - from > 1e-14 * to; ++k) {
    const PathState x = smooth.at(t);
    if (x.s == s) return t;
    (x.s < s ? from : to) = t;
    const double next = t - (x.s - s) / x.v;
    const bool inside = next > from && next < to;
    if (inside && std::abs(next - t) < 1e-15 * to) return next;
    t = inside ? next : 0.5 * (from + to);
  }
  return t;
}

/// The quintic between two states `h` seconds apart, of x = time / h in [0, 1].
class Between {
 public:
  Between(const PathState& from, const PathState& to, double h) : start_(from.s), h_(h) {
    c_ = {0, h * from.v, 0.5 * h * h * from.a};
    const double ds = to.s - from.s - c_[1] - c_[2], dv = h * to.v - c_[1] - 2 * c_[2];
    const double da = h * h * to.a - 2 * c_[2];
    c_[3] = 10 * ds - 4 * dv + 0.5 * da;
    c_[4] = -15 * ds + 7 * dv - da;
    c_[5] = 6 * ds - 3 * dv + 0.5 * da;
  }

  [[nodiscard]] PathState at(double x) const {
    const double s = x * (c_[1] + x * (c_[2] + x * (c_[3] + x * (c_[4] + x * c_[5]))));
    const double v = c_[1] + x * (2 * c_[2] + x * (3 * c_[3] + x * (4 * c_[4] + x * 5 * c_[5])));
    const double a = 2 * c_[2] + x * (6 * c_[3] + x * (12 * c_[4] + x * 20 * c_[5]));
    const double j = 6 * c_[3] + x * (24 * c_[4] + x * 60 * c_[5]);
    return {start_ + s, v / h_, a / (h_ * h_), j / (h_ * h_ * h_)};
  }
  /// Where it meets `s`, within [from, 1]: Newton's method kept between bounds.
  [[nodiscard]] double meets(double s, double from) const {
    double low = from, high = 1, x = 0.5 * (low + high);
    for (int k = 0; k < 60; ++k) {
      const PathState now = at(x);
      (now.s < s ? low : high) = x;
      const double next = x - (now.s - s) / (h_ * now.v);
      if (std::abs(next - x) < 1e-14) break;
      x = next > low && next < high ? next : 0.5 * (low + high);
    }
    return x;
  }

 private:
  double start_, h_;
  std::array<double, 6> c_;
};

/// Makes a reference cell by cell of the time law.
class Sampler {
 public:
  Sampler(const CubicSpline& spline, const SmoothProfile& smooth, double cells)
      : knots_(spline.knots()), smooth_(smooth), longest_(smooth.duration() / cells) {
    fewest_ = 2 * static_cast<double>(knots_.size()) > cells ? 1 : 2;
  }

  /// One piece of the spline, in even cells.
  void add_piece(std::size_t piece, double from, double to) {
    const double count = std::max(fewest_, std::ceil((to - from) / longest_));
    for (int k = 0; k < count; ++k) {
      const double t = from + (to - from) * k / count;
      PathState state = smooth_.at(t);
      if (k == 0) state.s = knots_[piece];
      add_knot(t, state, piece);
    }
  }
  /// The pieces from waypoint `first` to waypoint `last`, as one cell.
  void add_pieces(std::size_t first, std::size_t last, double from, double to) {
    PathState start = smooth_.at(from), end = smooth_.at(to);
    start.s = knots_[first];
    end.s = knots_[last];
    const Between between(start, end, to - from);
    add_knot(from, start, first);
    double x = 0;
    for (std::size_t i = first + 1; i < last; ++i) {
      x = between.meets(knots_[i], x);
      PathState state = between.at(x);
      state.s = knots_[i];
      add(from + (to - from) * x, state, i);
    }
  }
  void add_knot(double t, const PathState& state, std::size_t piece) {
    reference_.law.push_back(reference_.tau.size());
    add(t, state, piece);
  }
  Reference take() { return std::move(reference_); }

 private:
  void add(double t, const PathState& state, std::size_t piece) {
    reference_.tau.push_back(t);
    reference_.states.push_back(state);
    reference_.piece.push_back(piece);
  }

  const std::vector<double>& knots_;
  const SmoothProfile& smooth_;
  double longest_, fewest_;
  Reference reference_;
};

}  // namespace

double law_cells(const CubicSpline& spline) {
  constexpr double kFewest = 400, kEach = 40, kEnough = 1500;
  const auto pieces = static_cast<double>(spline.knots().size() - 1);
  return std::max(std::clamp(kEach * pieces, kFewest, kEnough), std::min(pieces, kMaxCells));
}

Reference reference_along(const CubicSpline& spline, const SmoothProfile& smooth,
                          const SpeedProfile& profile, double window, double cells) {
  const std::vector<double>& knots = spline.knots();
  const std::size_t last = knots.size() - 1;
  // Too many waypoints: cells at least half as long as they would be without them.
  const bool many = static_cast<double>(last) > 2 * kMaxCells;
  const double shortest = 0.5 * smooth.duration() / cells;
  Sampler sampler(spline, smooth, cells);
  double from = 0;
  for (std::size_t i = 0, cell = 0; i < last;) {
    std::size_t next = i + 1;
    if (many) {
      const double s = smooth.at(from + shortest).s;
      while (next < last && knots[next] < s) ++next;
    }
    double to = smooth.duration();
    if (next < last) {
      // The profile meets it there, the smoothed one at most a window later.
      while (profile.s[cell] < knots[next]) ++cell;
      to = time_of(smooth, knots[next], std::max(from, profile.t[cell]), profile.t[cell] + window);
    }
    if (next == i + 1) {
      sampler.add_piece(i, from, to);
    } else {
      sampler.add_pieces(i, next, from, to);
    }
    from = to;
    i = next;
  }
  sampler.add_knot(from, {spline.end(), 0, 0, smooth.at(from).j}, last - 1);
  return sampler.take();
}

}  // namespace mjarm::detail
