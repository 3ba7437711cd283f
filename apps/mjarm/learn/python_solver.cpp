#include "apps/mjarm/learn/python_solver.hpp"

#include <numbers>
#include <vector>

#include "apps/mjarm/learn/python_answer.hpp"
#include "apps/mjarm/messages/learn.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"

namespace mjarm::app {
namespace {

constexpr std::size_t kReachable = 100, kBeyond = 20;
constexpr std::size_t kEnoughSolved = 60;
constexpr double kSolvedPlace = 1e-4, kSolvedTurn = 1e-4;  // [m], [rad]

Pose random_reachable(const Arm& arm, Rng& rng) {
  JointVec q = arm.home;
  for (int i = 0; i < arm.dof(); ++i) q[i] = rng.uniform(arm.limits.lower[i], arm.limits.upper[i]);
  return fk(arm, as_span(q));
}

/// So far out that it is proved out of reach.
Pose random_beyond(const IkSolver& ik, Rng& rng) {
  for (;;) {
    const double turn = rng.uniform(-std::numbers::pi, std::numbers::pi);
    const double distance = rng.uniform(1.1, 1.6), height = rng.uniform(0, 0.8);
    const Pose X{{distance * std::cos(turn), distance * std::sin(turn), height},
                 random_reachable(ik.arm(), rng).R};
    const auto answer = ik.solve(X, as_span(ik.arm().home));
    if (!answer && answer.error().code == IkErrc::out_of_reach) return X;
  }
}

std::string pose_line(const Pose& X) {
  std::string line;
  JsonWriter(line).object().pose_members(X).end_object();
  return line;
}

struct SolverCounts {
  std::size_t solved = 0, refused = 0, outside = 0, ours = 0;
  std::size_t believed = 0;  ///< answers to what nobody can reach
  std::string why;           ///< the first reachable goal that was refused
};

/// The joint values of an answer; null where it is none.
const std::vector<double>* values_of(const PythonCase& answer, const Arm& arm) {
  const bool good =
      answer.rows.size() == 1 && answer.rows.front().size() == static_cast<std::size_t>(arm.dof());
  return good ? &answer.rows.front() : nullptr;
}

SolverCounts count_solved(const IkSolver& ik, const std::vector<Pose>& goals,
                          const std::vector<PythonCase>& answers) {
  SolverCounts counts;
  const Arm& arm = ik.arm();
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const PythonCase& answer = answers[i];
    const std::vector<double>* const q = values_of(answer, arm);
    if (i >= kReachable) {
      counts.refused += !answer.refused.empty();
      counts.believed += answer.refused.empty();
      continue;
    }
    counts.ours += ik.solve(goals[i], as_span(arm.home)).has_value();
    if (q == nullptr) {
      if (counts.why.empty()) counts.why = answer.refused + answer.odd;
      continue;
    }
    const Pose X = fk(arm, *q);
    const bool good =
        (X.p - goals[i].p).norm() < kSolvedPlace && angle_between(X.R, goals[i].R) < kSolvedTurn;
    counts.solved += good;
    counts.outside += good && !within_limits(arm, *q, 1e-5);
  }
  return counts;
}

}  // namespace

Result<LearnReport> check_python_solver(const Exercise& exercise) {
  const Result<Robot> robot = load_robot({.robot = "ur5e", .looks = false});
  if (!robot) return fail(robot.error());
  const IkSolver ik(robot->arm);
  Rng rng(1);
  std::vector<Pose> goals;
  for (std::size_t i = 0; i < kReachable; ++i) goals.push_back(random_reachable(robot->arm, rng));
  for (std::size_t i = 0; i < kBeyond; ++i) goals.push_back(random_beyond(ik, rng));
  PythonTask task{.function = "least_squares",
                  .robot = "ur5e",
                  .call =
                      "(lambda goal: function(goal, robot.home) if count == 2 else "
                      "function(robot, goal, robot.home))"
                      "(mjarm.Pose(case[\"pos\"], quat=case[\"quat\"]))"};
  for (const Pose& goal : goals) task.cases.push_back(pose_line(goal));
  const Result<std::vector<PythonCase>> answers = ask_python(exercise, task);
  if (!answers) return fail(answers.error());

  const SolverCounts counts = count_solved(ik, goals, *answers);
  LearnReport out;
  const std::string solved = text(msg::learn_solver_solved, counts.solved, kReachable, counts.ours);
  if (counts.solved >= kEnoughSolved) {
    out.right(solved);
  } else {
    out.wrong(solved);
    out.note(text(msg::learn_solver_more, kEnoughSolved));
  }
  if (!counts.why.empty()) out.note(text(msg::learn_solver_first_none, counts.why));
  if (counts.outside > 0) out.note(text(msg::learn_solver_outside, counts.outside));
  if (counts.believed > 0) {
    out.wrong(text(msg::learn_solver_believed, counts.believed, kBeyond));
  } else {
    out.right(text(msg::learn_solver_refused, counts.refused, kBeyond));
  }
  return out;
}

}  // namespace mjarm::app
