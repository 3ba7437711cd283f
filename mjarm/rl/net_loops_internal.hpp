#pragma once

#include "mjarm/core/simd/functions.hpp"
#include "mjarm/rl/net_kernels_internal.hpp"

/// The bodies of NetKernels. Included by one file for each width of the registers.
namespace mjarm::rl::detail {
inline namespace MJARM_LANES {

using namespace simd;

inline constexpr int kVectors = 2;  ///< registers side by side in a tile
inline constexpr int kPanel = kVectors * kFloats;
inline constexpr int kTileRows = kFloats == 16 ? 8 : 4;  ///< rows of sums that stay in registers

/// `M` rows and `V` registers of sums.
template <int M, int V>
struct Tile {
  Floats sum[M][V];

  /// sum += a b: `inner` rows of b, a panel; the numbers of a are RowStep apart from row to row and
  /// InnerStep along the sum.
  template <long RowStep, long InnerStep>
  inline __attribute__((always_inline)) void multiply(int inner, const float* a, const float* b) {
    for (int i = 0; i < inner; ++i) {
      Floats x[V];
#pragma GCC unroll 4
      for (int v = 0; v < V; ++v) x[v] = load(b + i * kPanel + v * kFloats);
#pragma GCC unroll 16
      for (int m = 0; m < M; ++m) {
        const float factor = a[i * InnerStep + m * RowStep];
#pragma GCC unroll 4
        for (int v = 0; v < V; ++v) sum[m][v] += x[v] * factor;
      }
    }
  }
};

inline Floats finished(const Floats& y, const float* h, Finish finish) {
  switch (finish) {
    case Finish::tanh:
      return hyperbolic_tangent(y);
    case Finish::relu:
      return y < 0.0F ? Floats{} : y;  // NaN stays
    case Finish::tanh_backward: {
      const Floats value = load(h);
      return y - y * value * value;
    }
    case Finish::relu_backward:
      return load(h) > 0.0F ? y : Floats{};
    case Finish::none:
      break;
  }
  return y;
}

struct Product {
  int inner, capacity;
  const float *x, *w, *bias, *h;
  Finish finish;
  float* y;
};

/// Rows [row, row + M) of panel `p` of a product, V registers of it.
template <int M, int V>
void product_tile(const Product& of, int p, int row) {
  const long stride = static_cast<long>(of.capacity) * kPanel;
  Tile<M, V> tile;
  for (int v = 0; v < V; ++v) {
    const Floats start = of.bias ? load(of.bias + p * kPanel + v * kFloats) : Floats{};
    for (int m = 0; m < M; ++m) tile.sum[m][v] = start;
  }
  const float* x = of.x + static_cast<long>(row) * kPanel;
  const float* w = of.w + static_cast<long>(p) * of.inner * kPanel;
  for (int first = 0; first < of.inner; first += kPanel) {
    const int count = of.inner - first < kPanel ? of.inner - first : kPanel;
    tile.template multiply<kPanel, 1>(count, x, w);
    x += stride;
    w += static_cast<long>(count) * kPanel;
  }
  const long at = p * stride + static_cast<long>(row) * kPanel;
  for (int m = 0; m < M; ++m) {
    for (int v = 0; v < V; ++v) {
      const long place = at + m * kPanel + v * kFloats;
      store(of.y + place, finished(tile.sum[m][v], of.h + place, of.finish));
    }
  }
}

template <int V>
void product_panel(const Product& of, int p, int rows) {
  int row = 0;
  for (; row + kTileRows <= rows; row += kTileRows) product_tile<kTileRows, V>(of, p, row);
  for (; row < rows; ++row) product_tile<1, V>(of, p, row);
}

inline void product(int rows, int inner, int cols, int capacity, const float* x, const float* w,
                    const float* bias, const float* h, Finish finish, float* y) {
  const Product of = {inner, capacity, x, w, bias, h ? h : y, finish, y};
  for (int p = 0; p * kPanel < cols; ++p) {
    if (cols - p * kPanel > kFloats) {
      product_panel<kVectors>(of, p, rows);
    } else {
      product_panel<1>(of, p, rows);
    }
  }
}

struct Outer {
  int rows, outputs, inputs, capacity;
  const float *d, *x;
  bool add;
  float* c;
};

/// Rows [row, row + M) of c in the columns of panel `p` of x.
template <int M>
void outer_tile(const Outer& of, int p, int row) {
  const long stride = static_cast<long>(of.capacity) * kPanel;
  Tile<M, kVectors> tile{};
  tile.template multiply<1, kPanel>(of.rows, of.d + row / kPanel * stride + row % kPanel,
                                    of.x + p * stride);
  for (int m = 0; m < M; ++m) {
    for (int v = 0; v < kVectors; ++v) {
      const int col = p * kPanel + v * kFloats;
      float* c = of.c + static_cast<long>(row + m) * of.inputs + col;
      const int count = of.inputs - col;
      if (count >= kFloats) {
        store(c, of.add ? load(c) + tile.sum[m][v] : tile.sum[m][v]);
      } else if (count > 0) {
        const Floats old = of.add ? load_some(c, count) : Floats{};
        store_some(c, old + tile.sum[m][v], count);
      }
    }
  }
}

inline void outer(int rows, int outputs, int inputs, int capacity, const float* d, const float* x,
                  bool add, float* c) {
  static_assert(kPanel % kTileRows == 0, "a tile must not reach into the next panel");
  const Outer of = {rows, outputs, inputs, capacity, d, x, add, c};
  for (int p = 0; p * kPanel < inputs; ++p) {
    int row = 0;
    for (; row + kTileRows <= outputs; row += kTileRows) outer_tile<kTileRows>(of, p, row);
    for (; row < outputs; ++row) outer_tile<1>(of, p, row);
  }
}

inline void column_sums(int rows, int cols, int capacity, const float* d, bool add, float* sums) {
  const long stride = static_cast<long>(capacity) * kPanel;
  for (int col = 0; col < cols; col += kFloats) {
    const float* from = d + col / kPanel * stride + col % kPanel;
    Floats sum{};
    for (int row = 0; row < rows; ++row) sum += load(from + static_cast<long>(row) * kPanel);
    const int count = cols - col < kFloats ? cols - col : kFloats;
    const Floats old = add ? load_some(sums + col, count) : Floats{};
    store_some(sums + col, old + sum, count);
  }
}

/// Calls body(place, count) for all of n places, as many at a time as a register holds.
template <class Body>
inline __attribute__((always_inline)) void in_steps(long n, const Body& body) {
  long i = 0;
  for (; i + kFloats <= n; i += kFloats) body(i, kFloats);
  if (i < n) body(i, static_cast<int>(n - i));
}

inline Floats load_up_to(const float* from, int count) {
  return count == kFloats ? load(from) : load_some(from, count);
}
inline void store_up_to(float* to, const Floats& x, int count) {
  if (count == kFloats) return store(to, x);
  store_some(to, x, count);
}

inline void add(int count, const float* const* in, long n, float* out) {
  in_steps(n, [&](long i, int lanes) {
    Floats sum = load_up_to(in[0] + i, lanes);
    for (int k = 1; k < count; ++k) sum += load_up_to(in[k] + i, lanes);
    store_up_to(out + i, sum, lanes);
  });
}

inline float squares(const float* x, long n) {
  Floats sum{};
  in_steps(n, [&](long i, int lanes) {
    const Floats value = load_up_to(x + i, lanes);
    sum += value * value;
  });
  float total = 0;
  for (int k = 0; k < kFloats; ++k) total += sum[k];
  return total;
}

inline void adam(const NetKernels::AdamStep& step, long n, const float* g, float* m, float* v,
                 float* p) {
  in_steps(n, [&](long i, int lanes) {
    const Floats gradient = load_up_to(g + i, lanes) * step.scale;
    Floats first = load_up_to(m + i, lanes);
    first += (1 - step.beta1) * (gradient - first);
    const Floats second =
        step.beta2 * load_up_to(v + i, lanes) + (1 - step.beta2) * gradient * gradient;
    const Floats down = square_root(second) * step.root + step.epsilon;
    store_up_to(m + i, first, lanes);
    store_up_to(v + i, second, lanes);
    store_up_to(p + i, load_up_to(p + i, lanes) - step.rate * first / down, lanes);
  });
}

inline void tanh_all(long n, const float* x, float* y) {
  in_steps(n, [&](long i, int lanes) {
    store_up_to(y + i, hyperbolic_tangent(load_up_to(x + i, lanes)), lanes);
  });
}

inline constexpr NetKernels kLoops = {kPanel, product, outer, column_sums,
                                      add,    squares, adam,  tanh_all};

}  // namespace MJARM_LANES
}  // namespace mjarm::rl::detail
