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

constexpr double kBeside = 0.5;      // share of samples that are drawn beside a node at first,
constexpr int kBetweenEnds = 80;     // for so many samples; later on all are
constexpr int kLarger = 16;          // one turn in so many is that of the larger tree
constexpr std::size_t kSteps = 4;    // looked at together,
constexpr std::size_t kStates = 4;   // at so many places each, before they are proved
constexpr double kFreePart = 0.7;    // of what lies before a hit is tried once more
constexpr double kLeastPart = 0.3;   // [rad or m, L2] if it is as long as this
constexpr double kSamePlace = 1e-9;  // [rad or m, L2]

/// RRT-Connect (J. J. Kuffner and S. M. LaValle, ICRA 2000), with three changes: every edge is
/// proved; samples are drawn beside nodes as well, which gets out of narrow places (as D. Hsu,
/// J.-C. Latombe and R. Motwani, ICRA 1997, do); several steps of a tree are looked at together,
/// at a few places each, as most of them fail where it is narrow and a look costs far less than a
/// proof that ends in a collision.
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
        sampler_(problem, rng_),
        from_start_(dof_),
        from_goals_(dof_) {}

  Result<RawPath, PlanFailure> run() {
    from_start_.add(problem_.start, -1, 0);
    for (const std::span<const double> goal : problem_.goals) from_goals_.add(goal, -1, 0);
    // Once there is a path, the straight ways are known.
    for (int g = 0; g < from_goals_.size() && std::isinf(problem_.max_cost); ++g) {
      if (prover_.is_free(problem_.start, from_goals_.q(g))) return join(0, g);
    }
    const int max = options_.samples > 0 ? options_.samples : detail::kAllSamples;
    SearchWatch watch(options_, max);
    for (int turn = 1; !watch.is_hopeless(path_.counts.samples, nearest_) &&
                       path_.counts.samples < max && !problem_.deadline.passed();
         ++turn) {
      // One that cannot grow must not have all turns.
      const bool larger = turn % kLarger == 0;
      const bool start_turn = (from_start_.size() <= from_goals_.size()) != larger;
      Tree& grown = start_turn ? from_start_ : from_goals_;
      Tree& other = start_turn ? from_goals_ : from_start_;
      const int first = grown.size();
      grow(grown, max - path_.counts.samples);
      const int last = grown.size() - 1;
      // Within regions the new nodes are those of one way.
      for (int node = keeper_ != nullptr ? std::max(first, last) : first; node <= last; ++node) {
        const int met = connect(other, grown.q(node));
        if (met >= 0 && grown.cost(node) + other.cost(met) < problem_.max_cost)
          return start_turn ? join(node, met) : join(met, node);
      }
    }
    return tl::unexpected(watch.why(path_.counts.samples, nearest_));
  }

 private:
  using Row = std::array<double, kMaxDof>;
  using States = std::array<double, kSteps * kStates * kMaxDof>;
  /// From a node of a tree.
  struct Step {
    int node;
    double length;  // [rad or m, L2]
    Row end;
  };

  /// Grows a tree towards some new samples, `max` at most.
  void grow(Tree& tree, int max) {
    if (keeper_ != nullptr) return grow_within(tree);
    std::array<Step, kSteps> steps;
    States states;
    std::size_t count = 0;
    for (std::size_t k = 0; k < kSteps && std::cmp_less(k, max); ++k) {
      count += propose(tree, steps[count], states.data() + count * kStates * dof_) ? 1 : 0;
    }
    std::array<std::uint8_t, kSteps * kStates> free;
    const std::size_t looks = count * kStates;
    problem_.checker.check({states.data(), looks * dof_}, {free.data(), looks});
    for (std::size_t k = 0; k < count; ++k) take(tree, steps[k], free.data() + k * kStates);
  }

  /// A step of a tree towards a new sample, and the states on its way; false: it leads nowhere.
  bool propose(const Tree& tree, Step& step, double* states) {
    Row row;
    const std::span<double> q(row.data(), dof_);
    draw(tree, q);
    const Tree::Near near = tree.nearest(q);
    if (!may_lead_on(near, q)) return false;
    step = {near.node, std::min(near.distance, range_), row};
    const std::span<double> end(step.end.data(), dof_);
    between(tree.q(near.node), q, step.length / near.distance, end);
    for (std::size_t i = 1; i <= kStates; ++i, states += dof_) {
      between(tree.q(near.node), end, static_cast<double>(i) / kStates, {states, dof_});
    }
    return true;
  }

  /// Proves a step, or what of it seems free, and adds its end.
  void take(Tree& tree, const Step& step, const std::uint8_t* free) {
    const auto seen = std::find(free, free + kStates, 0) - free;
    const bool whole = seen == kStates;
    const double part = whole ? 1 : kFreePart * static_cast<double>(seen) / kStates;
    if (!whole && part * step.length < kLeastPart) return;
    Row row;
    const std::span<double> end(row.data(), dof_);
    between(tree.q(step.node), {step.end.data(), dof_}, part, end);
    if (prover_.is_free(tree.q(step.node), end)) tree.add(end, step.node, part * step.length);
  }

  void draw(const Tree& tree, std::span<double> q) {
    const bool beside = path_.counts.samples++ >= kBetweenEnds || rng_.uniform() < kBeside;
    if (!beside) return sampler_.between_ends(q);
    const auto node = rng_.below(static_cast<std::uint64_t>(tree.size()));
    sampler_.beside(tree.q(static_cast<int>(node)), q);
  }

  bool may_lead_on(const Tree::Near& near, std::span<const double> q) const {
    return near.distance >= kSamePlace && least_cost_through(problem_, q) < problem_.max_cost;
  }

  /// The same within regions of the tool, a sample at a time: in short steps, as far as
  /// PlanOptions::range.
  void grow_within(Tree& tree) {
    Row row;
    const std::span<double> q(row.data(), dof_);
    draw(tree, q);
    if (!keeper_->project(q)) return;
    Tree::Near near = tree.nearest(q);
    if (!may_lead_on(near, q)) return;
    for (double left = options_.range; left > 0; left -= range_) {
      const Made made = step(tree, near, q);
      if (!made.whole || made.arrived) return;
      near = {made.node, distance(tree.q(made.node), q)};
    }
  }

  /// Grows `tree` to `goal`, a node of the other tree; the node there, or -1.
  int connect(Tree& tree, std::span<const double> goal) {
    Tree::Near near = tree.nearest(goal);
    for (;;) {
      nearest_ = std::min(nearest_, near.distance);
      if (near.distance < kSamePlace) return near.node;
      const Made made = step(tree, near, goal);
      if (made.arrived) return made.node;
      if (!made.whole) return -1;
      near = {made.node, distance(tree.q(made.node), goal)};
    }
  }

  struct Made {
    int node = -1;         ///< new, -1: none
    bool whole = false;    ///< as far as it was to go
    bool arrived = false;  ///< at its end
  };
  /// Goes from a node towards `to`, at most range_ far; where that is blocked, a part of the way.
  Made step(Tree& tree, const Tree::Near& near, std::span<const double> to) {
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
    if (keeper_ != nullptr) return {};  // steps are short already
    const double part = kFreePart * found.t;
    if (part * length < kLeastPart) return {};
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
  Sampler sampler_;
  Tree from_start_, from_goals_;
  double nearest_ = std::numeric_limits<double>::infinity();
};

}  // namespace

Result<RawPath, PlanFailure> rrt_connect(const SearchProblem& problem, const PlanOptions& options) {
  return Connector(problem, options).run();
}

}  // namespace mjarm::detail
