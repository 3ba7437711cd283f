#include <cmath>
#include <cstdint>
#include <cstring>

#include "mjarm/planning/search_internal.hpp"
#include "mjarm/planning/tree_internal.hpp"

namespace mjarm::detail {
namespace {

typedef float Four __attribute__((vector_size(16)));
typedef std::int32_t FourInts __attribute__((vector_size(16)));

Four load(const float* from) {
  Four out;
  std::memcpy(&out, from, sizeof out);
  return out;
}

}  // namespace

void Tree::place(std::span<const double> q) {
  const auto node = static_cast<std::size_t>(size());
  const std::size_t lane = node % kLanes, first = node / kLanes * kLanes;
  if (lane == 0) {
    places_.resize(places_.size() + kLanes * dof_, kNowhere);
    weights_.resize(weights_.size() + kLanes, 1);
  }
  for (std::size_t k = 0; k < dof_; ++k) {
    places_[first * dof_ + k * kLanes + lane] = static_cast<float>(q[k]);
  }
}

Tree::Near Tree::nearest(std::span<const double> q) const {
  std::array<Four, kMaxDof> wanted;
  for (std::size_t k = 0; k < dof_; ++k) wanted[k] = Four{} + static_cast<float>(q[k]);
  // The best of every lane, and then the best of these.
  std::array<Four, 2> least{Four{} + kNowhere * kNowhere, Four{} + kNowhere * kNowhere};
  std::array<FourInts, 2> found{};
  for (std::size_t first = 0; first < weights_.size(); first += kLanes) {
    const float* place = places_.data() + first * dof_;
    std::array<Four, 2> looks{};
    for (std::size_t k = 0; k < dof_; ++k, place += kLanes) {
      const Four d0 = load(place) - wanted[k], d1 = load(place + 4) - wanted[k];
      looks[0] += d0 * d0;
      looks[1] += d1 * d1;
    }
    for (std::size_t h = 0; h < 2; ++h) {
      looks[h] *= load(weights_.data() + first + 4 * h);
      const FourInts nearer = looks[h] < least[h];
      least[h] = nearer ? looks[h] : least[h];
      found[h] = nearer ? FourInts{} + static_cast<int>(first) : found[h];
    }
  }
  Near out{0, 0};
  float best = std::numeric_limits<float>::infinity();
  for (int lane = 0; lane < static_cast<int>(kLanes); ++lane) {
    const auto h = static_cast<std::size_t>(lane / 4);
    const int node = found[h][lane % 4] + lane;
    if (least[h][lane % 4] > best || (least[h][lane % 4] == best && node > out.node)) continue;
    best = least[h][lane % 4];
    out.node = node;
  }
  out.distance = distance(this->q(out.node), q);
  return out;
}

void Tree::move(int node, int parent, double cost) {
  int* link = &children(this->parent(node)).first;
  while (*link != node) link = &children(*link).next;
  *link = children(node).next;
  parents_[static_cast<std::size_t>(node)] = parent;
  hang_below(node, parent);
  const double saved = this->cost(node) - cost;
  std::vector<int> below{node};
  while (!below.empty()) {
    const int n = below.back();
    below.pop_back();
    costs_[static_cast<std::size_t>(n)] -= saved;
    for (int child = children(n).first; child >= 0; child = children(child).next) {
      below.push_back(child);
    }
  }
}

std::vector<JointVec> Tree::branch(int node) const {
  std::vector<JointVec> out;
  for (; node >= 0; node = parent(node)) out.push_back(joint_vec(q(node)));
  return out;
}

SearchTree Tree::copy() const {
  SearchTree out;
  for (int node = 0; node < size(); ++node) out.q.push_back(joint_vec(q(node)));
  out.parents = parents_;
  return out;
}

}  // namespace mjarm::detail
