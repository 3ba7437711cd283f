#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace mjarm::detail {

/// Where the nodes of a search tree are, so that the nearest one is found in a time that grows far
/// slower than their number: boxes that are cut in two as they fill up (a k-d tree: J. L. Bentley,
/// Communications of the ACM 18 (1975) 509), some hundred nodes in the smallest, which are compared
/// several at once. In single precision.
class NearNodes {
 public:
  explicit NearNodes(std::size_t dof);

  /// The next node, by number from 0.
  /// @param q  shape (dof,) [rad or m].
  void add(std::span<const double> q);

  /// The nearest node, the first of equals; at least one is there. The same as if all were
  /// compared.
  [[nodiscard]] int nearest(std::span<const double> q) const;

  /// Writes all nodes within `radius`, and maybe some a little farther away, in any order.
  void within(std::span<const double> q, double radius, std::vector<int>& out) const;

 private:
  typedef float Four __attribute__((vector_size(16)));
  static constexpr std::size_t kLanes = 8;  // nodes that are compared at once

  /// Nodes of a box that is not cut, in the order of their numbers.
  struct Leaf {
    std::vector<int> nodes;
    std::vector<float> places;  // kLanes nodes joint by joint, ...; empty lanes are out of reach
  };
  /// A box and what is in it.
  struct Cell {
    int leaf = -1;             // -1: cut
    std::size_t axis = 0;      // across which it is cut
    float at = 0;              // what is less is in the first half
    int halves[2] = {-1, -1};  // cells
  };
  struct Wanted;
  struct Best {
    float distance2;
    int node;
  };

  void put(Leaf& leaf, const float* q, int node);
  void grow(int cell, const float* q);
  void cut(int cell);
  std::array<Four, 2> squared_distances(const float* places, const Wanted& wanted) const;
  float gap2(int cell, const float* q) const;
  void compare(const Leaf& leaf, const Wanted& wanted, Best& best) const;
  void search(int cell, const Wanted& wanted, Best& best) const;
  void collect(int cell, const Wanted& wanted, float radius2, std::vector<int>& out) const;

  std::size_t dof_;
  std::vector<Cell> cells_;   // the first holds all
  std::vector<float> boxes_;  // of every cell low (dof), then high
  std::vector<Leaf> leaves_;
  int count_ = 0;  // of nodes
};

}  // namespace mjarm::detail
