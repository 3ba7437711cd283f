#include <cmath>
#include <functional>
#include <numbers>

#include "apps/mjarm/learn/learn_test.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;
using std::numbers::pi;

class LearnPoses : public testing::LearnTest {
 protected:
  support::ProgramResult moving(const std::vector<double>& q, const Eigen::Vector3d& p) {
    const json object = {{"q", q}, {"pos", {p.x(), p.y(), p.z()}}};
    return check_text("3", "moving.json", object.dump());
  }
};

TEST_F(LearnPoses, Page3ComparesJointValuesAndPlace) {
  const auto robot = load_robot("ur5e");
  ASSERT_TRUE(robot) << robot.error().what;
  const Arm& arm = robot->arm;
  std::vector<double> q(arm.home.begin(), arm.home.end()), before = q;
  const Eigen::Vector3d home = fk(arm, q).p;
  expect_wrong(moving(q, home), "home posture");
  for (std::size_t i = 0; i < q.size(); ++i) {
    q[i] += 0.1234567891 + 0.1 * static_cast<double>(i);
    before[i] = q[i] - 0.001;
  }
  expect_right(moving(q, fk(arm, q).p), "belong together");
  expect_wrong(moving(q, fk(arm, before).p), "of the step before");
  expect_wrong(moving(q, home), "that of the home posture");
  expect_wrong(moving(q, home + Eigen::Vector3d(0.3, 0, 0)), "other joint values");
  Eigen::Vector3d rounded = 1e3 * fk(arm, q).p;
  for (double& value : rounded) value = 1e-3 * std::round(value);
  expect_wrong(moving(q, rounded), "too few digits");
}

class LearnTurn : public testing::LearnTest {
 protected:
  /// Checks the way q(t) in 10 steps.
  support::ProgramResult turn(const std::function<Quat(double)>& way, int rows = 11) {
    std::string lines;
    for (int i = 0; i < rows; ++i) {
      const Quat q = way(static_cast<double>(i) / (rows - 1));
      lines += json{{"quat", {q.w(), q.x(), q.y(), q.z()}}}.dump() + '\n';
    }
    return check_text("4", "turn.jsonl", lines);
  }
  /// The four numbers in a straight line.
  [[nodiscard]] Quat between(double t) const {
    const Quat end = begin_.dot(end_) < 0 ? Quat(-end_.coeffs()) : end_;
    return Quat(begin_.coeffs() + t * (end.coeffs() - begin_.coeffs()));
  }
  /// The way on which the quaternions begin on opposite halves.
  [[nodiscard]] Quat long_way(double t) const {
    const Quat end = begin_.dot(end_) > 0 ? Quat(-end_.coeffs()) : end_;
    const double angle = std::acos(begin_.dot(end));
    return Quat((std::sin((1 - t) * angle) * begin_.coeffs() + std::sin(t * angle) * end.coeffs()) /
                std::sin(angle));
  }

  const Quat begin_ = to_quat(from_euler({pi, 0, 0}));
  const Quat end_ = to_quat(from_euler({pi, pi / 3, pi / 2}));
};

TEST_F(LearnTurn, Page4KnowsSlerp) {
  const auto result = turn([&](double t) { return slerp(begin_, end_, t); });
  expect_right(result, "the shortest way, 104.48 deg");
  // The sign of a quaternion does not matter.
  expect_right(turn([&](double t) {
    const Quat q = slerp(begin_, end_, t);
    return t > 0.25 && t < 0.65 ? Quat(-q.coeffs()) : q;
  }));
}

TEST_F(LearnTurn, Page4KnowsWhatWentWrong) {
  expect_wrong(turn([&](double t) { return between(t); }), "line 2 is no unit quaternion");
  const auto nlerp = turn([&](double t) { return between(t).normalized(); });
  expect_wrong(nlerp, "uneven pace");
  EXPECT_NE(nlerp.out.find("(nlerp)"), std::string::npos) << nlerp.out;
  const auto round = turn([&](double t) { return long_way(t); });
  expect_wrong(round, "your way is 255.52 deg, the shortest is 104.48 deg");
  EXPECT_NE(round.out.find("flip the sign"), std::string::npos) << round.out;
  const auto euler =
      turn([&](double t) { return to_quat(from_euler({pi, t * pi / 3, t * pi / 2})); });
  expect_wrong(euler, "the shortest is 104.48 deg");
  EXPECT_NE(euler.out.find("three Euler angles"), std::string::npos) << euler.out;
  expect_wrong(turn([&](double t) {
                 const Quat q = slerp(begin_, end_, t);
                 return Quat(q.x(), q.y(), q.z(), q.w());
               }),
               "w last");
  expect_wrong(turn([&](double t) { return slerp(begin_, end_, t); }, 10),
               "10 lines instead of 11");
  expect_wrong(turn([&](double t) { return slerp(end_, begin_, t); }), "exchanged");
  expect_wrong(turn([&](double t) { return slerp(begin_, end_, 0.9 * t); }), "other ends");
  const Quat moving = to_quat(rotation_exp({pi, 0, 0}) * rotation_exp({0, pi / 3, 0}) *
                              rotation_exp({0, 0, pi / 2}));
  expect_wrong(turn([&](double t) { return slerp(begin_, moving, t); }), "moving axes");
}

class LearnAnswers : public testing::LearnTest {
 protected:
  void SetUp() override {
    const auto robot = load_robot("panda");
    ASSERT_TRUE(robot) << robot.error().what;
    arm_ = robot->arm;
    Rng rng(3);
    for (int i = 0; i < 6; ++i) {
      JointVec q = arm_.home;
      for (int j = 0; j < q.size(); ++j) {
        q[j] = rng.uniform(arm_.limits.lower[j], arm_.limits.upper[j]);
      }
      lines_.push_back(line(fk(arm_, as_span(q)), q));
    }
  }
  static json line(const Pose& X, const JointVec& q) {
    const Quat quat = to_quat(X.R);
    return {{"pos", {X.p.x(), X.p.y(), X.p.z()}},
            {"quat", {quat.w(), quat.x(), quat.y(), quat.z()}},
            {"q", std::vector<double>(q.begin(), q.end())}};
  }
  support::ProgramResult answers() {
    std::string text;
    for (const json& line : lines_) text += line.dump() + '\n';
    return check_text("5", "answers.jsonl", text);
  }

  Arm arm_;
  std::vector<json> lines_;
};

TEST_F(LearnAnswers, Page5CountsWhatIsRight) {
  expect_right(answers(), "6 of 6 answers are right");
  // Nobody can get there: that is not held against the reader.
  lines_.push_back({{"pos", {3, 0, 0}}, {"quat", {1, 0, 0, 0}}, {"q", nullptr}});
  expect_right(answers(), "the first is line 7: out of reach");
}

TEST_F(LearnAnswers, Page5KnowsWhatIsWrong) {
  const std::vector<json> good = lines_;
  lines_[2]["q"] = nullptr;
  expect_wrong(answers(), "not found, though IkSolver finds one: 1, the first is line 3");
  lines_ = good;
  lines_[1]["q"][2] = lines_[1]["q"][2].get<double>() + 2 * pi;
  expect_wrong(answers(), "beyond a limit: 1; the worst is joint3");
  lines_ = good;
  lines_[4]["pos"][0] = lines_[4]["pos"][0].get<double>() + 1e-3;
  expect_wrong(answers(), "the worst is line 5, by 1 mm");
}

}  // namespace
}  // namespace mjarm::app
