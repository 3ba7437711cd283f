#pragma once

#include <cstddef>

namespace mjarm::detail {

/// The numbers of a RetimeProblem, each kind beside its like, so that several knots are worked on
/// at a time: columns of one entry a knot, filled up to `stride` with knots that count for nothing.
/// Columns may be read, and those of kernels written, a little before and behind that. Plain
/// pointers, as kernels may call nothing of the standard library.
struct RetimeLanes {
  static constexpr std::size_t kWidest = 8;  ///< `stride` is a multiple of it
  static constexpr std::size_t kRoom = 8;    ///< entries before and behind each column

  std::size_t stride = 0;
  std::size_t rows = 0;    ///< of jerks
  std::size_t a_rows = 0;  ///< of accelerations and torques
  bool rests = false;      ///< whether `root_a` and `still` are anything but 0
  /// u = first c[i] + second c[i+1], u' = slope (c[i+1] - c[i]); the weight is a time [s].
  double *first, *second, *slope, *weight;
  double* by_u_max;                    ///< 1 / u_max
  double *before, *after;              ///< 1 / length of the cell on that side, 0 where none is
  double* eighth;                      ///< length / 8 of the cell after it
  double* middle_time;                 ///< 4 length / 6: Simpson's weight of its middle
  double *a_a, *v_a, *root_a, *still;  ///< (a_rows, stride); v_a halved
  double *j_after, *a_after,
      *v_after;  ///< (rows, stride) each: jerk = sqrt(u) (j u + a u' + v u'')
  double *j_before, *a_before, *v_before;

  // What kernels write.
  double *u, *du;
  double* g[4];         ///< gradient by c[i-1] to c[i+2]
  double* diagonal[4];  ///< second derivatives by the same
  double* next[3];      ///< by c[i-1] c[i], c[i] c[i+1], c[i+1] c[i+2]
  double* skip[2];      ///< by c[i-1] c[i+1], c[i] c[i+2]
};

/// Value of the objective with the barrier at `c`, shape (stride + kRoom,); infinite where a bound
/// is broken. Leaves u and u' of the knots in `lanes`.
using RetimeValue = double (*)(RetimeLanes& lanes, const double* c, double mu);
/// Its local model there, into `g` to `skip`.
using RetimeModel = void (*)(RetimeLanes& lanes, const double* c, double mu);

struct RetimeKernels {
  RetimeValue value;
  RetimeModel model;
};

double retime_value_baseline(RetimeLanes& lanes, const double* c, double mu);
void retime_model_baseline(RetimeLanes& lanes, const double* c, double mu);
#if defined(__x86_64__)
double retime_value_avx2(RetimeLanes& lanes, const double* c, double mu);
void retime_model_avx2(RetimeLanes& lanes, const double* c, double mu);
double retime_value_avx512(RetimeLanes& lanes, const double* c, double mu);
void retime_model_avx512(RetimeLanes& lanes, const double* c, double mu);
#endif

/// The widest ones that this machine runs.
[[nodiscard]] RetimeKernels retime_kernels() noexcept;

}  // namespace mjarm::detail
