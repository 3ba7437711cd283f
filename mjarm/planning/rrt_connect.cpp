#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "mjarm/planning/sampler_internal.hpp"
#include "mjarm/planning/search_internal.hpp"
#include "mjarm/planning/search_watch_internal.hpp"
#include "mjarm/planning/tree_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kBeside = 0.5;     // share of samples that are drawn beside a node
constexpr int kEvenOnly = 8;        // samples before that begins
constexpr double kBlocked = 1.2;    // a node looks so much farther (squared) after a blocked way,
constexpr double kUnmet = 1.1;      // and after one towards the other tree
constexpr double kFreePart = 0.5;   // of what lies before a hit is tried once more
constexpr double kLeastPart = 0.3;  // [rad or m, L2] if it is as long as this,
constexpr double kLeastPartFirst = 0.6;  // or as this at first: easy ways need no short parts,
constexpr int kCoarse = 60;              // for so many samples
constexpr double kSamePlace = 1e-9;      // [rad or m, L2]

/// RRT-Connect (J. J. Kuffner and S. M. LaValle, ICRA 2000), with three changes: every edge is
/// proved; half of the samples are drawn beside nodes, which gets out of narrow places (as D. Hsu,
/// J.-C. Latombe and R. Motwani, ICRA 1997, do); nodes whose ways were blocked are chosen less
/// often, as in the dynamic domain of A. Yershova et al., ICRA 2005.
class Connector {
 public:
  Connector(const SearchProblem& problem, const PlanOptions& options)
      : problem_(problem),
        options_(options),
        dof_(problem.start.size()),
        keeper_(problem.keeper ? &*problem.keeper : nullptr),
        range_(detail::range_of(keeper_, options)),
        prover_(problem.checker, keeper_, options, path_.counts),
        rng_(options.seed),
        box_(problem, rng_),
        from_start_(dof_),
        from_goals_(dof_) {}

  Result<RawPath, PlanFailure> run() {
    from_start_.add(problem_.start, -1, 0);
    for (const std::span<const double> goal : problem_.goals) from_goals_.add(goal, -1, 0);
    // Once there is a path, the straight ways are known.
    for (int g = 0; g < from_goals_.size() && std::isinf(problem_.max_cost); ++g) {
      if (prover_.is_free(problem_.start, from_goals_.q(g))) return join(0, g);
    }
    Tree* grown = &from_start_;
    Tree* other = &from_goals_;
    const int max = options_.samples > 0 ? options_.samples : detail::kAllSamples;
    SearchWatch watch(options_, max);
    while (!watch.is_hopeless(path_.counts.samples, nearest_) && path_.counts.samples < max &&
           !problem_.deadline.passed()) {
      const int node = grow(*grown);
      if (node >= 0) {
        const int met = connect(*other, grown->q(node));
        if (met >= 0 && grown->cost(node) + other->cost(met) < problem_.max_cost)
          return grown == &from_start_ ? join(node, met) : join(met, node);
      }
      if (other->size() < grown->size() || node < 0) std::swap(grown, other);
    }
    return tl::unexpected(watch.why(path_.counts.samples, nearest_));
  }

 private:
  using Row = std::array<double, kMaxDof>;

  /// A new node towards a new sample, or -1.
  int grow(Tree& tree) {
    ++path_.counts.samples;
    Row row;
    const std::span<double> q(row.data(), dof_);
    Tree::Near near;
    if (path_.counts.samples > kEvenOnly && rng_.uniform() < kBeside) {
      near.node = static_cast<int>(rng_.below(static_cast<std::uint64_t>(tree.size())));
      near.distance = draw_beside(tree.q(near.node), rng_, q);
    } else {
      box_.next(q);
      near = tree.nearest(q);
    }
    if (keeper_ != nullptr) {
      if (!keeper_->project(q)) return -1;
      near.distance = distance(tree.q(near.node), q);
    }
    if (near.distance < kSamePlace) return -1;
    if (least_cost_through(problem_, q) >= problem_.max_cost) return -1;
    return advance(tree, near, q);
  }

  /// Goes towards `q`, as far as PlanOptions::range: in one step, within regions of the tool in
  /// several. The last new node, or -1.
  int advance(Tree& tree, Tree::Near near, std::span<const double> q) {
    int last = -1;
    for (double left = options_.range; left > 0; left -= range_) {
      const Step made = step(tree, near, q, kBlocked);
      if (made.node >= 0) last = made.node;
      if (!made.whole || made.arrived) break;
      near = {made.node, distance(tree.q(made.node), q)};
    }
    return last;
  }

  /// Grows `tree` to `goal`, a node of the other tree; the node there, or -1.
  int connect(Tree& tree, std::span<const double> goal) {
    Tree::Near near = tree.nearest(goal);
    for (;;) {
      nearest_ = std::min(nearest_, near.distance);
      if (near.distance < kSamePlace) return near.node;
      const Step made = step(tree, near, goal, kUnmet);
      if (made.arrived) return made.node;
      if (!made.whole) return -1;
      near = {made.node, distance(tree.q(made.node), goal)};
    }
  }

  struct Step {
    int node = -1;         ///< new, -1: none
    bool whole = false;    ///< as far as it was to go
    bool arrived = false;  ///< at its end
  };
  /// Goes from a node towards `to`, at most range_ far; where that is blocked, a part of the way.
  Step step(Tree& tree, const Tree::Near& near, std::span<const double> to, double push) {
    const bool arrives = near.distance <= range_;
    double length = std::min(near.distance, range_);
    Row row;
    const std::span<double> end(row.data(), dof_);
    std::copy(to.begin(), to.end(), end.begin());  // to the last bit: the trees meet there
    if (!arrives && keeper_ != nullptr) {
      const auto made = keeper_->step(tree.q(near.node), to, range_, end);
      if (!made) return {};
      length = *made;
    } else if (!arrives) {
      between(tree.q(near.node), to, length / near.distance, end);
    }
    const EdgeResult found = prover_.look(tree.q(near.node), end);
    if (found.verdict == EdgeVerdict::free)
      return {tree.add(end, near.node, length), true, arrives};
    tree.push_away(near.node, push);
    if (keeper_ != nullptr) return {};  // steps are short already
    const double part = kFreePart * found.t;
    if (part * length < (path_.counts.samples < kCoarse ? kLeastPartFirst : kLeastPart)) return {};
    between(tree.q(near.node), to, part * length / near.distance, end);
    if (!prover_.is_free(tree.q(near.node), end)) return {};
    return {tree.add(end, near.node, part * length), false, false};
  }

  RawPath join(int start_node, int goal_node) {
    path_.q = from_start_.branch(start_node);
    std::reverse(path_.q.begin(), path_.q.end());
    const std::vector<JointVec> rest = from_goals_.branch(goal_node);
    // The node where both trees meet is in both.
    const bool twice =
        path_.q.size() + rest.size() > 2 && (path_.q.back() - rest.front()).norm() < kSamePlace;
    path_.q.insert(path_.q.end(), rest.begin() + (twice ? 1 : 0), rest.end());
    path_.goal = problem_.goal_index[static_cast<std::size_t>(from_goals_.root(goal_node))];
    path_.counts.nodes = from_start_.size() + from_goals_.size();
    if (options_.keep_trees) path_.trees = {from_start_.copy(), from_goals_.copy()};
    return std::move(path_);
  }

  const SearchProblem& problem_;
  const PlanOptions& options_;
  std::size_t dof_;
  RawPath path_;
  const PathKeeper* keeper_;  // null: no limit
  double range_;              // [rad or m, L2] of one edge
  EdgeProver prover_;
  Rng rng_;
  WideningBox box_;
  Tree from_start_, from_goals_;
  double nearest_ = std::numeric_limits<double>::infinity();
};

}  // namespace

Result<RawPath, PlanFailure> rrt_connect(const SearchProblem& problem, const PlanOptions& options) {
  return Connector(problem, options).run();
}

}  // namespace mjarm::detail
