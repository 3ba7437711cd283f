#include <algorithm>

#include "mjarm/rl/gradient_sums_internal.hpp"

namespace mjarm::rl::detail {

GradientSums::GradientSums(std::size_t parameters, std::size_t portion, Networks& networks)
    : portion_(portion), networks_(networks), sum_(parameters) {}

void GradientSums::reserve(int slices) {
  while (slices_.size() < static_cast<std::size_t>(slices)) slices_.emplace_back(size());
}

template <class Body>
void GradientSums::for_each_portion(const Body& body) {
  networks_.workers().run(static_cast<int>(portions()), [&](int task, int) {
    const auto i = static_cast<std::size_t>(task);
    const std::size_t first = i * portion_;
    body(i, first, static_cast<long>(std::min(portion_, size() - first)));
  });
}

void GradientSums::add(int slices) {
  for_each_portion([&](std::size_t, std::size_t first, long count) {
    std::vector<const float*> from;
    for (int i = 0; i < slices; ++i) from.push_back(slice(i) + first);
    networks_.kernels().add(slices, from.data(), count, sum_.data() + first);
  });
}

double GradientSums::squares() {
  std::vector<float> parts(portions());
  for_each_portion([&](std::size_t i, std::size_t first, long count) {
    parts[i] = networks_.kernels().squares(sum_.data() + first, count);
  });
  double sum = 0;
  for (const float part : parts) sum += part;
  return sum;
}

}  // namespace mjarm::rl::detail
