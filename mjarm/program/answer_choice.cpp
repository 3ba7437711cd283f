#include <algorithm>
#include <set>
#include <utility>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/kinematics.hpp"
#include "mjarm/kinematics/branch.hpp"
#include "mjarm/kinematics/ik_all.hpp"
#include "mjarm/program/answer_choice_internal.hpp"

namespace mjarm::program::detail {
namespace {

constexpr int kMaxLookedAt = 64;       // answers to one pose
constexpr double kClearlyWorse = 0.2;  // of PostureCost

ClearanceMeasure distance_by(const ClearanceCheck& clearance) {
  if (!clearance) return {};
  return [clearance](std::span<const double> q) { return clearance(q).distance; };
}

}  // namespace

AnswerChoice::AnswerChoice(const IkSolver& ik, const ClearanceCheck& clearance)
    : ik_(ik), cost_(ik), clearance_(distance_by(clearance)) {}

Result<Answers, NoAnswer> AnswerChoice::to(const Step& step, const Pose& X_WT,
                                           const JointVec& q) const {
  const auto found = solve_all(ik_, X_WT, as_span(q), {.max = kMaxLookedAt});
  if (!found) {
    const IkFailure& why = found.error();
    return tl::unexpected(NoAnswer{std::string(name(why.code)), describe(why, ik_.arm())});
  }
  std::vector<JointVec> answers;
  for (const IkSolution& answer : *found) answers.push_back(answer.q);
  return among(step, std::move(answers), q);
}

Result<Answers, NoAnswer> AnswerChoice::goals(const Step& step, const DetourPlanner& planner,
                                              const JointVec& q) const {
  const bool joints = step.q.size() > 0;
  auto found = joints ? planner.goals(q, step.q) : planner.goals(q, step.X_WT);
  if (!found) return tl::unexpected(NoAnswer{found.error().reason, found.error().what});
  if (joints) return Answers{std::move(*found), 1};
  return among(step, std::move(*found), q);
}

Result<Answers, NoAnswer> AnswerChoice::among(const Step& step, std::vector<JointVec> answers,
                                              const JointVec& q) const {
  if (!step.branch.empty()) {
    std::set<std::string> others;
    std::erase_if(answers, [&](const JointVec& answer) {
      const Branch branch = branch_of(ik_, as_span(answer));
      if (step.branch.allows(branch)) return false;
      others.insert(describe(branch));
      return true;
    });
    if (answers.empty()) {
      std::string listed;
      for (const std::string& other : others)
        listed += (listed.empty() ? "" : text(msg::core_semicolon)) + other;
      return tl::unexpected(NoAnswer{
          "no_branch", text(msg::kinematics_branch_missing, describe(step.branch), listed)});
    }
  }
  Answers out{std::move(answers), 0};
  out.good = out.q.size();
  if (!step.is_free) return out;
  const std::vector<double> costs = sort_by_posture(cost_, out.q, as_span(q), clearance_);
  const auto worse = std::ranges::upper_bound(costs, costs.front() + kClearlyWorse);
  out.good = static_cast<std::size_t>(worse - costs.begin());
  return out;
}

}  // namespace mjarm::program::detail
