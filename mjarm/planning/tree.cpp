#include <cmath>

#include "mjarm/planning/tree_internal.hpp"

namespace mjarm::detail {

Tree::Near Tree::nearest(std::span<const double> q) const {
  std::array<double, kMaxDof> wanted{};
  std::copy(q.begin(), q.end(), wanted.begin());
  double least = std::numeric_limits<double>::infinity(), least2 = 0;
  int best = -1;
  const double* row = rows_.data();
  for (int n = 0; n < size(); ++n, row += stride_) {
    double distance2 = 0;
    for (std::size_t k = 0; k < stride_; ++k) {
      const double d = row[k] - wanted[k];
      distance2 += d * d;
    }
    const double looks = distance2 * weights_[static_cast<std::size_t>(n)];
    if (looks < least) {
      least = looks;
      least2 = distance2;
      best = n;
    }
  }
  return {best, std::sqrt(least2)};
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
