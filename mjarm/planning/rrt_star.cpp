#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mjarm/planning/sampler_internal.hpp"
#include "mjarm/planning/search_internal.hpp"
#include "mjarm/planning/tree_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr int kStarSamples = 3000;      // where nothing else is said
constexpr double kNeighbourhood = 1.1;  // of the radius that makes paths tend to the shortest one
constexpr std::size_t kMaxNear = 24;    // neighbours that are tried
constexpr double kTowardsGoal = 0.05;   // share of samples that are goals

/// RRT* (S. Karaman and E. Frazzoli, IJRR 30 (2011) 846) with the samples of Informed RRT*
/// (J. D. Gammell et al., IROS 2014), grown round a path of rrt_connect, so that there is an answer
/// wherever that has one.
class Rewirer {
 public:
  Rewirer(const SearchProblem& problem, const PlanOptions& options, RawPath path)
      : problem_(problem),
        options_(options),
        dof_(problem.start.size()),
        path_(std::move(path)),
        range_(detail::range_of(problem.keeper ? &*problem.keeper : nullptr, options)),
        prover_(problem.checker, problem.keeper ? &*problem.keeper : nullptr, options,
                path_.counts),
        rng_(options.seed, 2),
        sampler_(problem, rng_),
        tree_(dof_) {
    problem_.max_cost = path_length(path_.q);
    problem_.deadline = Deadline(options.stop);  // the samples bound what follows
    int node = tree_.add(as_span(path_.q.front()), -1, 0);
    for (std::size_t i = 1; i < path_.q.size(); ++i) {
      node = tree_.add(as_span(path_.q[i]), node, (path_.q[i] - path_.q[i - 1]).norm());
    }
    best_ = node;
  }

  RawPath run() {
    const int samples = options_.samples > 0 ? options_.samples : kStarSamples;
    for (int k = 0; k < samples && !problem_.deadline.passed(); ++k) {
      ++path_.counts.samples;
      add_sample();
      problem_.max_cost = tree_.cost(best_);
    }
    path_.q = tree_.branch(best_);
    std::reverse(path_.q.begin(), path_.q.end());
    path_.counts.nodes += tree_.size();
    if (options_.keep_trees) path_.trees = {tree_.copy()};
    return std::move(path_);
  }

 private:
  using Row = std::array<double, kMaxDof>;
  /// A neighbour, by the length of the way through it.
  struct Near {
    double cost = 0, length = 0;
    int node = -1;
  };

  void add_sample() {
    Row row;
    const std::span<double> q(row.data(), dof_);
    const bool to_goal = rng_.uniform() < kTowardsGoal;
    if (to_goal) {
      const auto g = static_cast<std::size_t>(rng_.below(problem_.goals.size()));
      std::copy(problem_.goals[g].begin(), problem_.goals[g].end(), q.begin());
    } else {
      sampler_.between_ends(q);
    }
    const Tree::Near nearest = tree_.nearest(q);
    if (nearest.distance == 0) return;
    const bool whole = nearest.distance <= range_;
    if (!whole) {
      const Row to = row;
      between(tree_.q(nearest.node), {to.data(), dof_}, range_ / nearest.distance, q);
    }
    const bool is_goal = to_goal && whole;  // which keeps the limit as it is
    if (problem_.keeper && !is_goal && !problem_.keeper->project(q)) return;
    if (least_cost_through(problem_, q) >= problem_.max_cost) return;
    find_near(q);
    const int node = attach(q);
    if (node < 0) return;
    rewire(node);
    for (std::size_t g = 0; g < problem_.goals.size(); ++g) {
      if (is_goal && distance(q, problem_.goals[g]) == 0) take(node, g);
    }
  }

  void take(int node, std::size_t goal) {
    if (tree_.cost(node) >= tree_.cost(best_)) return;
    best_ = node;
    path_.goal = problem_.goal_index[goal];
  }

  /// Fills near_ with the nodes within the radius, cheapest way to `q` first. The constant in the
  /// radius is as if what is searched were a cube as wide as the best way is long.
  void find_near(std::span<const double> q) {
    near_.clear();
    const double n = tree_.size();
    const double radius =
        std::min(range_, kNeighbourhood * problem_.max_cost *
                             std::pow(std::log(n + 1) / n, 1.0 / static_cast<double>(dof_)));
    tree_.within(q, std::max(radius, 1e-9), within_);
    for (const auto& [node, length] : within_) {
      near_.push_back({tree_.cost(node) + length, length, node});
    }
    if (near_.empty()) {
      const Tree::Near nearest = tree_.nearest(q);
      near_.push_back(
          {tree_.cost(nearest.node) + nearest.distance, nearest.distance, nearest.node});
    }
    std::sort(near_.begin(), near_.end(), [](const Near& a, const Near& b) {
      return a.cost < b.cost || (a.cost == b.cost && a.node < b.node);
    });
    near_.resize(std::min(near_.size(), kMaxNear));
  }

  /// A new node with the cheapest parent that a proved edge leads from, or -1.
  int attach(std::span<const double> q) {
    for (const Near& near : near_) {
      if (prover_.is_free(tree_.q(near.node), q)) return tree_.add(q, near.node, near.length);
    }
    return -1;
  }

  /// Leads neighbours over the new node where that is shorter.
  void rewire(int node) {
    for (const Near& near : near_) {
      const double cost = tree_.cost(node) + near.length;
      if (near.node == tree_.parent(node) || cost >= tree_.cost(near.node)) continue;
      if (prover_.is_free(tree_.q(node), tree_.q(near.node))) tree_.move(near.node, node, cost);
    }
  }

  SearchProblem problem_;
  const PlanOptions& options_;
  std::size_t dof_;
  RawPath path_;
  double range_;
  EdgeProver prover_;
  Rng rng_;
  Sampler sampler_;
  Tree tree_;
  int best_ = 0;
  std::vector<Tree::Near> within_;
  std::vector<Near> near_;
};

}  // namespace

Result<RawPath, PlanFailure> rrt_star(const SearchProblem& problem, const PlanOptions& options) {
  Result<RawPath, PlanFailure> path = rrt_connect(problem, options);
  if (!path) return path;
  return Rewirer(problem, options, std::move(*path)).run();
}

}  // namespace mjarm::detail
