#pragma once

#include <ompl/base/MotionValidator.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <span>

#include "mjarm/core/rng.hpp"
#include "mjarm/planning/search_internal.hpp"
#include "mjarm/planning/search_watch_internal.hpp"

namespace mjarm::detail {

/// What a search by OMPL has spent, and whether it has to end.
class OmplBudget {
 public:
  /// Starts the clock, if a time is given.
  /// @param improves  whether the planner goes on after its first path.
  OmplBudget(const PlanOptions& options, bool improves);

  /// A configuration was drawn.
  void draw() { ++counts_.samples; }
  /// An edge was looked at.
  void look() { ++steps_; }
  /// There is a path; what follows is for a shorter one.
  void found();
  /// Whether to end; planners ask again and again, and asking counts as a step.
  bool spent();
  /// Why there is no path, where none was found.
  /// @param nearest  [rad or m, L2] how near the search came.
  [[nodiscard]] PlanFailure why(double nearest) { return watch_.why(counts_.samples, nearest); }

  PlanCounts& counts() { return counts_; }
  /// Configurations that may be drawn until there is a path.
  int max() const { return max_; }

 private:
  PlanCounts counts_;
  Deadline deadline_;
  Deadline limit_;  // until there is a path
  bool timed_;
  int max_, more_;  // draws until there is a path, and after that
  SearchWatch watch_;
  std::int64_t steps_ = 0;  // for planners that go on and on without drawing
  bool found_ = false;
};

/// The joints of `state`, shape (dof,).
[[nodiscard]] std::span<double> joints_of(ompl::base::State* state, std::size_t dof);
[[nodiscard]] std::span<const double> joints_of(const ompl::base::State* state, std::size_t dof);

/// The joint space within the limits (endless joints: two turns each way), start and goals
/// included, with random numbers of our own.
class ArmSpace : public ompl::base::RealVectorStateSpace {
 public:
  ArmSpace(const SearchProblem& problem, OmplBudget& budget, std::uint64_t seed);

  /// A sequence of its own for each caller.
  Rng next_rng() const { return Rng(seed_, ++streams_); }
  OmplBudget& budget() const { return budget_; }

  ompl::base::StateSamplerPtr allocDefaultStateSampler() const override;
  /// None: the planners that are offered use none, and OMPL's own are random.
  void registerProjections() override {}
  /// It is one; but of a metric space OMPL sorts the states into trees at random.
  bool isMetricSpace() const override { return false; }

 private:
  OmplBudget& budget_;
  std::uint64_t seed_;
  mutable std::uint64_t streams_ = 0;
};

/// Says which configurations are free.
class FreeStates : public ompl::base::StateValidityChecker {
 public:
  FreeStates(const ompl::base::SpaceInformationPtr& si, const FastChecker& checker)
      : StateValidityChecker(si), checker_(checker) {}
  bool isValid(const ompl::base::State* state) const override;

 private:
  const FastChecker& checker_;
};

/// Lets only proved edges pass.
class ProvedMotions : public ompl::base::MotionValidator {
 public:
  ProvedMotions(const ompl::base::SpaceInformationPtr& si, const FastChecker& checker,
                const PlanOptions& options, OmplBudget& budget)
      : MotionValidator(si),
        checker_(checker),
        budget_(budget),
        prover_(checker, nullptr, options, budget.counts()) {}
  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to) const override;
  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to,
                   std::pair<ompl::base::State*, double>& last) const override;

 private:
  EdgeResult look(const ompl::base::State* from, const ompl::base::State* to) const;

  const FastChecker& checker_;
  OmplBudget& budget_;
  mutable EdgeProver prover_;
};

/// Joint-space length, with samples from the ellipsoids of what can be shorter.
class ArmLength : public ompl::base::PathLengthOptimizationObjective {
 public:
  ArmLength(const ompl::base::SpaceInformationPtr& si, const SearchProblem& problem)
      : PathLengthOptimizationObjective(si), problem_(problem) {}
  ompl::base::InformedSamplerPtr allocInformedStateSampler(
      const ompl::base::ProblemDefinitionPtr& definition, unsigned int max_calls) const override;

 private:
  const SearchProblem& problem_;
};

}  // namespace mjarm::detail
