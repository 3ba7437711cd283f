#pragma once

#include <span>
#include <vector>

#include "mjarm/rl/float_buffer_internal.hpp"
#include "mjarm/rl/net_kernels_internal.hpp"
#include "mjarm/rl/policy.hpp"

namespace mjarm::rl::detail {

/// A matrix as NetKernels wants it: (capacity, cols) in panels.
class Panels {
 public:
  Panels(int panel, int capacity, int cols);

  [[nodiscard]] float* data() noexcept { return buffer_.data(); }
  [[nodiscard]] const float* data() const noexcept { return buffer_.data(); }
  [[nodiscard]] int cols() const noexcept { return cols_; }
  [[nodiscard]] float& at(int row, int col) noexcept { return buffer_.data()[place(row, col)]; }
  [[nodiscard]] float at(int row, int col) const noexcept {
    return buffer_.data()[place(row, col)];
  }
  /// Copies `cols` numbers into a row.
  void set_row(int row, const float* from) noexcept;

 private:
  [[nodiscard]] std::size_t place(int row, int col) const noexcept {
    return static_cast<std::size_t>((col / panel_) * capacity_ + row) *
               static_cast<std::size_t>(panel_) +
           static_cast<std::size_t>(col % panel_);
  }
  int panel_, capacity_, cols_;
  FloatBuffer buffer_;
};

/// A multilayer perceptron whose parameters lie elsewhere: forward and backward over some rows at a
/// time. One object may be used by many threads, each with a Scratch of its own, once it is packed.
class Mlp {
 public:
  static constexpr int kRows = 128;  ///< most rows at a time: what they need stays in the L2 cache

  /// What a pass leaves for the next one.
  struct Scratch {
    std::vector<Panels> values;     ///< input, outputs of each layer; (kRows, size)
    std::vector<Panels> gradients;  ///< of the loss by the outputs of each layer
  };

  /// @param blocks  weight and bias of each layer in turn, where they lie in the flat parameters.
  Mlp(const NetKernels& kernels, std::span<const ParameterBlock> blocks, Activation activation);

  [[nodiscard]] int layers() const noexcept { return static_cast<int>(layers_.size()); }
  [[nodiscard]] int inputs() const noexcept { return layers_.front().inputs; }
  [[nodiscard]] int outputs() const noexcept { return layers_.back().outputs; }
  /// Places of its parameters: [first, last) of the flat ones.
  [[nodiscard]] std::size_t first() const noexcept { return layers_.front().weight; }
  [[nodiscard]] std::size_t last() const noexcept;

  /// Takes over the parameters of a layer in the order in which they are needed. Layers may be
  /// packed at once.
  /// @param parameters  all of them, flat.
  void pack(int layer, const float* parameters);

  [[nodiscard]] Scratch scratch() const;
  /// From values.front() to values.back().  @param rows  <= kRows
  void forward(int rows, Scratch& scratch) const;
  /// From gradients.back(), after forward() of the same rows.
  /// @param add       to what stands in `gradient`, else that is overwritten.
  /// @param gradient  of all parameters, flat; only those of this net are written.
  void backward(int rows, Scratch& scratch, bool add, float* gradient) const;

 private:
  struct Layer {
    int inputs, outputs;
    std::size_t weight, bias;       ///< places in the flat parameters
    FloatBuffer ahead, back, fill;  ///< W^T and W in panels; the bias filled up
  };
  const NetKernels& kernels_;
  Activation activation_;
  std::vector<Layer> layers_;
};

}  // namespace mjarm::rl::detail
