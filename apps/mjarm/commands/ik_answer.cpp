#include "apps/mjarm/commands/ik_answer.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "apps/mjarm/messages/app.hpp"
#include "mjarm/collision/exact.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/kinematics.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/kinematics/ik_all.hpp"
#include "mjarm/kinematics/posture.hpp"
#include "mjarm/path/clearance.hpp"

namespace mjarm::app {
namespace {

constexpr int kMaxWeighed = 64;  // answers whose postures are compared

/// Why a request has no answer.
struct NoAnswer {
  std::string reason;
  std::string why;
  JointVec best;
  std::optional<ContactPoint> contact = {};
};

using Chosen = Result<IkSolution, NoAnswer>;

void append_branch(JsonWriter& json, const Branch& branch) {
  for (int part = 0; part < Branch::kParts; ++part) {
    const int way = branch.way[static_cast<std::size_t>(part)];
    if (way < 0) continue;
    json.member(branch_parts()[static_cast<std::size_t>(part)],
                branch_ways(part)[static_cast<std::size_t>(way)]);
  }
}

void append_contact(JsonWriter& json, const ContactPoint& contact) {
  json.key("pair").list().value(contact.pair.geom1).value(contact.pair.geom2).end_list();
  json.member("depth", contact.depth);
}

void append_solution(JsonWriter& json, const IkSolution& solution) {
  json.member("q", solution.q)
      .member("pos_err", solution.pos_err)
      .member("rot_err", solution.rot_err);
}

void append_failure(JsonWriter& json, const NoAnswer& no) {
  json.member("reason", no.reason).member("detail", no.why).member("best", no.best);
  if (no.contact) append_contact(json, *no.contact);
}

NoAnswer other_branches(const IkSolver& ik, const Branch& wanted,
                        const std::vector<IkSolution>& answers) {
  std::set<std::string> words;
  for (const IkSolution& answer : answers) {
    words.insert(describe(branch_of(ik, as_span(answer.q))));
  }
  std::string listed;
  for (const std::string& word : words)
    listed += (listed.empty() ? "" : text(msg::core_semicolon)) + word;
  return {"no_branch", text(msg::kinematics_branch_missing, describe(wanted), listed),
          answers.front().q};
}

}  // namespace

/// What one thread computes with.
class IkDesk::Worker {
 public:
  Worker(const Robot& robot, const IkJob& of) : job_(of), ik_(robot.arm, of.ik) {
    if (!job_.contact) return;
    checker_.emplace(robot.model, robot.arm);
    clearance_ = clearance_check(*checker_);
    IkOptions options = job_.ik;
    options.valid = checker_->predicate();
    ik_ = IkSolver(robot.arm, std::move(options));
  }

  /// The deepest contact at `q`.
  std::optional<ContactPoint> contact(const JointVec& q) {
    if (!checker_) return std::nullopt;
    const Result<CollisionReport> report = checker_->check(as_span(q));
    if (!report || report->free) return std::nullopt;
    return report->contacts.front();
  }

  NoAnswer no_answer(const IkFailure& failure) {
    NoAnswer out{std::string(name(failure.code)), describe(failure, ik_.arm()), failure.best.q};
    if (failure.code != IkErrc::collision) return out;
    out.contact = contact(failure.best.q);
    if (out.contact) {
      const GeomPair& pair = out.contact->pair;
      out.why = text(msg::app_ik_all_touch, pair.geom1, pair.geom2, 1e3 * out.contact->depth);
      if (job_.single) out.why = text(msg::app_ik_contact_aside, out.why);
    }
    return out;
  }

  Chosen choose(const IkRequest& request) {
    const Chosen answer = choose_branch(request);
    if (!answer || !job_.prefer) return answer;
    const SelfMotionOptions self_motion{.goal = *job_.prefer, .posture = joint_vec(request.q_seed)};
    return null_space_step(ik_, request.X_WT, as_span(answer->q), self_motion).value_or(*answer);
  }

 private:
  Chosen choose_branch(const IkRequest& request) {
    const bool free = job_.single && !request.has_seed && !job_.prefer;
    if (!free && job_.branch.empty()) {
      Result<IkSolution, IkFailure> answer = ik_.solve(request.X_WT, request.q_seed);
      if (!answer) return tl::unexpected(no_answer(answer.error()));
      return *answer;
    }
    auto answers = solve_all(ik_, request.X_WT, request.q_seed);
    if (!answers) return tl::unexpected(no_answer(answers.error()));
    std::vector<IkSolution> right = of_branch(*answers);
    if (right.empty()) return tl::unexpected(not_that_branch(request, *answers));
    return free ? best_posture(request, right) : right.front();
  }

  std::vector<IkSolution> of_branch(const std::vector<IkSolution>& answers) const {
    std::vector<IkSolution> out;
    std::ranges::copy_if(answers, std::back_inserter(out), [&](const IkSolution& answer) {
      return job_.branch.empty() || job_.branch.allows(branch_of(ik_, as_span(answer.q)));
    });
    return out;
  }

  /// The answers in the branch that was asked for touch something, or there are none.
  NoAnswer not_that_branch(const IkRequest& request, const std::vector<IkSolution>& others) {
    const IkSolver geometry = ik_.with(job_.ik);
    const auto all = solve_all(geometry, request.X_WT, request.q_seed);
    const std::vector<IkSolution> right = all ? of_branch(*all) : std::vector<IkSolution>();
    if (right.empty()) return other_branches(ik_, job_.branch, others);
    return no_answer({.code = IkErrc::collision, .best = right.front()});
  }

  IkSolution best_posture(const IkRequest& request, std::vector<IkSolution>& answers) {
    if (answers.size() > kMaxWeighed) answers.resize(kMaxWeighed);
    std::vector<JointVec> sorted;
    for (const IkSolution& answer : answers) sorted.push_back(answer.q);
    ClearanceMeasure distance;
    if (clearance_) distance = [&](std::span<const double> q) { return clearance_(q).distance; };
    sort_by_posture(PostureCost(ik_), sorted, request.q_seed, distance);
    return *std::ranges::find(answers, sorted.front(), &IkSolution::q);
  }

  const IkJob& job_;
  IkSolver ik_;  // without contact, where that is looked at
  std::optional<ExactChecker> checker_;
  ClearanceCheck clearance_;
};

IkDesk::IkDesk(const Robot& robot, IkJob job)
    : robot_(robot), job_(std::move(job)), geometry_(robot.arm, job_.ik) {}

IkDesk::~IkDesk() = default;

IkDesk::WorkerPtr IkDesk::take() {
  const std::lock_guard lock(mutex_);
  if (idle_.empty()) return std::make_unique<Worker>(robot_, job_);
  WorkerPtr worker = std::move(idle_.back());
  idle_.pop_back();
  return worker;
}

void IkDesk::put_back(WorkerPtr worker) {
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(worker));
}

/// Which way each of the `branches` is bent and, where that counts, what it touches.
void IkDesk::append_states(Worker& worker, const std::vector<JointVec>& branches,
                           JsonWriter& json) const {
  json.key("states").list();
  for (const JointVec& q : branches) {
    json.object();
    append_branch(json, branch_of(geometry_, as_span(q)));
    if (job_.contact) {
      const std::optional<ContactPoint> contact = worker.contact(q);
      json.member("free", !contact.has_value());
      if (contact) append_contact(json, *contact);
    }
    json.end_object();
  }
  json.end_list();
}

std::optional<std::string> IkDesk::answer(const IkRequest& request, std::string& out) {
  WorkerPtr worker = take();
  const Stopwatch watch;
  const Chosen chosen = worker->choose(request);
  std::vector<JointVec> branches;
  if (job_.all && (chosen || chosen.error().contact)) {
    const IkAllOptions all{.windings = job_.windings};
    const auto found = solve_all(geometry_, request.X_WT, request.q_seed, all);
    for (std::size_t i = 0; found && i < found->size(); ++i) branches.push_back((*found)[i].q);
  }
  const double us = watch.us();
  JsonWriter json(out);
  json.object().member("ok", chosen.has_value());
  if (chosen) {
    append_solution(json, *chosen);
    if (job_.single || !job_.branch.empty()) {
      json.key("branch").object();
      append_branch(json, branch_of(geometry_, as_span(chosen->q)));
      json.end_object();
    }
  } else {
    append_failure(json, chosen.error());
  }
  if (job_.all) json.member("branches", branches);
  if (job_.all && (job_.single || job_.contact)) append_states(*worker, branches, json);
  if (job_.timing) json.member_us("us", us);
  json.end_object();
  put_back(std::move(worker));
  if (chosen) return std::nullopt;
  return chosen.error().why;
}

}  // namespace mjarm::app
