#include <gtest/gtest.h>

#include <Eigen/Core>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "mjarm/core/rng.hpp"
#include "mjarm/rl/mlp_internal.hpp"
#include "mjarm/rl/net_levels_test.hpp"

namespace mjarm::rl {
namespace {

using detail::Finish;
using detail::FloatBuffer;
using detail::NetKernels;
using detail::Panels;
using Eigen::MatrixXd;

/// Normal numbers that are floats.
MatrixXd random_floats(int rows, int cols, Rng& rng) {
  MatrixXd out(rows, cols);
  for (double& value : out.reshaped())
    value = static_cast<double>(static_cast<float>(rng.normal()));
  return out;
}

Panels to_panels(const NetKernels& kernels, const MatrixXd& from, int capacity) {
  Panels out(kernels.panel, capacity, static_cast<int>(from.cols()));
  for (int row = 0; row < from.rows(); ++row) {
    for (int col = 0; col < from.cols(); ++col) {
      out.at(row, col) = static_cast<float>(from(row, col));
    }
  }
  return out;
}

/// Sizes beside those of tiles and panels.
struct GemmCase {
  int rows, inner, cols;
};
const std::vector<GemmCase>& gemm_cases() {
  static const std::vector<GemmCase> cases = [] {
    std::vector<GemmCase> out = {{1, 1, 1}, {128, 24, 256}, {128, 256, 256}, {127, 256, 7}};
    Rng rng(3);
    const auto size = [&] { return static_cast<int>(1 + rng.below(100)); };
    for (int i = 0; i < 40; ++i) out.push_back({size(), size(), size()});
    return out;
  }();
  return cases;
}

/// Of a sum of `terms` products of normal numbers: each addition rounds a part of the sum, which
/// grows as the root of the number of its terms does; five standard deviations.
double tolerance(int terms) { return 2e-6 + 3e-7 * terms; }

TEST(NetKernels, ProductsAgreeWithDoublePrecision) {
  Rng rng(1);
  for (const NetKernels* kernels : testing::all_net_kernels()) {
    for (const auto& [rows, inner, cols] : gemm_cases()) {
      const MatrixXd x = random_floats(rows, inner, rng), W = random_floats(inner, cols, rng);
      const MatrixXd bias = random_floats(1, cols, rng), h = random_floats(rows, cols, rng);
      const MatrixXd plain = (x * W).rowwise() + bias.row(0);
      const int capacity = rows + static_cast<int>(rng.below(5));
      const Panels x_panels = to_panels(*kernels, x, capacity);
      const Panels W_panels = to_panels(*kernels, W, inner);
      const Panels bias_panels = to_panels(*kernels, bias, 1);
      const Panels h_panels = to_panels(*kernels, h, capacity);
      for (const Finish finish : {Finish::none, Finish::tanh, Finish::relu, Finish::tanh_backward,
                                  Finish::relu_backward}) {
        Panels y(kernels->panel, capacity, cols);
        kernels->product(rows, inner, cols, capacity, x_panels.data(), W_panels.data(),
                         bias_panels.data(), h_panels.data(), finish, y.data());
        for (int i = 0; i < rows; ++i) {
          for (int j = 0; j < cols; ++j) {
            double wanted = plain(i, j);
            if (finish == Finish::tanh) wanted = std::tanh(wanted);
            if (finish == Finish::relu) wanted = std::max(wanted, 0.0);
            if (finish == Finish::tanh_backward) wanted *= 1 - h(i, j) * h(i, j);
            if (finish == Finish::relu_backward) wanted *= h(i, j) > 0 ? 1 : 0;
            const double size = 1 + h(i, j) * h(i, j);
            ASSERT_NEAR(y.at(i, j), wanted, tolerance(inner) * size)
                << rows << " " << inner << " " << cols;
          }
        }
      }
    }
  }
}

TEST(NetKernels, OuterProductsAndSumsAgreeWithDoublePrecision) {
  Rng rng(2);
  for (const NetKernels* kernels : testing::all_net_kernels()) {
    for (const auto& [rows, outputs, inputs] : gemm_cases()) {
      const MatrixXd d = random_floats(rows, outputs, rng), x = random_floats(rows, inputs, rng);
      const int capacity = rows + static_cast<int>(rng.below(5));
      const Panels d_panels = to_panels(*kernels, d, capacity);
      const Panels x_panels = to_panels(*kernels, x, capacity);
      // What stands behind the matrix must not be touched.
      const auto size = static_cast<std::size_t>(outputs) * static_cast<std::size_t>(inputs);
      std::vector<float> c(size + 1, 7), sums(static_cast<std::size_t>(outputs) + 1, 7);
      for (const bool add : {false, true}) {
        kernels->outer(rows, outputs, inputs, capacity, d_panels.data(), x_panels.data(), add,
                       c.data());
        kernels->column_sums(rows, outputs, capacity, d_panels.data(), add, sums.data());
        const double times = add ? 2 : 1;
        const MatrixXd wanted = times * (d.transpose() * x);
        const MatrixXd wanted_sums = times * d.colwise().sum();
        for (int i = 0; i < outputs; ++i) {
          ASSERT_NEAR(sums[i], wanted_sums(i), 2 * tolerance(rows));
          for (int j = 0; j < inputs; ++j) {
            ASSERT_NEAR(c[i * inputs + j], wanted(i, j), 2 * tolerance(rows));
          }
        }
        EXPECT_EQ(c.back(), 7);
        EXPECT_EQ(sums.back(), 7);
      }
    }
  }
}

TEST(NetKernels, NeighboursDoNotMatter) {
  Rng rng(5);
  const MatrixXd x = random_floats(29, 37, rng), W = random_floats(37, 41, rng);
  for (const NetKernels* kernels : testing::all_net_kernels()) {
    const Panels W_panels = to_panels(*kernels, W, 37);
    const auto product = [&](const MatrixXd& rows) {
      const int n = static_cast<int>(rows.rows());
      Panels y(kernels->panel, n, 41);
      kernels->product(n, 37, 41, n, to_panels(*kernels, rows, n).data(), W_panels.data(), nullptr,
                       nullptr, Finish::tanh, y.data());
      return y;
    };
    const Panels all = product(x);
    for (int i = 0; i < 29; ++i) {
      const Panels one = product(x.row(i));
      for (int j = 0; j < 41; ++j) ASSERT_EQ(one.at(0, j), all.at(i, j));
    }
  }
}

TEST(NetKernels, TanhIsExactOverAllFloats) {
  // Every 1009th of the positive floats, then 100 around the places where the method changes.
  std::vector<float> xs;
  for (std::uint32_t bits = 0; bits < 0x7f800000U; bits += 1009) {
    xs.push_back(std::bit_cast<float>(bits));
  }
  for (const float centre : {0.0F, 0.1732868F, 0.5198604F, 0.8664339F, 9.010913F, 9.1F}) {
    float x = centre;
    for (int i = 0; i < 100; ++i) xs.push_back(x = std::nextafter(x, 100.0F));
  }
  xs.push_back(std::numeric_limits<float>::max());
  xs.push_back(std::numeric_limits<float>::infinity());
  const auto n = static_cast<long>(xs.size());
  std::vector<float> minus(xs), y(xs.size()), y_minus(xs.size());
  for (float& x : minus) x = -x;
  for (const NetKernels* kernels : testing::all_net_kernels()) {
    kernels->tanh(n, xs.data(), y.data());
    kernels->tanh(n, minus.data(), y_minus.data());
    double worst = 0;
    for (std::size_t i = 0; i < xs.size(); ++i) {
      const double wanted = std::tanh(static_cast<double>(xs[i]));
      // Below the normal floats there is nothing to be relative to.
      const double size = std::max(wanted, double(std::numeric_limits<float>::min()));
      worst = std::max(worst, std::abs(y[i] - wanted) / size);
      ASSERT_EQ(y[i], -y_minus[i]) << xs[i];
      ASSERT_LE(y[i], 1.0F);
    }
    EXPECT_LT(worst, 5e-7) << kernels->panel;
    EXPECT_GT(worst, 1e-9);  // what is compared are floats
  }
}

TEST(NetKernels, NotANumberStaysOne) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const NetKernels* kernels : testing::all_net_kernels()) {
    std::vector<float> x(33, 0.5F), y(33);
    x[3] = x[32] = nan;
    kernels->tanh(33, x.data(), y.data());
    EXPECT_TRUE(std::isnan(y[3]) && std::isnan(y[32]));
    EXPECT_FALSE(std::isnan(y[2]) || std::isnan(y[31]));
    EXPECT_TRUE(std::isnan(kernels->squares(x.data(), 33)));
    // The net behind a hidden NaN must not hide it either.
    const FloatBuffer zeros(256);
    FloatBuffer in(256), out(256);
    in.data()[0] = nan;
    for (const Finish finish : {Finish::tanh, Finish::relu}) {
      kernels->product(1, 1, 1, 1, in.data(), zeros.data(), nullptr, nullptr, finish, out.data());
      EXPECT_TRUE(std::isnan(out.data()[0]));
    }
  }
}

TEST(NetKernels, SumsAndAdamAgreeWithDoublePrecision) {
  Rng rng(4);
  const auto draw = [&](std::size_t n) {
    std::vector<float> out(n);
    for (float& value : out) value = static_cast<float>(rng.normal());
    return out;
  };
  for (const NetKernels* kernels : testing::all_net_kernels()) {
    for (const std::size_t n : {1UL, 7UL, 16UL, 33UL, 1000UL}) {
      const std::vector<float> a = draw(n), b = draw(n), c = draw(n);
      const float* all[] = {a.data(), b.data(), c.data()};
      std::vector<float> sum(n + 1, 7);
      kernels->add(3, all, static_cast<long>(n), sum.data());
      double squares = 0;
      for (std::size_t i = 0; i < n; ++i) {
        ASSERT_EQ(sum[i], (a[i] + b[i]) + c[i]);
        squares += double(a[i]) * double(a[i]);
      }
      EXPECT_EQ(sum[n], 7);
      EXPECT_NEAR(kernels->squares(a.data(), static_cast<long>(n)), squares, 1e-5 * squares);

      std::vector<float> m = b, v = c, p = a;
      for (float& value : v) value = value * value;
      const std::vector<float> v_before = v;
      const NetKernels::AdamStep step = {0.5F, 0.9F, 0.999F, 0.01F, 1.5F, 1e-3F};
      kernels->adam(step, static_cast<long>(n), c.data(), m.data(), v.data(), p.data());
      for (std::size_t i = 0; i < n; ++i) {
        const double g = 0.5 * double(c[i]);
        const double wanted_m = 0.9 * double(b[i]) + 0.1 * g;
        const double wanted_v = 0.999 * double(v_before[i]) + 0.001 * g * g;
        const double down = std::sqrt(wanted_v) * 1.5 + 1e-3;
        ASSERT_NEAR(m[i], wanted_m, 1e-6);
        ASSERT_NEAR(v[i], wanted_v, 1e-6 * (1 + wanted_v));
        ASSERT_NEAR(p[i], double(a[i]) - 0.01 * wanted_m / down, 2e-6 * (1 + 0.1 / down));
      }
    }
  }
}

}  // namespace
}  // namespace mjarm::rl
