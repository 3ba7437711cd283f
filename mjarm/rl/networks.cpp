#include <algorithm>

#include "mjarm/rl/networks_internal.hpp"

namespace mjarm::rl::detail {
namespace {

std::span<const ParameterBlock> actor_blocks(const Policy& policy) {
  return std::span(policy.blocks()).first(2 * (policy.shape().actor.size() + 1));
}

std::span<const ParameterBlock> critic_blocks(const Policy& policy) {
  return std::span(policy.blocks())
      .subspan(actor_blocks(policy).size(), 2 * (policy.shape().critic.size() + 1));
}

}  // namespace

Networks::Networks(const NetKernels& kernels, const Policy& policy, Workers& workers)
    : kernels_(kernels),
      workers_(workers),
      actor_(kernels, actor_blocks(policy), policy.shape().activation),
      critic_(kernels, critic_blocks(policy), policy.shape().activation) {
  for (int i = 0; i < workers.count(); ++i) {
    scratch_.push_back(actor_.scratch());
    scratch_.push_back(critic_.scratch());
  }
  pack(policy);
}

void Networks::pack(const Policy& policy) {
  const float* parameters = policy.parameters().data();
  const int in_actor = actor_.layers();
  workers_.run(in_actor + critic_.layers(), [&](int layer, int) {
    if (layer < in_actor) {
      actor_.pack(layer, parameters);
    } else {
      critic_.pack(layer - in_actor, parameters);
    }
  });
}

void Networks::means(std::span<const float> rows, std::span<float> means) {
  compute(actor_, true, rows, means);
}

void Networks::values(std::span<const float> rows, std::span<float> values) {
  compute(critic_, false, rows, values);
}

void Networks::compute(const Mlp& net, bool is_actor, std::span<const float> rows,
                       std::span<float> out) {
  constexpr int kPiece = 32;  // small enough that a few dozen copies keep two threads busy
  const int n = static_cast<int>(rows.size()) / net.inputs();
  workers_.run((n + kPiece - 1) / kPiece, [&](int task, int thread) {
    Mlp::Scratch& scratch = is_actor ? actor_scratch(thread) : critic_scratch(thread);
    const int first = task * kPiece;
    const int count = std::min(kPiece, n - first);
    for (int i = 0; i < count; ++i) {
      scratch.values.front().set_row(i, rows.data() + static_cast<long>(first + i) * net.inputs());
    }
    net.forward(count, scratch);
    for (int i = 0; i < count; ++i) {
      for (int k = 0; k < net.outputs(); ++k) {
        out[static_cast<std::size_t>(first + i) * static_cast<std::size_t>(net.outputs()) +
            static_cast<std::size_t>(k)] = scratch.values.back().at(i, k);
      }
    }
  });
}

}  // namespace mjarm::rl::detail
