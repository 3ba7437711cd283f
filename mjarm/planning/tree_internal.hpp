#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/planning/near_nodes_internal.hpp"
#include "mjarm/planning/plan_path.hpp"

namespace mjarm::detail {

/// Configurations that are joined by proved edges, each with the one it was reached from.
class Tree {
 public:
  explicit Tree(std::size_t dof) : dof_(dof), places_(dof) {
    rows_.reserve(64 * dof);
    parents_.reserve(64);
  }

  int size() const { return static_cast<int>(parents_.size()); }
  std::span<const double> q(int node) const {
    return {rows_.data() + static_cast<std::size_t>(node) * dof_, dof_};
  }
  int parent(int node) const { return parents_[static_cast<std::size_t>(node)]; }
  /// [rad or m] length of the way from the root.
  double cost(int node) const { return costs_[static_cast<std::size_t>(node)]; }
  int root(int node) const {
    while (parent(node) >= 0) node = parent(node);
    return node;
  }

  /// @param parent  -1: a root.
  /// @param length  [rad or m] of the edge from there.
  int add(std::span<const double> q, int parent, double length) {
    rows_.insert(rows_.end(), q.begin(), q.end());
    places_.add(q);
    parents_.push_back(parent);
    costs_.push_back(parent < 0 ? 0 : cost(parent) + length);
    children_.push_back({});
    hang_below(size() - 1, parent);
    return size() - 1;
  }

  /// Gives a node another parent, and all below it their new costs.
  void move(int node, int parent, double cost);

  struct Near {
    int node = -1;
    double distance = std::numeric_limits<double>::infinity();  ///< [rad or m, L2]
  };
  /// The node nearest to `q`, the first of equals.
  Near nearest(std::span<const double> q) const;
  /// Writes the nodes that are no farther from `q` than `radius` [rad or m, L2], in any order, with
  /// their distances.
  void within(std::span<const double> q, double radius, std::vector<Near>& out) const;

  /// Nodes from `node` to its root.
  std::vector<JointVec> branch(int node) const;
  /// All nodes.
  SearchTree copy() const;

 private:
  /// Children of a node form a list: the first, and of each the next.
  struct Children {
    int first = -1, next = -1;
  };
  Children& children(int node) { return children_[static_cast<std::size_t>(node)]; }
  void hang_below(int node, int parent) {
    if (parent < 0) return;
    children(node).next = children(parent).first;
    children(parent).first = node;
  }

  std::size_t dof_;
  std::vector<double> rows_;  // dof_ a node
  NearNodes places_;
  std::vector<int> parents_;
  std::vector<double> costs_;
  std::vector<Children> children_;
};

}  // namespace mjarm::detail
