#include <algorithm>
#include <utility>

#include "mjarm/planning/ompl_planners.hpp"
#include "mjarm/planning/search_internal.hpp"

#ifdef MJARM_OMPL
#include <ompl/base/goals/GoalStates.h>
#include <ompl/datastructures/NearestNeighborsGNAT.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/est/BiEST.h>
#include <ompl/geometric/planners/est/EST.h>
#include <ompl/geometric/planners/fmt/FMT.h>
#include <ompl/geometric/planners/informedtrees/ABITstar.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/rrt/InformedRRTstar.h>
#include <ompl/geometric/planners/rrt/LazyRRT.h>
#include <ompl/geometric/planners/rrt/RRT.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTsharp.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>

#include <memory>
#include <mutex>
#include <string>

#include "mjarm/planning/ompl_space_internal.hpp"
#endif

namespace mjarm::detail {

#ifdef MJARM_OMPL
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

constexpr std::uint64_t kPlannerStream = 0;  // the samplers have those above
constexpr int kBatch = 1000;                 // that FMT draws before it looks, at most
constexpr int kFreeShare = 10;               // of what it draws, at least one in so many is free

/// The first pivot of a tree of neighbours, which OMPL draws from a generator of the whole process.
template <class T>
struct SeededCenters : ompl::GreedyKCenters<T> {
  SeededCenters() { this->rng_.setLocalSeed(1); }
};

/// The same tree of neighbours for the same states.
template <class T>
struct SeededTree : ompl::NearestNeighborsGNAT<T> {
  SeededTree() { this->pivotSelector_ = SeededCenters<T>(); }
};

template <class T>
void give_tree(std::shared_ptr<ompl::NearestNeighbors<T>>& neighbors) {
  if (!neighbors) neighbors = std::make_shared<SeededTree<T>>();
}

/// A planner with a seed of ours wherever OMPL would take one from the generator of the process,
/// whose state depends on all other searches.
template <class Base>
class Seeded : public Base {
 public:
  Seeded(const ob::SpaceInformationPtr& si, std::uint_fast32_t seed) : Base(si) {
    if constexpr (requires { this->rng_.setLocalSeed(seed); }) this->rng_.setLocalSeed(seed);
  }

  void setup() override {
    if constexpr (requires { give_tree(this->nn_); }) give_tree(this->nn_);
    if constexpr (requires { give_tree(this->nnStart_); }) {
      give_tree(this->nnStart_);
      give_tree(this->nnGoal_);
    }
    if constexpr (requires { give_tree(this->tStart_); }) {
      give_tree(this->tStart_);
      give_tree(this->tGoal_);
    }
    Base::setup();
  }
};

template <class Base>
ob::PlannerPtr make_seeded(const ob::SpaceInformationPtr& si, std::uint_fast32_t seed) {
  return std::make_shared<Seeded<Base>>(si, seed);
}

struct Offer {
  std::string_view name;
  bool improves;  ///< goes on after the first path
  ob::PlannerPtr (*make)(const ob::SpaceInformationPtr&, std::uint_fast32_t);
};

constexpr Offer kOffers[] = {
    {"RRTConnect", false, make_seeded<og::RRTConnect>},
    {"RRT", false, make_seeded<og::RRT>},
    {"LazyRRT", false, make_seeded<og::LazyRRT>},
    {"EST", false, make_seeded<og::EST>},
    {"BiEST", false, make_seeded<og::BiEST>},
    {"FMT", false, make_seeded<og::FMT>},
    {"RRTstar", true, make_seeded<og::RRTstar>},
    {"RRTsharp", true, make_seeded<og::RRTsharp>},
    {"InformedRRTstar", true, make_seeded<og::InformedRRTstar>},
    {"BITstar", true, make_seeded<og::BITstar>},
    {"ABITstar", true, make_seeded<og::ABITstar>},
};

tl::unexpected<PlanFailure> failed(PlanErrc reason) {
  PlanFailure failure;
  failure.code = reason;
  return tl::unexpected(failure);
}

/// One search.
class OmplSearch {
 public:
  OmplSearch(const SearchProblem& problem, const PlanOptions& options, const Offer& offer)
      : problem_(problem), options_(options), offer_(offer), budget_(options, offer.improves) {}

  Result<RawPath, PlanFailure> run() {
    const std::span<const double> nearest = problem_.goals.front();
    EdgeProver prover(problem_.checker, nullptr, options_, budget_.counts());
    if (prover.is_free(problem_.start, nearest)) {  // nothing is shorter
      return RawPath{{joint_vec(problem_.start), joint_vec(nearest)},
                     problem_.goal_index.front(),
                     budget_.counts()};
    }
    make_space();
    make_definition();
    const ob::PlannerPtr planner = make_planner();
    const ob::PlannerStatus status =
        planner->solve(ob::PlannerTerminationCondition([this] { return budget_.spent(); }));
    if (status == ob::PlannerStatus::EXACT_SOLUTION) return take_path(prover);
    const double difference = definition_->getSolutionDifference();  // < 0: not known
    return tl::unexpected(
        budget_.why(difference >= 0 ? difference : distance(problem_.start, nearest)));
  }

 private:
  ob::ScopedState<ArmSpace> state_at(std::span<const double> q) const {
    ob::ScopedState<ArmSpace> state(si_);
    std::ranges::copy(q, joints_of(state.get(), q.size()).begin());
    return state;
  }

  void make_space() {
    si_ = std::make_shared<ob::SpaceInformation>(
        std::make_shared<ArmSpace>(problem_, budget_, options_.seed));
    si_->setStateValidityChecker(std::make_shared<FreeStates>(si_, problem_.checker));
    si_->setMotionValidator(
        std::make_shared<ProvedMotions>(si_, problem_.checker, options_, budget_));
    si_->setup();
  }

  void make_definition() {
    definition_ = std::make_shared<ob::ProblemDefinition>(si_);
    definition_->addStartState(state_at(problem_.start));
    const auto goals = std::make_shared<ob::GoalStates>(si_);
    for (const std::span<const double> goal : problem_.goals) goals->addState(state_at(goal));
    definition_->setGoal(goals);
    if (!offer_.improves) return;
    definition_->setOptimizationObjective(std::make_shared<ArmLength>(si_, problem_));
    definition_->setIntermediateSolutionCallback(
        [this](const ob::Planner*, const auto&, ob::Cost) { budget_.found(); });
  }

  ob::PlannerPtr make_planner() const {
    const auto seed = static_cast<std::uint32_t>(Rng(options_.seed, kPlannerStream).next() | 1U);
    ob::PlannerPtr planner = offer_.make(si_, seed);
    planner->setProblemDefinition(definition_);
    if (planner->params().hasParam("range")) {
      planner->params().setParam("range", std::to_string(options_.range));
    }
    if (const auto fmt = std::dynamic_pointer_cast<og::FMT>(planner)) {
      fmt->setNumSamples(static_cast<unsigned int>(std::min(kBatch, budget_.max() / kFreeShare)));
      fmt->setExtendedFMT(false);  // it takes minutes where there is no path
    }
    return planner;
  }

  /// The path that was found. Its edges were proved one way or the other when they were added.
  Result<RawPath, PlanFailure> take_path(EdgeProver& prover) {
    const auto found = std::dynamic_pointer_cast<og::PathGeometric>(definition_->getSolutionPath());
    RawPath path;
    for (const ob::State* state : found->getStates()) {
      path.q.push_back(joint_vec(joints_of(state, problem_.start.size())));
    }
    if (path.q.size() < 2) return failed(PlanErrc::back_end);
    for (std::size_t i = 1; i < path.q.size(); ++i) {
      const std::span<const double> a = as_span(path.q[i - 1]), b = as_span(path.q[i]);
      if (!prover.is_free(a, b) && !prover.is_free(b, a)) {
        return failed(PlanErrc::unproved);
      }
    }
    const auto end = std::ranges::find_if(problem_.goals, [&](std::span<const double> goal) {
      return distance(goal, as_span(path.q.back())) == 0;
    });
    if (end == problem_.goals.end()) return failed(PlanErrc::back_end);
    path.goal = problem_.goal_index[static_cast<std::size_t>(end - problem_.goals.begin())];
    path.counts = budget_.counts();
    return path;
  }

  const SearchProblem& problem_;
  const PlanOptions& options_;
  const Offer& offer_;
  OmplBudget budget_;
  ob::SpaceInformationPtr si_;
  ob::ProblemDefinitionPtr definition_;
};

}  // namespace

Result<RawPath, PlanFailure> ompl_search(const SearchProblem& problem, const PlanOptions& options) {
  const auto* const offer = std::ranges::find(kOffers, options.ompl_planner, &Offer::name);
  if (offer == std::end(kOffers)) return failed(PlanErrc::not_available);
  if (options.tilt || options.within) return failed(PlanErrc::tilt_with_ompl);
  static std::once_flag quiet;
  std::call_once(quiet, [] { ompl::msg::noOutputHandler(); });
  try {
    return OmplSearch(problem, options, *offer).run();
  } catch (...) {
    return failed(PlanErrc::back_end);
  }
}

#else

Result<RawPath, PlanFailure> ompl_search(const SearchProblem&, const PlanOptions&) {
  PlanFailure failure;
  failure.code = PlanErrc::not_available;
  return tl::unexpected(failure);
}

#endif

}  // namespace mjarm::detail
