#ifdef MJARM_OMPL
#include <ompl/base/samplers/InformedStateSampler.h>
#include <ompl/util/GeometricEquations.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include "mjarm/planning/ompl_space_internal.hpp"

namespace mjarm::detail {
namespace {

namespace ob = ompl::base;

constexpr int kMaxDraws = 100'000;         // where nothing else is said: until a path;
constexpr int kMaxWhereImproved = 10'000;  // by planners that go on: their samples cost more,
constexpr int kMoreDraws = 3000;           // and after it
constexpr std::int64_t kStepsOfDraw = 30;  // edges and questions whether to end
constexpr double kTimeShare = 0.9;         // the rest is for shortening and proof
constexpr double kEndlessJoint = 4 * std::numbers::pi;  // [rad or m] stands for no limit
constexpr double kProvedPart = 0.9;                     // of the way up to where it is blocked

/// Draws within the bounds of the space.
class ArmSampler : public ob::StateSampler {
 public:
  explicit ArmSampler(const ArmSpace& space)
      : StateSampler(&space),
        budget_(space.budget()),
        bounds_(space.getBounds()),
        random_(space.next_rng()) {}

  void sampleUniform(ob::State* state) override {
    budget_.draw();
    const std::span<double> q = joints_of(state, bounds_.low.size());
    for (std::size_t k = 0; k < q.size(); ++k) q[k] = random_.uniform(low(k), high(k));
  }
  void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
    budget_.draw();
    const std::span<double> q = joints_of(state, bounds_.low.size());
    const std::span<const double> from = joints_of(near, q.size());
    for (std::size_t k = 0; k < q.size(); ++k) {
      q[k] = random_.uniform(std::max(low(k), from[k] - distance),
                             std::min(high(k), from[k] + distance));
    }
  }
  void sampleGaussian(ob::State* state, const ob::State* mean, double deviation) override {
    budget_.draw();
    const std::span<double> q = joints_of(state, bounds_.low.size());
    const std::span<const double> from = joints_of(mean, q.size());
    for (std::size_t k = 0; k < q.size(); ++k) {
      q[k] = std::clamp(from[k] + deviation * random_.normal(), low(k), high(k));
    }
  }

 private:
  double low(std::size_t k) const { return bounds_.low[k]; }
  double high(std::size_t k) const { return bounds_.high[k]; }

  OmplBudget& budget_;
  ob::RealVectorBounds bounds_;
  Rng random_;
};

/// Draws evenly from the ellipsoids round start and each goal that hold all shorter paths (J. D.
/// Gammell, T. D. Barfoot and S. S. Srinivasa, IEEE T-RO 34 (2018) 966).
class EllipsoidSampler : public ob::InformedSampler {
 public:
  EllipsoidSampler(const ob::ProblemDefinitionPtr& definition, unsigned int max_calls,
                   const SearchProblem& problem)
      : InformedSampler(definition, max_calls),
        problem_(problem),
        space_of_arm_(static_cast<const ArmSpace&>(*space_)),
        whole_(space_of_arm_.allocDefaultStateSampler()),
        random_(space_of_arm_.next_rng()) {}

  bool sampleUniform(ob::State* state, const ob::Cost& max) override {
    return sampleUniform(state, ob::Cost(0), max);
  }
  bool sampleUniform(ob::State* state, const ob::Cost& least, const ob::Cost& max) override {
    const std::span<double> q = joints_of(state, problem_.start.size());
    for (unsigned int call = 0; call < numIters_; ++call) {
      if (std::isinf(max.value())) {
        whole_->sampleUniform(state);
      } else if (!draw(max.value(), q) || !space_of_arm_.satisfiesBounds(state)) {
        continue;
      }
      const double through = shortest_through(q);
      if (through >= least.value() && through < max.value()) return true;
    }
    return false;
  }

  bool hasInformedMeasure() const override { return true; }
  double getInformedMeasure(const ob::Cost& max) const override {
    const double whole = space_->getMeasure();
    return std::isinf(max.value()) ? whole : std::min(whole, measure(max.value()));
  }

 private:
  double length_to(std::span<const double> goal) const { return distance(problem_.start, goal); }
  double shortest_through(std::span<const double> q) const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto goal : problem_.goals) least = std::min(least, distance(q, goal));
    return distance(problem_.start, q) + least;
  }
  double measure_of(std::span<const double> goal, double max) const {
    const double straight = length_to(goal);
    if (straight >= max) return 0;
    return ompl::prolateHyperspheroidMeasure(static_cast<unsigned int>(goal.size()), straight, max);
  }
  double measure(double max) const {
    double sum = 0;
    for (const auto goal : problem_.goals) sum += measure_of(goal, max);
    return sum;
  }

  /// Where ellipsoids overlap, as many draws are dropped as there are too many.
  bool draw(double max, std::span<double> q) {
    budget().draw();
    double share = random_.uniform() * measure(max);
    std::span<const double> chosen = problem_.goals.front();
    for (const auto goal : problem_.goals) {
      const double part = measure_of(goal, max);
      if (part > 0) chosen = goal;
      share -= part;
      if (share < 0) break;
    }
    if (length_to(chosen) >= max) return false;
    draw_round(chosen, max, q);
    int inside = 0;
    for (const auto goal : problem_.goals) {
      inside += distance(problem_.start, q) + distance(q, goal) < max ? 1 : 0;
    }
    return inside <= 1 || random_.uniform() * inside < 1;
  }

  /// A point of the unit ball, stretched along the first axis, which a reflection then lays along
  /// the line from start to goal.
  void draw_round(std::span<const double> goal, double max, std::span<double> q) {
    const std::size_t n = q.size();
    const double straight = length_to(goal);
    const double wide = 0.5 * std::sqrt(max * max - straight * straight);
    std::array<double, kMaxDof> mirror{};
    double norm2 = 0, along = 0, mirror2 = 0;
    for (std::size_t k = 0; k < n; ++k) {
      q[k] = random_.normal();
      norm2 += q[k] * q[k];
      mirror[k] = (k == 0 ? 1.0 : 0.0) -
                  (straight > 0 ? (goal[k] - problem_.start[k]) / straight : (k == 0 ? 1.0 : 0.0));
      mirror2 += mirror[k] * mirror[k];
    }
    const double radius = std::pow(random_.uniform(), 1.0 / static_cast<double>(n));
    const double scale = radius / std::sqrt(std::max(norm2, 1e-300));
    for (std::size_t k = 0; k < n; ++k) {
      q[k] *= scale * (k == 0 ? 0.5 * max : wide);
      along += mirror[k] * q[k];
    }
    const double push = mirror2 > 0 ? 2 * along / mirror2 : 0;
    for (std::size_t k = 0; k < n; ++k) {
      q[k] += 0.5 * (problem_.start[k] + goal[k]) - push * mirror[k];
    }
  }
  OmplBudget& budget() const { return space_of_arm_.budget(); }

  const SearchProblem& problem_;
  const ArmSpace& space_of_arm_;
  ob::StateSamplerPtr whole_;
  Rng random_;
};

}  // namespace

OmplBudget::OmplBudget(const PlanOptions& options, bool improves)
    : deadline_(options.stop, 1e6 * kTimeShare * options.time_budget),
      limit_({}, 1e6 * options.time_limit),
      timed_(options.time_budget > 0),
      max_(options.samples > 0 ? options.samples
           : improves          ? kMaxWhereImproved
                               : kMaxDraws),
      more_(options.samples > 0 ? options.samples : kMoreDraws),
      watch_(options, max_) {}

void OmplBudget::found() {
  if (std::exchange(found_, true)) return;
  more_ += counts_.samples;
  steps_ = 0;
}

bool OmplBudget::spent() {
  ++steps_;
  if (deadline_.passed() || (!found_ && limit_.passed())) return true;
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  if (!found_ && watch_.is_hopeless(counts_.samples, kUnknown)) return true;
  if (found_ && timed_) return false;
  const int draws = found_ ? more_ : max_;
  return counts_.samples >= draws || steps_ >= kStepsOfDraw * draws;
}

std::span<double> joints_of(ob::State* state, std::size_t dof) {
  return {state->as<ob::RealVectorStateSpace::StateType>()->values, dof};
}

std::span<const double> joints_of(const ob::State* state, std::size_t dof) {
  return {state->as<ob::RealVectorStateSpace::StateType>()->values, dof};
}

ArmSpace::ArmSpace(const SearchProblem& problem, OmplBudget& budget, std::uint64_t seed)
    : RealVectorStateSpace(static_cast<unsigned int>(problem.start.size())),
      budget_(budget),
      seed_(seed) {
  const JointLimits& limits = problem.checker.robot().arm().limits;
  ob::RealVectorBounds bounds(getDimension());
  for (std::size_t k = 0; k < problem.start.size(); ++k) {
    const auto joint = static_cast<Eigen::Index>(k);
    double low = std::max(limits.lower[joint], -kEndlessJoint);
    double high = std::min(limits.upper[joint], kEndlessJoint);
    low = std::min(low, problem.start[k]);
    high = std::max(high, problem.start[k]);
    for (const std::span<const double> goal : problem.goals) {
      low = std::min(low, goal[k]);
      high = std::max(high, goal[k]);
    }
    bounds.low[k] = low;
    bounds.high[k] = high;
  }
  setBounds(bounds);
}

ob::StateSamplerPtr ArmSpace::allocDefaultStateSampler() const {
  return std::make_shared<ArmSampler>(*this);
}

bool FreeStates::isValid(const ob::State* state) const {
  return checker_.is_free(joints_of(state, si_->getStateDimension()));
}

EdgeResult ProvedMotions::look(const ob::State* from, const ob::State* to) const {
  budget_.look();
  const std::size_t dof = si_->getStateDimension();
  return prover_.look(joints_of(from, dof), joints_of(to, dof));
}

bool ProvedMotions::checkMotion(const ob::State* from, const ob::State* to) const {
  return look(from, to).verdict == EdgeVerdict::free;
}

bool ProvedMotions::checkMotion(const ob::State* from, const ob::State* to,
                                std::pair<ob::State*, double>& last) const {
  const EdgeResult found = look(from, to);
  if (found.verdict == EdgeVerdict::free) return true;
  const std::size_t dof = si_->getStateDimension();
  std::array<double, kMaxDof> row;
  const std::span<double> end(row.data(), dof);
  last.second = kProvedPart * found.t;
  between(joints_of(from, dof), joints_of(to, dof), last.second, end);
  if (!prover_.is_free(joints_of(from, dof), end)) {
    last.second = 0;
    std::ranges::copy(joints_of(from, dof), end.begin());
  }
  if (last.first != nullptr) std::ranges::copy(end, joints_of(last.first, dof).begin());
  return false;
}

ob::InformedSamplerPtr ArmLength::allocInformedStateSampler(
    const ob::ProblemDefinitionPtr& definition, unsigned int max_calls) const {
  return std::make_shared<EllipsoidSampler>(definition, max_calls, problem_);
}

}  // namespace mjarm::detail
#endif  // MJARM_OMPL
