#pragma once

#include "mjarm/kinematics/link_chain.hpp"
#include "mjarm/kinematics/trig_internal.hpp"

/// Forward kinematics and the Jacobian of one configuration, as straight loops
/// over plain numbers. Compiled once for every machine and once with AVX2
/// (link_pass_avx2.cpp), so everything here is `static`: no copy may stand in for
/// the other.
namespace mjarm::detail {

/// @param q     shape (dof,), |q| < 1e5.
/// @param p, R  3 and 9 numbers: p_WT and R_WT by columns.
/// @param J     6 dof numbers by columns.
using FkPass = void (*)(const LinkChain& chain, const double* q, double* p, double* R,
                        double* J) noexcept;

/// One for any joints, one for six hinges, one for seven.
struct FkPasses {
  FkPass both[3];
  FkPass pose[3];  ///< the pose alone: J is left alone
};

/// The fastest ones for this machine.
[[nodiscard]] const FkPasses& fk_passes() noexcept;

#if defined(__x86_64__)
[[nodiscard]] FkPasses fk_passes_avx2() noexcept;
#endif

/// A frame: its axes and its origin in the world, each with a fourth number to fill a register.
struct PassFrame {
  alignas(32) double x[4], y[4], z[4], p[4];
};

/// Carries the frame over one link and turns it by the joint.
static inline void pass_link(const Link& link, double s, double c, PassFrame& f) noexcept {
  alignas(32) double x[4], y[4], z[4], y2[4];
  for (int k = 0; k < 4; ++k) {
    f.p[k] += f.x[k] * link.t[0] + f.y[k] * link.t[1] + f.z[k] * link.t[2];
    y[k] = link.tilt_cos * f.y[k] + link.tilt_sin * f.z[k];
    z[k] = link.tilt_cos * f.z[k] - link.tilt_sin * f.y[k];
  }
  for (int k = 0; k < 4; ++k) {
    x[k] = c * f.x[k] + s * y[k];
    y2[k] = c * y[k] - s * f.x[k];
  }
  for (int k = 0; k < 4; ++k) {
    f.x[k] = x[k];
    f.y[k] = y2[k];
    f.z[k] = z[k];
  }
}

/// Carries a frame through all links to the tool; with the origins and axes of
/// the joints on the way where `kAxes`. N = 0: any joints; else so many hinges.
template <int N, bool kAxes>
static inline void pass_chain(const LinkChain& chain, const double* q, double* p, double* R,
                              double (*origin)[4], double (*axis)[4]) noexcept {
  constexpr int kSize = N > 0 ? (N + 3) / 4 * 4 : kMaxDof;  // whole registers for the sines
  const int n = N > 0 ? N : chain.dof;
  const Link* links = &chain.links[0];
  double angle[kSize] = {}, s[kSize], c[kSize];
  for (int i = 0; i < n; ++i) {
    angle[i] = links[i].offset + (N == 0 && links[i].slide ? 0 : q[i]);
  }
  const int sines = N > 0 ? kSize : n;
  for (int i = 0; i < sines; ++i) sin_cos_inside(angle[i], s[i], c[i]);
  PassFrame f{{chain.base_cos, chain.base_sin, 0, 0},
              {-chain.base_sin, chain.base_cos, 0, 0},
              {0, 0, 1, 0},
              {0, 0, 0, 0}};
  for (int i = 0; i < n; ++i) {
    pass_link(links[i], s[i], c[i], f);
    if (N == 0 && links[i].slide) {
      for (int k = 0; k < 4; ++k) f.p[k] += q[i] * f.z[k];
    }
    if (!kAxes) continue;
    for (int k = 0; k < 4; ++k) {
      origin[i][k] = f.p[k];
      axis[i][k] = f.z[k];
    }
  }
  const double* t = chain.tool;
  for (int k = 0; k < 3; ++k) {
    p[k] = f.p[k] + f.x[k] * t[0] + f.y[k] * t[1] + f.z[k] * t[2];
    R[k] = f.x[k];
    R[3 + k] = f.y[k];
    R[6 + k] = f.z[k];
  }
  if (!chain.tool_turns) return;
  for (int j = 0; j < 3; ++j) {
    t += 3;
    for (int k = 0; k < 3; ++k) R[3 * j + k] = f.x[k] * t[0] + f.y[k] * t[1] + f.z[k] * t[2];
  }
}

template <int N>
static void fk_pass_of(const LinkChain& chain, const double* q, double* p, double* R,
                       double* J) noexcept {
  constexpr int kMax = N > 0 ? N : kMaxDof;
  const int n = N > 0 ? N : chain.dof;
  double origin[kMax][4], axis[kMax][4];
  pass_chain<N, true>(chain, q, p, R, origin, axis);
  for (int i = 0; i < n; ++i) {
    const double* a = axis[i];
    const double d[3] = {p[0] - origin[i][0], p[1] - origin[i][1], p[2] - origin[i][2]};
    double* column = J + 6 * i;
    column[0] = a[1] * d[2] - a[2] * d[1];
    column[1] = a[2] * d[0] - a[0] * d[2];
    column[2] = a[0] * d[1] - a[1] * d[0];
    for (int k = 0; k < 3; ++k) column[3 + k] = a[k];
    if (N > 0 || !chain.links[i].slide) continue;
    for (int k = 0; k < 3; ++k) {
      column[k] = a[k];
      column[3 + k] = 0;
    }
  }
}

template <int N>
static void pose_pass_of(const LinkChain& chain, const double* q, double* p, double* R,
                         double*) noexcept {
  pass_chain<N, false>(chain, q, p, R, nullptr, nullptr);
}

/// Of the instantiations of the file that asks.
static inline FkPasses fk_passes_here() noexcept {
  return {{fk_pass_of<0>, fk_pass_of<6>, fk_pass_of<7>},
          {pose_pass_of<0>, pose_pass_of<6>, pose_pass_of<7>}};
}

}  // namespace mjarm::detail
