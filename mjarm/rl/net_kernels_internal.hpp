#pragma once

#include "mjarm/core/cpu.hpp"

namespace mjarm::rl::detail {

/// What is done to a product before it is stored.
enum class Finish {
  none,
  tanh,           ///< y = tanh(y)
  relu,           ///< y = max(y, 0)
  tanh_backward,  ///< y *= 1 - h^2, h what tanh gave
  relu_backward,  ///< y *= h > 0
};

/// The loops of the networks for one width of registers. A matrix of (rows, cols) stands in panels:
/// `panel` columns side by side, row by row, the last ones filled up; panel p begins at
/// p * capacity * panel, `capacity` >= rows. Every sum runs in one order that depends on nothing
/// but its length, so that neither neighbours nor threads change a bit.
struct NetKernels {
  int panel;  ///< columns

  /// y = finish(x W + bias): (rows, inner) times (inner, cols).
  /// @param x     in panels.
  /// @param w     in panels of capacity `inner`, filled up with zeros.
  /// @param bias  cols numbers, filled up to whole panels; null: none.
  /// @param h     as y, for the backward finishes; else null.
  /// @param y     in panels; the columns that fill up the last one are undefined.
  void (*product)(int rows, int inner, int cols, int capacity, const float* x, const float* w,
                  const float* bias, const float* h, Finish finish, float* y);

  /// c = or += d^T x: (rows of c) = columns of d, (cols of c) = columns of x, summed over `rows`.
  /// @param d, x  in panels of one capacity.
  /// @param c     (outputs, inputs), row by row.
  void (*outer)(int rows, int outputs, int inputs, int capacity, const float* d, const float* x,
                bool add, float* c);

  /// sums = or += the sum of each column of d.
  void (*column_sums)(int rows, int cols, int capacity, const float* d, bool add, float* sums);

  /// out = in[0] + in[1] + ... + in[count - 1] at each of n places; one input may be `out`.
  void (*add)(int count, const float* const* in, long n, float* out);
  /// Sum of the squares of n numbers, n <= 2^16.
  float (*squares)(const float* x, long n);

  /// One step of Adam for n parameters p with the gradient scale * g:
  /// m += (1 - beta1) (g - m), v = beta2 v + (1 - beta2) g^2, p -= rate m / (sqrt(v) root + eps).
  struct AdamStep {
    float scale, beta1, beta2, rate, root, epsilon;
  };
  void (*adam)(const AdamStep& step, long n, const float* g, float* m, float* v, float* p);

  void (*tanh)(long n, const float* x, float* y);
};

extern const NetKernels kNetBaseline;
#if defined(__x86_64__)
extern const NetKernels kNetAvx2;
extern const NetKernels kNetAvx512;
#endif

/// The widest ones of a level.
[[nodiscard]] const NetKernels& net_kernels(SimdLevel level) noexcept;

}  // namespace mjarm::rl::detail
