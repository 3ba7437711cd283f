#pragma once

namespace mjarm::detail {

/// f(x) = sum over k = 0..8 of cosine[k] cos(k x) + sine[k] sin(k x).
struct TrigSeries {
  static constexpr int kDegree = 8;
  static constexpr int kSamples = 24;   ///< values that make one, evenly over the circle
  static constexpr int kMaxRoots = 40;  ///< that roots() gives at most

  double cosine[kDegree + 1] = {};
  double sine[kDegree + 1] = {};
  double largest = 0;  ///< of the values that it was made of
  double noise = 0;    ///< how far it is from them at most, of `largest`: rounding, mostly

  /// Where value `j` is taken [rad]: no multiple of 15 degrees, where arms are apt to be singular.
  [[nodiscard]] static double sample(int j) noexcept;

  TrigSeries() = default;
  /// The series nearest to the values `f[kSamples]`.
  explicit TrigSeries(const double* f) noexcept;

  /// f, f' and f''.
  struct Values {
    double f, slope, bend;
  };
  [[nodiscard]] Values at(double x) const noexcept;

  /// A place on the circle where f is 0, or an extremum so near to 0 that rounding decides.
  struct Root {
    double x;       ///< [rad]
    double spread;  ///< [rad] > 0: two roots that may be none, no farther from x than this
  };
  /// All of them, from 0 to a full turn.
  /// @param touch  an extremum is near to 0 below so much, of `largest`.
  /// @param out    shape (kMaxRoots,).
  /// @return how many there are.
  int roots(double touch, Root* out) const noexcept;
};

}  // namespace mjarm::detail
