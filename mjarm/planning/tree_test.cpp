// The nearest node of a search tree, and costs when nodes get other parents.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/planning/tree_internal.hpp"

namespace mjarm::detail {
namespace {

std::vector<double> random_q(Rng& rng, std::size_t dof) {
  std::vector<double> q(dof);
  for (double& x : q) x = 6 * rng.uniform() - 3;
  return q;
}

double apart(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum);
}

/// A tree in which every node hangs below one that was there before, by the way between them.
Tree random_tree(Rng& rng, std::size_t dof, int nodes) {
  Tree tree(dof);
  tree.add(random_q(rng, dof), -1, 0);
  while (tree.size() < nodes) {
    const auto parent = static_cast<int>(rng.below(static_cast<std::uint64_t>(tree.size())));
    const std::vector<double> q = random_q(rng, dof);
    tree.add(q, parent, apart(q, tree.q(parent)));
  }
  return tree;
}

/// Whether `node` is `other` or below it.
bool is_below(const Tree& tree, int node, int other) {
  while (node >= 0 && node != other) node = tree.parent(node);
  return node == other;
}

void expect_costs_are_ways_to_roots(const Tree& tree) {
  for (int node = 0; node < tree.size(); ++node) {
    double way = 0;
    for (int n = node; tree.parent(n) >= 0; n = tree.parent(n)) {
      way += apart(tree.q(n), tree.q(tree.parent(n)));
    }
    EXPECT_NEAR(tree.cost(node), way, 1e-9) << node;
  }
}

/// For trees that fill whole blocks of lanes, and those that do not.
TEST(Tree, TheNearestNodeIsThatOfAllComparedOneByOne) {
  Rng rng(1, 1);
  for (const std::size_t dof : {1, 2, 6, 8}) {
    for (const int nodes : {1, 7, 8, 9, 64, 301, 3000}) {
      const Tree tree = random_tree(rng, dof, nodes);
      for (int k = 0; k < 20; ++k) {
        const std::vector<double> q = random_q(rng, dof);
        double least = apart(q, tree.q(0));
        for (int node = 1; node < nodes; ++node) least = std::min(least, apart(q, tree.q(node)));
        const Tree::Near near = tree.nearest(q);
        ASSERT_LT(near.node, nodes);
        EXPECT_EQ(near.distance, apart(q, tree.q(near.node)));
        EXPECT_NEAR(near.distance, least, 1e-5) << dof << " joints, " << nodes << " nodes";
      }
    }
  }
}

/// Nodes in all orders, many in one place, so that boxes are cut where they can be.
TEST(Tree, TheNearestIsFoundAmongNodesInOnePlaceAndInARow) {
  Rng rng(4, 1);
  using Kind = std::pair<std::size_t, double>;
  for (const auto& [dof, spread] : {Kind{1, 1}, Kind{2, 0.01}, Kind{6, 1}, Kind{7, 0}}) {
    Tree tree(dof);
    while (tree.size() < 3000) {
      std::vector<double> q = random_q(rng, dof);
      for (double& x : q) x = tree.size() * (1 - spread) * 1e-3 + spread * std::round(20 * x) / 20;
      tree.add(q, tree.size() - 1, 0);
    }
    for (int k = 0; k < 300; ++k) {
      const std::vector<double> q = random_q(rng, dof);
      double least = apart(q, tree.q(0));
      for (int node = 1; node < tree.size(); ++node)
        least = std::min(least, apart(q, tree.q(node)));
      ASSERT_LE(tree.nearest(q).distance, least + 1e-5) << dof << " joints";
    }
  }
}

TEST(Tree, WithinARadiusAreTheNodesThatAreNoFarther) {
  Rng rng(5, 1);
  std::vector<Tree::Near> found;
  for (const std::size_t dof : {1, 3, 7}) {
    const Tree tree = random_tree(rng, dof, 2000);
    std::size_t all = 0;
    for (int k = 0; k < 50; ++k) {
      const std::vector<double> q = random_q(rng, dof);
      const double radius = 4 * rng.uniform();
      tree.within(q, radius, found);
      std::size_t expected = 0;
      for (int node = 0; node < tree.size(); ++node) expected += apart(q, tree.q(node)) <= radius;
      ASSERT_EQ(found.size(), expected);
      for (const Tree::Near& near : found) EXPECT_EQ(near.distance, apart(q, tree.q(near.node)));
      all += expected;
    }
    EXPECT_GT(all, 100U);
  }
}

TEST(Tree, OfEqualsTheFirstIsNearest) {
  Tree tree(2);
  const std::vector<double> q{1, 2}, other{1.5, 2};
  tree.add(other, -1, 0);
  for (int k = 0; k < 20; ++k) tree.add(q, 0, 0.5);
  EXPECT_EQ(tree.nearest(q).node, 1);
  const Tree::Near near = tree.nearest(std::vector<double>{1.1, 2});
  EXPECT_EQ(near.node, 1);
  EXPECT_NEAR(near.distance, 0.1, 1e-12);
}

TEST(Tree, CostsFollowNodesThatMove) {
  Rng rng(2, 1);
  Tree tree = random_tree(rng, 3, 60);
  int moves = 0;
  for (int k = 0; k < 400; ++k) {
    const auto node = static_cast<int>(1 + rng.below(59));
    const auto parent = static_cast<int>(rng.below(60));
    if (is_below(tree, parent, node)) continue;
    tree.move(node, parent, tree.cost(parent) + apart(tree.q(node), tree.q(parent)));
    EXPECT_EQ(tree.parent(node), parent);
    ++moves;
  }
  EXPECT_GT(moves, 100);
  expect_costs_are_ways_to_roots(tree);
  for (int node = 0; node < tree.size(); ++node) {
    EXPECT_EQ(tree.root(node), 0);
    const std::vector<JointVec> branch = tree.branch(node);
    EXPECT_EQ(branch.back(), joint_vec(tree.q(0)));
    EXPECT_EQ(branch.front(), joint_vec(tree.q(node)));
  }
}

TEST(Tree, ACopyIsTheNodesAndTheirParents) {
  Rng rng(3, 1);
  const Tree tree = random_tree(rng, 4, 33);
  const SearchTree copy = tree.copy();
  ASSERT_EQ(copy.q.size(), 33U);
  ASSERT_EQ(copy.parents.size(), 33U);
  for (int node = 0; node < tree.size(); ++node) {
    const auto i = static_cast<std::size_t>(node);
    EXPECT_EQ(copy.q[i], joint_vec(tree.q(node)));
    EXPECT_EQ(copy.parents[i], tree.parent(node));
  }
}

}  // namespace
}  // namespace mjarm::detail
