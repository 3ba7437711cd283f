#include "mjarm/kinematics/link_chain.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

#include "mjarm/core/cpu.hpp"
#include "mjarm/kinematics/link_pass_internal.hpp"

namespace mjarm {
namespace detail {

const FkPasses& fk_passes() noexcept {
  static const FkPasses passes = [] {
#if defined(__x86_64__)
    if (simd_level() >= SimdLevel::avx2) return fk_passes_avx2();
#endif
    return fk_passes_here();
  }();
  return passes;
}

}  // namespace detail

namespace {

constexpr double kUpright = 1e-12;  // sine of an angle between z axes that is none

/// Which of the passes is made for this number of joints.
int kind_of(const LinkChain& chain) noexcept {
  if (!chain.hinges) return 0;
  return chain.dof == 6 ? 1 : chain.dof == 7 ? 2 : 0;
}

/// Runs a pass; angles that it cannot take lose their whole turns first, which
/// changes nothing.
void run(detail::FkPass pass, const LinkChain& chain, const double* q, double* J,
         Pose& X_WT) noexcept {
  int large = 0;
  for (int i = 0; i < chain.dof; ++i) large |= std::abs(q[i]) < 9e4 ? 0 : 1;
  double reduced[kMaxDof];
  if (large != 0) {
    for (int i = 0; i < chain.dof; ++i) {
      const bool slide = chain.links[i].slide;
      reduced[i] = slide ? q[i] : std::remainder(q[i], 2 * std::numbers::pi);
    }
    q = reduced;
  }
  pass(chain, q, X_WT.p.data(), X_WT.R.data(), J);
}

}  // namespace

LinkChain::LinkChain(const Chain& chain) : dof(chain.dof) {
  double turn_before = 0;
  for (int i = 0; i < dof; ++i) {
    const Pose& X = chain.X_PJ[static_cast<std::size_t>(i)];
    // R = Rz(a) Rx(tilt) Rz(b); the turn by a belongs to the joint before.
    const double tilt_sin = std::hypot(X.R(0, 2), X.R(1, 2));
    const bool upright = tilt_sin < kUpright;
    const double a = upright ? 0.0 : std::atan2(X.R(0, 2), -X.R(1, 2));
    const double b =
        upright ? std::atan2(X.R(2, 2) * X.R(1, 0), X.R(0, 0)) : std::atan2(X.R(2, 0), X.R(2, 1));
    const double c = std::cos(a);
    const double s = std::sin(a);
    Link& link = links[i];
    link.t[0] = c * X.p.x() + s * X.p.y();
    link.t[1] = c * X.p.y() - s * X.p.x();
    link.t[2] = X.p.z();
    link.tilt_cos = X.R(2, 2);
    link.tilt_sin = upright ? 0.0 : tilt_sin;
    link.slide = chain.slide[static_cast<std::size_t>(i)];
    hinges = hinges && !link.slide;
    link.offset = b;
    if (i == 0) {
      base_cos = c;
      base_sin = s;
    } else {
      links[i - 1].offset = turn_before + a;
    }
    turn_before = b;
  }
  Pose X_JT = chain.X_JT;
  if (dof > 0 && X_JT.R(2, 2) > 0 && std::hypot(X_JT.R(0, 2), X_JT.R(1, 2)) < kUpright) {
    links[dof - 1].offset += std::atan2(X_JT.R(1, 0), X_JT.R(0, 0));
    X_JT = {X_JT.R.transpose() * X_JT.p, Eigen::Matrix3d::Identity()};
    tool_turns = false;
  }
  Eigen::Map<Eigen::Vector3d>(tool, 3) = X_JT.p;
  Eigen::Map<Eigen::Matrix3d>(tool + 3, 3, 3) = X_JT.R;
}

FkJacobian fk_jacobian(const LinkChain& chain, std::span<const double> q) noexcept {
  assert(q.size() == static_cast<std::size_t>(chain.dof));
  FkJacobian out;
  out.J_W.resize(6, chain.dof);
  run(detail::fk_passes().both[kind_of(chain)], chain, q.data(), out.J_W.data(), out.X_WT);
  return out;
}

Pose fk(const LinkChain& chain, std::span<const double> q) noexcept {
  assert(q.size() == static_cast<std::size_t>(chain.dof));
  Pose X_WT;
  run(detail::fk_passes().pose[kind_of(chain)], chain, q.data(), nullptr, X_WT);
  return X_WT;
}

}  // namespace mjarm
