#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "apps/mjarm/learn/exercise.hpp"
#include "apps/mjarm/messages/learn.hpp"
#include "mjarm/core/line_reader.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"

namespace mjarm::app {
namespace {

constexpr std::size_t kAskedAnswers = 100;
constexpr std::size_t kMaxAnswers = 10000;
constexpr std::size_t kAnswerLine = 16384;  // [bytes]
constexpr double kAnswerPlace = 1e-5;       // [m]
constexpr double kAnswerTurn = 1e-5;        // [rad]
constexpr double kAnswerSlack = 1e-5;       // [rad or m] beyond a limit

struct IkAnswer {
  Pose goal;
  std::optional<std::vector<double>> q;  ///< none: nothing was found
};

Result<std::vector<IkAnswer>> read_answers(const std::string& file, const Arm& arm) {
  std::vector<IkAnswer> out;
  const auto take = [&](const JsonValue& object) -> Result<void> {
    if (out.size() >= kMaxAnswers) {
      return fail(Errc::bad_input, text(msg::learn_too_many_lines, kMaxAnswers));
    }
    Result<Pose> goal = pose_of(object);
    if (!goal) return fail(std::move(goal.error()));
    IkAnswer answer{*goal, std::nullopt};
    const JsonValue* const q = object.find("q");
    if (q == nullptr || !q->is_null()) {
      Result<std::vector<double>> values =
          number_list(object, "q", static_cast<std::size_t>(arm.dof()));
      if (!values) return fail(std::move(values.error()));
      answer.q = std::move(*values);
    }
    out.push_back(std::move(answer));
    return {};
  };
  if (Result<void> read = read_json_lines(file, kAnswerLine, take); !read) {
    return fail(read.error());
  }
  if (out.empty()) return fail(Errc::bad_input, text(msg::learn_answers_none, file));
  return out;
}

/// The answers of one kind, and the worst of them.
struct Tally {
  std::size_t count = 0, line = 0;  // lines count from 1
  double worst = -1, place = 0, turn = 0;
  std::string joint = {};

  /// @return true where this is the worst so far.
  bool add(std::size_t at, double badness) {
    ++count;
    if (!(badness > worst)) return false;
    worst = badness;
    line = at;
    return true;
  }
};

struct AnswerCounts {
  std::size_t right = 0;
  Tally off, beyond;
  std::size_t missed = 0, first_missed = 0, unreachable = 0, first_unreachable = 0;
  std::string why;  ///< of the first that cannot be reached
};

/// How far a joint is beyond its limits; no more than 0 where none is.
struct Excess {
  double amount = 0;
  int joint = -1;
};
Excess largest_excess(const Arm& arm, const std::vector<double>& q) {
  Excess out;
  for (int i = 0; i < arm.dof(); ++i) {
    const double value = q[static_cast<std::size_t>(i)];
    const double amount = std::max(arm.limits.lower[i] - value, value - arm.limits.upper[i]);
    if (amount > out.amount) out = {amount, i};
  }
  return out;
}

void count_answer(const Arm& arm, const IkAnswer& answer, std::size_t line, AnswerCounts& counts) {
  const Pose X = fk(arm, *answer.q);
  const double place = (X.p - answer.goal.p).norm(), turn = angle_between(X.R, answer.goal.R);
  const Excess excess = largest_excess(arm, *answer.q);
  const bool off = !(place < kAnswerPlace && turn < kAnswerTurn);
  if (off && counts.off.add(line, place + turn)) {
    counts.off.place = place;
    counts.off.turn = turn;
  }
  const bool beyond = excess.amount > kAnswerSlack;
  if (beyond && counts.beyond.add(line, excess.amount)) {
    counts.beyond.joint = arm.joints[static_cast<std::size_t>(excess.joint)].name;
  }
  counts.right += !off && !beyond;
}

void count_missing(const IkSolver& ik, const IkAnswer& answer, std::size_t line,
                   AnswerCounts& counts) {
  const auto found = ik.solve(answer.goal, as_span(ik.arm().home));
  if (found) {
    if (counts.missed++ == 0) counts.first_missed = line;
  } else if (counts.unreachable++ == 0) {
    counts.first_unreachable = line;
    counts.why = describe(found.error(), ik.arm());
  }
}

LearnReport tell_counts(const AnswerCounts& counts, std::size_t lines) {
  LearnReport out;
  const std::string right = text(msg::learn_answers_right, counts.right, lines);
  const bool all = counts.right + counts.unreachable == lines;
  all ? out.right(right) : out.note(right);
  if (counts.off.count > 0) {
    out.wrong(text(msg::learn_answers_off, counts.off.count, counts.off.line,
                   1e3 * counts.off.place, counts.off.turn));
  }
  if (counts.beyond.count > 0) {
    out.wrong(text(msg::learn_answers_beyond, counts.beyond.count, counts.beyond.joint,
                   counts.beyond.worst, counts.beyond.line));
  }
  if (counts.missed > 0) {
    out.wrong(text(msg::learn_answers_missed, counts.missed, counts.first_missed));
  }
  if (counts.unreachable > 0) {
    out.note(text(msg::learn_answers_unreachable, counts.unreachable, counts.first_unreachable,
                  counts.why));
  }
  if (lines < kAskedAnswers) out.note(text(msg::learn_answers_few, lines, kAskedAnswers));
  return out;
}

}  // namespace

Result<LearnReport> check_ik_answers(const Exercise& exercise) {
  const Result<Robot> robot = robot_of(exercise, "panda");
  if (!robot) return fail(robot.error());
  const Result<std::vector<IkAnswer>> answers = read_answers(exercise.file, robot->arm);
  if (!answers) return fail(answers.error());
  const IkSolver ik(robot->arm);
  AnswerCounts counts;
  for (std::size_t i = 0; i < answers->size(); ++i) {
    const IkAnswer& answer = (*answers)[i];
    if (answer.q) {
      count_answer(robot->arm, answer, i + 1, counts);
    } else {
      count_missing(ik, answer, i + 1, counts);
    }
  }
  return tell_counts(counts, answers->size());
}

}  // namespace mjarm::app
