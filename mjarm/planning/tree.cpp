#include "mjarm/planning/search_internal.hpp"
#include "mjarm/planning/tree_internal.hpp"

namespace mjarm::detail {

Tree::Near Tree::nearest(std::span<const double> q) const {
  const int node = places_.nearest(q);
  return {node, distance(this->q(node), q)};
}

void Tree::within(std::span<const double> q, double radius, std::vector<Near>& out) const {
  std::vector<int> nodes;
  places_.within(q, radius, nodes);
  out.clear();
  for (const int node : nodes) {
    const double far = distance(this->q(node), q);
    if (far <= radius) out.push_back({node, far});
  }
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
