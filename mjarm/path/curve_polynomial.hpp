#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

namespace mjarm {

/// The space curve p(u) = c0 + c1 u + ... + c5 u^5, u in [0, 1], walked by its arc length s in
/// [0, length()] [m]. It never stops on its way, so that s has a smooth inverse. A plain value.
class CurvePolynomial {
 public:
  static constexpr int kDegree = 5;
  using Coefficients = Eigen::Matrix<double, 3, kDegree + 1>;  ///< [m] column k: c_k

  /// None where the curve comes to a stop, or so near to one that its direction breaks (a cusp).
  [[nodiscard]] static std::optional<CurvePolynomial> create(const Coefficients& c);

  [[nodiscard]] double length() const noexcept;             ///< [m] > 0, exact to about 1e-14 of it
  [[nodiscard]] Eigen::Vector3d at(double s) const;         ///< [m] s is clamped
  [[nodiscard]] Eigen::Vector3d direction(double s) const;  ///< unit tangent
  /// Arc length of the point nearest to `p` [m], certified to be the global one. Points that are
  /// not nearer than `within` [m] are not looked for; where there is none, any s comes back.
  [[nodiscard]] double nearest(const Eigen::Vector3d& p,
                               double within = std::numeric_limits<double>::infinity()) const;

 private:
  /// Gauss-Legendre quadrature of the speed is exact to rounding from here to the next one.
  struct Panel {
    double u = 0;
    double s = 0;
  };

  [[nodiscard]] double parameter(double s) const;  // u of an arc length
  [[nodiscard]] double arc(double u) const;        // arc length at u
  bool add_panels(double u0, double u1, double whole, double tolerance, int depth);

  Coefficients c_ = Coefficients::Zero();
  std::vector<Panel> panels_;  // ascending; the last one is the end of the curve
};

}  // namespace mjarm
