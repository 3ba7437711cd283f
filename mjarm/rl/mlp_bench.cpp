#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/rl/adam_internal.hpp"
#include "mjarm/rl/first_weights_internal.hpp"
#include "mjarm/rl/networks_internal.hpp"
#include "mjarm/rl/ppo_gradient_internal.hpp"

/// Loops of the networks at the sizes of the reach task, beside Eigen's products as the compiler
/// makes them for the baseline; in floating-point operations a second.
namespace mjarm::rl {
namespace {

using detail::Finish;
using detail::FloatBuffer;
using detail::NetKernels;
using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr int kRows = detail::Mlp::kRows;

void report_rate(benchmark::State& state, double operations) {
  state.counters["flop"] =
      benchmark::Counter(operations, benchmark::Counter::kIsIterationInvariantRate);
}

FloatBuffer random_buffer(std::size_t size) {
  FloatBuffer out(size);
  Rng rng(1);
  for (std::size_t i = 0; i < size; ++i) out.data()[i] = static_cast<float>(rng.normal());
  return out;
}

const NetKernels& kernels_of(const benchmark::State& state) {
  return detail::net_kernels(std::min(static_cast<SimdLevel>(state.range(0)), simd_level()));
}

/// (kRows, inner) (inner, cols), with `finish`.
void product(benchmark::State& state, int inner, int cols, Finish finish) {
  const NetKernels& kernels = kernels_of(state);
  const FloatBuffer x = random_buffer(static_cast<std::size_t>(kRows * (inner + 64)));
  const FloatBuffer w = random_buffer(static_cast<std::size_t>(inner * (cols + 64)));
  FloatBuffer y(static_cast<std::size_t>(kRows * (cols + 64)));
  for (auto _ : state) {
    kernels.product(kRows, inner, cols, kRows, x.data(), w.data(), nullptr, x.data(), finish,
                    y.data());
    benchmark::DoNotOptimize(y.data());
  }
  report_rate(state, 2.0 * kRows * inner * cols);
}

void outer(benchmark::State& state, int outputs, int inputs) {
  const NetKernels& kernels = kernels_of(state);
  const FloatBuffer d = random_buffer(static_cast<std::size_t>(kRows * (outputs + 64)));
  const FloatBuffer x = random_buffer(static_cast<std::size_t>(kRows * (inputs + 64)));
  FloatBuffer c(static_cast<std::size_t>(outputs * inputs));
  for (auto _ : state) {
    kernels.outer(kRows, outputs, inputs, kRows, d.data(), x.data(), false, c.data());
    benchmark::DoNotOptimize(c.data());
  }
  report_rate(state, 2.0 * kRows * outputs * inputs);
}

constexpr int kBaseline = static_cast<int>(SimdLevel::baseline);
constexpr int kAvx2 = static_cast<int>(SimdLevel::avx2);
constexpr int kAvx512 = static_cast<int>(SimdLevel::avx512);

void hidden_layer(benchmark::State& state) { product(state, 256, 256, Finish::none); }
void hidden_layer_tanh(benchmark::State& state) { product(state, 256, 256, Finish::tanh); }
void hidden_layer_back(benchmark::State& state) { product(state, 256, 256, Finish::tanh_backward); }
void first_layer(benchmark::State& state) { product(state, 24, 256, Finish::tanh); }
void last_layer(benchmark::State& state) { product(state, 256, 7, Finish::none); }
void hidden_weights(benchmark::State& state) { outer(state, 256, 256); }
void first_weights(benchmark::State& state) { outer(state, 256, 24); }
BENCHMARK(hidden_layer)->Arg(kBaseline)->Arg(kAvx2)->Arg(kAvx512);
BENCHMARK(hidden_layer_tanh)->Arg(kBaseline)->Arg(kAvx2)->Arg(kAvx512);
BENCHMARK(hidden_layer_back)->Arg(kBaseline)->Arg(kAvx2)->Arg(kAvx512);
BENCHMARK(first_layer)->Arg(kBaseline)->Arg(kAvx2)->Arg(kAvx512);
BENCHMARK(last_layer)->Arg(kBaseline)->Arg(kAvx2)->Arg(kAvx512);
BENCHMARK(hidden_weights)->Arg(kBaseline)->Arg(kAvx2)->Arg(kAvx512);
BENCHMARK(first_weights)->Arg(kBaseline)->Arg(kAvx2)->Arg(kAvx512);

void hidden_layer_eigen(benchmark::State& state) {
  const Rows x = Rows::Random(kRows, 256), W = Rows::Random(256, 256);
  Rows y(kRows, 256);
  for (auto _ : state) {
    y.noalias() = x * W.transpose();
    benchmark::DoNotOptimize(y.data());
  }
  report_rate(state, 2.0 * kRows * 256 * 256);
}
BENCHMARK(hidden_layer_eigen);

void hidden_weights_eigen(benchmark::State& state) {
  const Rows x = Rows::Random(kRows, 256), d = Rows::Random(kRows, 256);
  Rows W(256, 256);
  for (auto _ : state) {
    W.noalias() = d.transpose() * x;
    benchmark::DoNotOptimize(W.data());
  }
  report_rate(state, 2.0 * kRows * 256 * 256);
}
BENCHMARK(hidden_weights_eigen);

/// Numbers a second.
void tanh_kernel(benchmark::State& state) {
  const FloatBuffer x = random_buffer(4096);
  FloatBuffer y(4096);
  for (auto _ : state) {
    kernels_of(state).tanh(4096, x.data(), y.data());
    benchmark::DoNotOptimize(y.data());
  }
  state.SetItemsProcessed(state.iterations() * 4096);
}
BENCHMARK(tanh_kernel)->Arg(kBaseline)->Arg(kAvx2)->Arg(kAvx512);

void tanh_eigen(benchmark::State& state) {
  const Eigen::ArrayXf x = Eigen::ArrayXf::Random(4096);
  Eigen::ArrayXf y(4096);
  for (auto _ : state) {
    y = x.tanh();
    benchmark::DoNotOptimize(y.data());
  }
  state.SetItemsProcessed(state.iterations() * 4096);
}
BENCHMARK(tanh_eigen);

/// A policy of the reach task, samples to learn from, and all that a gradient step needs.
struct Learning {
  Policy policy;
  detail::Workers workers;
  detail::Networks networks;
  detail::PpoGradient gradient;
  detail::Adam adam;
  std::vector<float> observations, actions, ones, log_probs;
  std::vector<int> which;

  Learning(int threads, int minibatch, SimdLevel level)
      : policy({24, 7}),
        workers(threads),
        networks(detail::net_kernels(level), policy, workers),
        gradient(policy.shape(), policy.parameters().size(), networks),
        adam(policy.parameters().size()) {
    Rng rng(1);
    detail::draw_first_weights(policy, 0, rng);
    networks.pack(policy);
    const auto n = static_cast<std::size_t>(minibatch);
    for (std::size_t i = 0; i < n * 24; ++i) observations.push_back(float(rng.normal()));
    for (std::size_t i = 0; i < n * 7; ++i) actions.push_back(float(rng.normal()));
    for (std::size_t i = 0; i < n; ++i) {
      ones.push_back(float(rng.normal()));
      log_probs.push_back(-10);
      which.push_back(static_cast<int>(i));
    }
  }

  void step(const PpoOptions& options) {
    gradient.compute(policy, {observations, actions, log_probs, ones, ones, ones}, which, options);
    const double scale = 1 / (1 + gradient.squares());
    adam.step(networks.kernels(), workers, gradient.gradient(), scale, 3e-4, 1e-5,
              policy.parameters());
    networks.pack(policy);
  }
};

/// A whole gradient step; samples a second. Arguments: level, threads, minibatch.
void gradient_step(benchmark::State& state) {
  const int minibatch = static_cast<int>(state.range(2));
  Learning learning(static_cast<int>(state.range(1)), minibatch,
                    std::min(static_cast<SimdLevel>(state.range(0)), simd_level()));
  const PpoOptions options;
  for (auto _ : state) learning.step(options);
  state.SetItemsProcessed(state.iterations() * minibatch);
  const double weights = 2.0 * (24 * 256 + 256 * 256) + 256 * 8;
  report_rate(state, minibatch * (3 * 2 * weights - 2 * 2 * 24 * 256));
}
BENCHMARK(gradient_step)
    ->Args({kBaseline, 1, 512})
    ->Args({kAvx2, 1, 512})
    ->Args({kAvx512, 1, 512})
    ->Args({kAvx512, 2, 256})
    ->Args({kAvx512, 2, 512})
    ->Args({kAvx512, 2, 2048})
    ->UseRealTime();

/// One observation through the actor alone, as an evaluation of one copy does.
void policy_act(benchmark::State& state) {
  const Learning learning(1, 1, SimdLevel::baseline);
  for (auto _ : state) benchmark::DoNotOptimize(learning.policy.act(learning.observations));
}
BENCHMARK(policy_act);

}  // namespace
}  // namespace mjarm::rl
