// What the program says, for the module of the page to say the same: writes one JSON list of arms,
// of each its data and questions with their answers.
//
//     ik_module_cases FILE
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik_all.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/path/tool_target.hpp"
#include "mjarm/session/arm_json.hpp"
#include "mjarm/sim/body_poses.hpp"

namespace mjarm {
namespace {

constexpr int kPoses = 300;
constexpr int kDrags = 300;
constexpr int kWay = 20;  ///< places on a way that a target is dragged

using Pose7 = std::vector<double>;

Pose7 pose7(const Pose& X) {
  const Quat q = to_quat(X.R);
  return {X.p.x(), X.p.y(), X.p.z(), q.w(), q.x(), q.y(), q.z()};
}

/// The pose as the module gets it.
Pose rounded(const Pose& X) {
  const Pose7 v = pose7(X);
  return {X.p, to_matrix(Quat(v[3], v[4], v[5], v[6]))};
}

void write(JsonWriter& json, const IkSolution& answer) {
  json.object().member("q", answer.q).member("posErr", answer.pos_err);
  json.member("rotErr", answer.rot_err).end_object();
}

void write(JsonWriter& json, const IkFailure& failure, const Arm& arm) {
  json.object().member("reason", name(failure.code)).member("amount", failure.amount);
  json.member("bound", failure.bound).member("joint", failure.joint);
  json.member("text", describe(failure, arm)).key("best");
  write(json, failure.best);
  json.end_object();
}

/// Questions to one arm.
class Cases {
 public:
  Cases(const Arm& arm, JsonWriter& json) : arm_(arm), json_(json), rng_(7) {}

  void write_all() {
    const IkSolver ik(arm_, {.task = task_for(arm_)});
    // With six joints no answer goes over into another.
    json_.member("alone", arm_.dof() == 6);
    json_.member("closed", ik.six_axis() || ik.seven_axis());
    json_.key("fk").list();
    for (int i = 0; i < kPoses / 3; ++i) write_fk();
    json_.end_list().key("solve").list();
    for (int i = 0; i < kPoses; ++i) write_solve(ik, i);
    json_.end_list().key("solveAll").list();
    for (int i = 0; i < kPoses / 3; ++i) write_solve_all(ik, i);
    json_.end_list().key("drags").list();
    write_drags();
    json_.end_list();
  }

 private:
  /// In turns: reached, anywhere, out of reach, near a singularity, at one.
  Pose pose(int i) {
    JointVec q = testing::random_q(arm_, rng_);
    const int kind = i % 5;
    if (kind >= 3) {
      // Many arms are singular where a joint is 0; a step of 1e-3 to 1e-9 beside it.
      const int joint = static_cast<int>(rng_.below(static_cast<std::uint64_t>(arm_.dof())));
      q[joint] = kind == 4 ? 0 : std::pow(10, rng_.uniform(-9, -3));
      q = clamp_to_limits(arm_, as_span(q));
    }
    Pose X = fk(arm_, as_span(q));
    if (kind == 1) {
      for (int k = 0; k < 3; ++k) X.p[k] = rng_.uniform(-1, 1);
      X.R = rotation_exp({rng_.uniform(-2, 2), rng_.uniform(-2, 2), rng_.uniform(-2, 2)});
    }
    if (kind == 2) X.p *= rng_.uniform(1.2, 3);
    return rounded(X);
  }

  void write_fk() {
    const JointVec q = testing::random_q(arm_, rng_);
    std::array<Pose, kMaxDof> X_WJ;
    const Pose X_WT = fk_all(arm_, as_span(q), X_WJ);
    json_.line_break().object().member("q", q).member("tool", pose7(X_WT)).key("joints").list();
    for (int i = 0; i < arm_.dof(); ++i) json_.value(pose7(X_WJ[static_cast<std::size_t>(i)]));
    json_.end_list().end_object();
  }

  /// How much a rounding error counts: the smallest singular value at `q`.
  void write_smallest(const JointVec& q) {
    json_.member("smallest", smallest_singular_value(fk_jacobian(arm_, as_span(q)).J_W));
  }

  void ask(const Pose& X_WT, const JointVec& seed) {
    json_.line_break().object().member("pose", pose7(X_WT)).member("seed", seed);
  }

  void write_solve(const IkSolver& ik, int i) {
    const Pose X_WT = pose(i);
    const JointVec seed = testing::random_q(arm_, rng_);
    ask(X_WT, seed);
    const auto answer = ik.solve(X_WT, as_span(seed));
    write_smallest(answer ? answer->q : answer.error().best.q);
    if (answer) {
      json_.key("answer");
      write(json_, *answer);
    } else {
      json_.key("failure");
      write(json_, answer.error(), arm_);
    }
    json_.end_object();
  }

  void write_solve_all(const IkSolver& ik, int i) {
    const Pose X_WT = pose(i);
    const JointVec seed = testing::random_q(arm_, rng_);
    ask(X_WT, seed);
    const auto answers = solve_all(ik, X_WT, as_span(seed), {.max = 256});
    double smallest = 1;
    if (answers) {
      for (const IkSolution& answer : *answers) {
        const Jacobian J_W = fk_jacobian(arm_, as_span(answer.q)).J_W;
        smallest = std::min(smallest, smallest_singular_value(J_W));
      }
    }
    json_.member("smallest", smallest).key("answers").list();
    if (answers) {
      for (const IkSolution& answer : *answers) write(json_, answer);
    }
    json_.end_list().end_object();
  }

  /// A target on its ways from places to others, some of them out of reach.
  void write_drags() {
    ToolTarget target(arm_);
    Pose X_WT, X_next;
    for (int i = 0; i < kDrags; ++i) {
      json_.line_break().object();
      if (i % kWay == 0) {
        const JointVec q = testing::random_q(arm_, rng_);
        json_.member("start", q);
        target.set_goal(q);
        X_WT = target.pose();
        X_next = pose(i / kWay);
      }
      const Pose X = rounded(interpolate(X_WT, X_next, (i % kWay + 1.0) / kWay));
      target.move_to(X);
      if (target.jump() && i % 2 == 0) target.take_jump();
      json_.member("pose", pose7(X)).member("goal", target.goal());
      json_.member("takesJump", i % 2 == 0).member("grade", static_cast<int>(target.grade()));
      json_.member("room", target.room()).member("tightest", target.tightest());
      json_.member("smallest", target.singular().smallest);
      json_.member("singular", name(target.singular().kind)).member("text", target.line());
      if (target.failure()) {
        json_.key("failure");
        write(json_, *target.failure(), arm_);
      }
      if (target.jump()) json_.member("jump", *target.jump());
      json_.end_object();
    }
  }

  const Arm& arm_;
  JsonWriter& json_;
  Rng rng_;
};

void add_arm(std::string& out, const std::string& arm_data, const Arm& arm, const Model* model) {
  JsonWriter json(out);
  json.object().key("arm");
  out += arm_data;
  Cases(arm, json).write_all();
  if (model != nullptr) {
    BodyPoses poses(*model);
    JointVec q(arm.dof());
    for (int i = 0; i < arm.dof(); ++i) {
      q[i] = poses.qpos()[static_cast<std::size_t>(arm.joints[static_cast<std::size_t>(i)].qpos)];
    }
    json.member("bodiesAt", q).key("bodies").list();
    for (int body = 0; body < poses.size(); ++body) json.value(pose7(poses.pose(body)));
    json.end_list();
  }
  json.end_object();
}

bool write_file(const char* file) {
  std::string out = "[";
  JsonWriter json(out);
  for (const char* name : {"ur5e", "panda"}) {
    auto robot = load_robot(name);
    if (!robot) {
      std::fprintf(stderr, "%s\n", robot.error().what.c_str());
      return false;
    }
    add_arm(out, session::arm_json(robot->model, robot->arm), robot->arm, &robot->model);
  }
  Rng rng(11);
  for (const int dof : {6, 7, 4}) {  // without a closed form; four joints take positions alone
    const Arm arm = testing::random_arm(dof, rng);
    add_arm(out, session::arm_json(arm), arm, nullptr);
  }
  json.end_list();
  return static_cast<bool>(std::ofstream(file) << out);
}

}  // namespace
}  // namespace mjarm

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: ik_module_cases FILE\n", stderr);
    return 2;
  }
  return mjarm::write_file(argv[1]) ? 0 : 1;
}
