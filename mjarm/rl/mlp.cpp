#include <algorithm>
#include <cassert>

#include "mjarm/rl/mlp_internal.hpp"

namespace mjarm::rl::detail {
namespace {

std::size_t whole_panels(int panel, int cols) {
  return static_cast<std::size_t>((cols + panel - 1) / panel) * static_cast<std::size_t>(panel);
}

}  // namespace

Panels::Panels(int panel, int capacity, int cols)
    : panel_(panel),
      capacity_(capacity),
      cols_(cols),
      buffer_(whole_panels(panel, cols) * static_cast<std::size_t>(capacity)) {}

void Panels::set_row(int row, const float* from) noexcept {
  for (int col = 0; col < cols_; col += panel_) {
    std::copy_n(from + col, std::min(panel_, cols_ - col), &at(row, col));
  }
}

Mlp::Mlp(const NetKernels& kernels, std::span<const ParameterBlock> blocks, Activation activation)
    : kernels_(kernels), activation_(activation) {
  const int panel = kernels.panel;
  for (std::size_t i = 0; i + 1 < blocks.size(); i += 2) {
    Layer layer{blocks[i].cols, blocks[i].rows, blocks[i].offset, blocks[i + 1].offset, {}, {}, {}};
    layer.ahead =
        FloatBuffer(whole_panels(panel, layer.outputs) * static_cast<std::size_t>(layer.inputs));
    layer.back =
        FloatBuffer(whole_panels(panel, layer.inputs) * static_cast<std::size_t>(layer.outputs));
    layer.fill = FloatBuffer(whole_panels(panel, layer.outputs));
    layers_.push_back(std::move(layer));
  }
}

std::size_t Mlp::last() const noexcept {
  return layers_.back().bias + static_cast<std::size_t>(layers_.back().outputs);
}

void Mlp::pack(int layer, const float* parameters) {
  Layer& to = layers_[static_cast<std::size_t>(layer)];
  const float* W = parameters + to.weight;
  std::copy_n(parameters + to.bias, to.outputs, to.fill.data());
  const int panel = kernels_.panel;
  for (int row = 0; row < to.outputs; ++row) {
    const float* from = W + static_cast<long>(row) * to.inputs;
    float* ahead = to.ahead.data() + static_cast<long>(row / panel) * panel * to.inputs;
    for (int col = 0; col < to.inputs; ++col) ahead[col * panel + row % panel] = from[col];
    for (int col = 0; col < to.inputs; col += panel) {
      float* back = to.back.data() + static_cast<long>(col) * to.outputs + row * panel;
      std::copy_n(from + col, std::min(panel, to.inputs - col), back);
    }
  }
}

Mlp::Scratch Mlp::scratch() const {
  Scratch out;
  out.values.emplace_back(kernels_.panel, kRows, inputs());
  for (const Layer& layer : layers_) {
    out.values.emplace_back(kernels_.panel, kRows, layer.outputs);
    out.gradients.emplace_back(kernels_.panel, kRows, layer.outputs);
  }
  return out;
}

void Mlp::forward(int rows, Scratch& scratch) const {
  assert(rows <= kRows);
  const Finish hidden = activation_ == Activation::tanh ? Finish::tanh : Finish::relu;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const Layer& layer = layers_[i];
    kernels_.product(rows, layer.inputs, layer.outputs, kRows, scratch.values[i].data(),
                     layer.ahead.data(), layer.fill.data(), nullptr,
                     i + 1 < layers_.size() ? hidden : Finish::none, scratch.values[i + 1].data());
  }
}

void Mlp::backward(int rows, Scratch& scratch, bool add, float* gradient) const {
  assert(rows <= kRows);
  const Finish hidden =
      activation_ == Activation::tanh ? Finish::tanh_backward : Finish::relu_backward;
  for (std::size_t i = layers_.size(); i-- > 0;) {
    const Layer& layer = layers_[i];
    const float* d = scratch.gradients[i].data();
    const float* x = scratch.values[i].data();
    kernels_.outer(rows, layer.outputs, layer.inputs, kRows, d, x, add, gradient + layer.weight);
    kernels_.column_sums(rows, layer.outputs, kRows, d, add, gradient + layer.bias);
    if (i == 0) break;
    kernels_.product(rows, layer.outputs, layer.inputs, kRows, d, layer.back.data(), nullptr, x,
                     hidden, scratch.gradients[i - 1].data());
  }
}

}  // namespace mjarm::rl::detail
