#include <algorithm>
#include <cmath>

#include "mjarm/trajectory/via_points_segment_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr int n = kCells;
constexpr int kAccelRows = n;         // first of the acceleration rows
constexpr int kJerkRows = 2 * n + 1;  // first of the jerk rows
enum { kV0, kA0, kV1, kA1, kH };      // the entries of Shared

/// The 2 x 2 block of the two coefficients at one end of a segment, and its gradient, in terms of
/// v, a and h there: c = v -+ h a / 2.
struct EndBlock {
  double vv, va, vh, aa, ah, hh, gv, ga, gh;
};
EndBlock end_block(const SegmentModel& model, int i, double h, double a) {
  const double half = 0.5 * h, bend = 0.5 * a;
  const double sum = model.diag[i] + 2 * model.off1[i] + model.diag[i + 1];
  const double difference = model.diag[i] - 2 * model.off1[i] + model.diag[i + 1];
  const double skew = model.diag[i + 1] - model.diag[i];
  const double slope = model.with_h[i + 1] - model.with_h[i];
  const double pull = model.grad[i + 1] - model.grad[i];
  return {sum,
          half * skew,
          bend * skew + model.with_h[i] + model.with_h[i + 1],
          half * half * difference,
          half * (bend * difference + slope),
          bend * (bend * difference + 2 * slope),
          model.grad[i] + model.grad[i + 1],
          half * pull,
          bend * pull};
}

/// Cholesky factor of the inner, five-diagonal part.
bool factor_inner(const SegmentModel& model, Condensed& out) {
  for (int i = 0; i < kInner; ++i) {
    double l2 = 0, l1 = 0;
    if (i >= 2) l2 = model.off2[i] * out.l0[i - 2];
    if (i >= 1) l1 = (model.off1[i + 1] - l2 * out.l1[i - 1]) * out.l0[i - 1];
    const double pivot = model.diag[i + 2] - l1 * l1 - l2 * l2;
    if (!(pivot > 0)) return false;
    out.l0[i] = 1 / std::sqrt(pivot);
    out.l1[i] = l1;
    out.l2[i] = l2;
  }
  return true;
}

/// x = L^-1 x.
void forward(const Condensed& factor, Inner& x) {
  for (int i = 0; i < kInner; ++i) {
    if (i >= 1) x[i] -= factor.l1[i] * x[i - 1];
    if (i >= 2) x[i] -= factor.l2[i] * x[i - 2];
    x[i] *= factor.l0[i];
  }
}

/// The inner coefficients against the shared numbers.
void couple(const SegmentModel& model, const Shared& y, std::array<Inner, 5>& out) {
  for (Inner& column : out) column.fill(0);
  const double half = 0.5 * y[kH];
  // How c[2] and c[3] hang on the difference of c[1] and c[0], and the same at the end.
  const double start2 = model.off1[1] - model.off2[0], start3 = model.off2[1];
  const double end2 = model.off2[n - 1] - model.off1[n - 1], end3 = -model.off2[n - 2];
  constexpr int last = kInner - 1;
  out[kV0][0] = model.off2[0] + model.off1[1];
  out[kV0][1] = model.off2[1];
  out[kA0][0] = half * start2;
  out[kA0][1] = half * start3;
  out[kV1][last] = model.off1[n - 1] + model.off2[n - 1];
  out[kV1][last - 1] = model.off2[n - 2];
  out[kA1][last] = half * end2;
  out[kA1][last - 1] = half * end3;
  for (int i = 0; i < kInner; ++i) out[kH][i] = model.with_h[i + 2];
  out[kH][0] += 0.5 * y[kA0] * start2;
  out[kH][1] += 0.5 * y[kA0] * start3;
  out[kH][last] += 0.5 * y[kA1] * end2;
  out[kH][last - 1] += 0.5 * y[kA1] * end3;
}

double dot(const Inner& a, const Inner& b) {
  double sum = 0;
  for (int i = 0; i < kInner; ++i) sum += a[i] * b[i];
  return sum;
}

/// Adds w g^2 / 2 + u g h + p g for the row g = c[i+2] - 2 c[i+1] + c[i].
void add_jerk_row(int i, double w, double u, double p, SegmentModel& model) {
  model.diag[i] += w;
  model.diag[i + 1] += 4 * w;
  model.diag[i + 2] += w;
  model.off1[i] -= 2 * w;
  model.off1[i + 1] -= 2 * w;
  model.off2[i] += w;
  model.with_h[i] += u;
  model.with_h[i + 1] -= 2 * u;
  model.with_h[i + 2] += u;
  model.grad[i] += p;
  model.grad[i + 1] -= 2 * p;
  model.grad[i + 2] += p;
}

/// The same for g = c[i+1] - c[i].
void add_accel_row(int i, double w, double u, double p, SegmentModel& model) {
  model.diag[i] += w;
  model.diag[i + 1] += w;
  model.off1[i] -= w;
  model.with_h[i] -= u;
  model.with_h[i + 1] += u;
  model.grad[i] -= p;
  model.grad[i + 1] += p;
}

/// Second derivatives of the Lagrangian that the rows' own products leave out: c holds h times a at
/// the ends, the way holds step / h, the jerk rows h^2.
void add_curvature(const SegmentTask& task, const Shared& y, const RowPairs& z, double share,
                   SegmentModel& model) {
  Coefs force{};  // gradient of the Lagrangian in the coefficients
  double bend = 0;
  for (int i = 0; i < n; ++i) force[i + 1] += z.up[i] - z.down[i];
  for (int i = 0; i <= n; ++i) {
    const double f = z.up[kAccelRows + i] - z.down[kAccelRows + i];
    force[i] -= f;
    force[i + 1] += f;
  }
  for (int i = 0; i < n; ++i) {
    const double up = z.up[kJerkRows + i], down = z.down[kJerkRows + i];
    bend -= 2 * task.j * (up + down);
    force[i] += up - down;
    force[i + 1] -= 2 * (up - down);
    force[i + 2] += up - down;
  }
  double way = 0;  // multiplier of the way, which balances the inner forces
  for (int i = 0; i < kInner; ++i) way -= force[i + 2] / kInner;
  const double h = y[kH];
  model.hh += share * (bend - 2 * way * task.step / (h * h * h));
  model.a0_h = share * (0.5 * (force[1] - force[0]) + way / 3);
  model.a1_h = share * (0.5 * (force[n + 1] - force[n]) - way / 3);
}

}  // namespace

Coefs coefs_of(const Shared& y, const Inner& inner) {
  Coefs c;
  const double half = 0.5 * y[kH];
  c[0] = y[kV0] - half * y[kA0];
  c[1] = y[kV0] + half * y[kA0];
  for (int i = 0; i < kInner; ++i) c[i + 2] = inner[i];
  c[n] = y[kV1] - half * y[kA1];
  c[n + 1] = y[kV1] + half * y[kA1];
  return c;
}

Coefs coefs_step(const Shared& y, const Shared& dy, const Inner& d_inner) {
  Coefs c;
  const double d0 = 0.5 * (y[kH] * dy[kA0] + y[kA0] * dy[kH]);
  const double d1 = 0.5 * (y[kH] * dy[kA1] + y[kA1] * dy[kH]);
  c[0] = dy[kV0] - d0;
  c[1] = dy[kV0] + d0;
  for (int i = 0; i < kInner; ++i) c[i + 2] = d_inner[i];
  c[n] = dy[kV1] - d1;
  c[n + 1] = dy[kV1] + d1;
  return c;
}

double inner_sum(const SegmentTask& task, const Shared& y) {
  return task.step / y[kH] - y[kV0] - y[kV1] - (y[kA0] - y[kA1]) * y[kH] / 3;
}

Rows row_values(const Coefs& c) {
  Rows g;
  for (int i = 0; i < n; ++i) g[i] = c[i + 1];
  for (int i = 0; i <= n; ++i) g[kAccelRows + i] = c[i + 1] - c[i];
  for (int i = 0; i < n; ++i) g[kJerkRows + i] = c[i + 2] - 2 * c[i + 1] + c[i];
  return g;
}

Rows row_fill(double v, double a, double j) {
  Rows b;
  for (int i = 0; i < n; ++i) b[i] = v;
  for (int i = 0; i <= n; ++i) b[kAccelRows + i] = a;
  for (int i = 0; i < n; ++i) b[kJerkRows + i] = j;
  return b;
}

double time_factor(const SegmentTask& task, const Coefs& c, double h) {
  double v = 0, a = 0, j = 0;
  for (int i = 0; i < n; ++i) v = std::max(v, std::abs(c[i + 1]));
  for (int i = 0; i <= n; ++i) a = std::max(a, std::abs(c[i + 1] - c[i]));
  for (int i = 0; i < n; ++i) j = std::max(j, std::abs(c[i + 2] - 2 * c[i + 1] + c[i]));
  return std::max({v / task.v, std::sqrt(a / (task.a * h)), std::cbrt(j / (task.j * h * h))});
}

SegmentModel smoothness_model(const Coefs& c, double weight) {
  SegmentModel model;
  for (int i = 0; i < n; ++i) {
    add_jerk_row(i, weight, 0, weight * (c[i + 2] - 2 * c[i + 1] + c[i]), model);
  }
  return model;
}

SegmentModel barrier_model(const SegmentTask& task, const Shared& y, double mu,
                           const RowPairs& rooms, const RowPairs& missed,
                           const RowPairs& multipliers, double curvature) {
  SegmentModel model;
  // A row |g| <= b(h) with slope b' adds w g^2 / 2 + u g h + p g and terms in h alone.
  struct Terms {
    double w, u, p;
  };
  const auto terms = [&](int row, double slope) {
    const double up = 1 / rooms.up[row], down = 1 / rooms.down[row];
    const double w_up = multipliers.up[row] * up, w_down = multipliers.down[row] * down;
    model.hh += (w_up + w_down) * slope * slope;
    const double p_up = mu * up - w_up * missed.up[row];
    const double p_down = mu * down - w_down * missed.down[row];
    model.grad_h -= (p_up + p_down) * slope;
    return Terms{w_up + w_down, (w_down - w_up) * slope, p_up - p_down};
  };
  for (int i = 0; i < n; ++i) {
    const Terms t = terms(i, 0);
    model.diag[i + 1] += t.w;
    model.grad[i + 1] += t.p;
  }
  for (int i = 0; i <= n; ++i) {
    const Terms t = terms(kAccelRows + i, task.a);
    add_accel_row(i, t.w, t.u, t.p, model);
  }
  for (int i = 0; i < n; ++i) {
    const Terms t = terms(kJerkRows + i, 2 * task.j * y[kH]);
    add_jerk_row(i, t.w, t.u, t.p, model);
  }
  if (curvature > 0) add_curvature(task, y, multipliers, curvature, model);
  return model;
}

bool condense(const SegmentTask& task, const Shared& y, const SegmentModel& model, Condensed& out) {
  if (!factor_inner(model, out)) return false;
  couple(model, y, out.coupling);
  out.ones.fill(1);
  for (int i = 0; i < kInner; ++i) out.inner_grad[i] = model.grad[i + 2];
  for (Inner& column : out.coupling) forward(out, column);
  forward(out, out.ones);
  forward(out, out.inner_grad);

  const double h = y[kH];
  const EndBlock s = end_block(model, 0, h, y[kA0]), e = end_block(model, n, h, y[kA1]);
  const double s_ah = s.ah + model.a0_h, e_ah = e.ah + model.a1_h;
  out.m = {{{s.vv, s.va, 0, 0, s.vh},
            {s.va, s.aa, 0, 0, s_ah},
            {0, 0, e.vv, e.va, e.vh},
            {0, 0, e.va, e.aa, e_ah},
            {s.vh, s_ah, e.vh, e_ah, model.hh + s.hh + e.hh}}};
  out.grad = {s.gv, s.ga, e.gv, e.ga, model.grad_h + s.gh + e.gh};

  // The inner ones minimise |x + b|^2 / 2 with b = coupling dy + inner_grad on the plane
  // ones^T x = d(inner sum), x = L^T (their change).
  out.ones_ones = dot(out.ones, out.ones);
  out.ones_grad = dot(out.ones, out.inner_grad);
  out.pull = {-1, -h / 3, -1, h / 3, -task.step / (h * h) - (y[kA0] - y[kA1]) / 3};
  for (int a = 0; a < 5; ++a) out.pull[a] += dot(out.coupling[a], out.ones);
  for (int a = 0; a < 5; ++a) {
    const double share = out.pull[a] / out.ones_ones;
    out.grad[a] += share * out.ones_grad - dot(out.coupling[a], out.inner_grad);
    for (int b = a; b < 5; ++b) {
      out.m[a][b] += share * out.pull[b] - dot(out.coupling[a], out.coupling[b]);
      out.m[b][a] = out.m[a][b];
    }
  }
  return true;
}

Inner inner_step(const Condensed& condensed, const Shared& dy) {
  double pull = condensed.ones_grad;
  for (int a = 0; a < 5; ++a) pull += condensed.pull[a] * dy[a];
  pull /= condensed.ones_ones;
  Inner x;
  for (int i = 0; i < kInner; ++i) {
    x[i] = pull * condensed.ones[i] - condensed.inner_grad[i];
    for (int a = 0; a < 5; ++a) x[i] -= condensed.coupling[a][i] * dy[a];
  }
  for (int i = kInner - 1; i >= 0; --i) {
    if (i + 1 < kInner) x[i] -= condensed.l1[i + 1] * x[i + 1];
    if (i + 2 < kInner) x[i] -= condensed.l2[i + 2] * x[i + 2];
    x[i] *= condensed.l0[i];
  }
  return x;
}

}  // namespace mjarm::detail
