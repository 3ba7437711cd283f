// The kinematics of one arm for a page without a server: what web/src/arm_ik.js calls. Numbers go
// in and come out in one array, texts in one more; a pose is x y z [m] and w x y z of its
// quaternion.
#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mjarm/core/messages.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/kinematics/ik_all.hpp"
#include "mjarm/path/tool_target.hpp"

#define MJARM_EXPORT(name) extern "C" __attribute__((export_name(#name)))

namespace {

using namespace mjarm;

constexpr int kMaxAnswers = 256;  ///< of ik_all

std::array<double, kMaxAnswers*(kMaxDof + 2)> numbers_{};
std::string text_;

/// Reads numbers_ from its beginning, or fills it.
struct Cursor {
  std::size_t at = 0;

  double read() { return numbers_[at++]; }
  std::span<const double> read(int count) {
    const std::span<const double> out(&numbers_[at], static_cast<std::size_t>(count));
    at += out.size();
    return out;
  }
  Eigen::Vector3d read_vector() { return Eigen::Map<const Eigen::Vector3d>(read(3).data()); }
  /// X: position, then the columns of the rotation.
  Pose read_frame() {
    Pose X{read_vector(), {}};
    X.R = Eigen::Map<const Eigen::Matrix3d>(read(9).data());
    return X;
  }
  Pose read_pose() {
    Pose X{read_vector(), {}};
    const std::span<const double> q = read(4);
    X.R = to_matrix(Quat(q[0], q[1], q[2], q[3]));
    return X;
  }
  void write(double value) { numbers_[at++] = value; }
  void write(const JointVec& q) {
    for (const double value : q) write(value);
  }
  void write(const Pose& X) {
    const Quat q = to_quat(X.R);
    for (const double value : {X.p.x(), X.p.y(), X.p.z(), q.w(), q.x(), q.y(), q.z()}) write(value);
  }
  void write(const IkSolution& solution) {
    write(solution.q);
    write(solution.pos_err);
    write(solution.rot_err);
  }
};

/// A body of the model that joint `joint` moves.
struct Body {
  std::size_t joint = 0;
  Pose X_JB;
};

struct Parts {
  IkSolver ik;
  ToolTarget target;
  std::vector<Body> bodies = {};
};
std::optional<Parts> parts_;

/// Lines of text_.
std::vector<std::string> lines() {
  std::vector<std::string> out(1);
  for (const char c : text_) {
    if (c == '\n') {
      out.emplace_back();
    } else {
      out.back() += c;
    }
  }
  return out;
}

std::string_view grade_name(int grade) {
  constexpr std::string_view kNames[] = {"good", "near_limit", "near_singular", "jump",
                                         "unreachable"};
  return kNames[std::clamp(grade, 0, 4)];
}

/// Code, amount [m or rad], bound [m], joint (-1: none), then the best attempt.
void write(Cursor& out, const IkFailure& failure, int dof) {
  out.write(static_cast<double>(failure.code));
  out.write(failure.amount);
  out.write(failure.bound);
  out.write(failure.joint);
  IkSolution best = failure.best;
  if (best.q.size() != dof) best.q = JointVec::Zero(dof);
  out.write(best);
}

void write_state(const ToolTarget& target) {
  const int dof = target.arm().dof();
  Cursor out;
  out.write(target.pose());
  out.write(target.goal());
  out.write(static_cast<double>(target.grade()));
  out.write(target.room());
  out.write(target.tightest());
  out.write(target.singular().smallest);
  out.write(static_cast<double>(target.singular().kind));
  out.write(target.jump() ? 1 : 0);
  out.write(target.jump() ? *target.jump() : target.goal());
  out.write(target.failure() ? 1 : 0);
  write(out, target.failure().value_or(IkFailure{}), dof);
  text_ = target.line();
}

}  // namespace

/// Address of the numbers, and how many there are.
MJARM_EXPORT(numbers) double* ik_numbers() { return numbers_.data(); }
/// Address of a text of `bytes` bytes that the caller fills in; that of one that comes out.
MJARM_EXPORT(make_text) char* ik_make_text(int bytes) {
  text_.assign(static_cast<std::size_t>(bytes), '\0');
  return text_.data();
}
MJARM_EXPORT(text) const char* ik_text() { return text_.data(); }
MJARM_EXPORT(text_bytes) int ik_text_bytes() { return static_cast<int>(text_.size()); }
/// Of all texts from now on, as language_of() reads text.
MJARM_EXPORT(set_language) void ik_set_language() { set_language(language_of(text_)); }
/// The words of reasons (list 0), kinds of singularities (1) and grades of the target (2).
MJARM_EXPORT(word) void ik_word(int list, int index) {
  if (list == 0) text_ = name(static_cast<IkErrc>(index));
  if (list == 1) text_ = name(static_cast<SingularKind>(index));
  if (list == 2) text_ = grade_name(index);
}

/// In: of each joint whether it is a slide, X_PJ as a frame, its axis, both limits; X_JT as a
/// frame; the home position. Text: the name of the arm, then those of the joints, a line each.
/// @return false where there are no joints or too many.
MJARM_EXPORT(make_arm) bool ik_make_arm(int dof) {
  parts_.reset();
  if (dof < 1 || dof > kMaxDof) return false;
  std::vector<std::string> names = lines();
  names.resize(static_cast<std::size_t>(dof) + 1);
  Arm arm;
  arm.name = names[0];
  arm.limits.lower.resize(dof);
  arm.limits.upper.resize(dof);
  Cursor in;
  for (int i = 0; i < dof; ++i) {
    ArmJoint joint;
    joint.name = names[static_cast<std::size_t>(i) + 1];
    joint.type = in.read() != 0 ? JointType::slide : JointType::hinge;
    joint.X_PJ = in.read_frame();
    joint.axis = in.read_vector();
    arm.limits.lower[i] = in.read();
    arm.limits.upper[i] = in.read();
    arm.joints.push_back(std::move(joint));
  }
  arm.X_JT = in.read_frame();
  arm.home = joint_vec(in.read(dof));
  parts_.emplace(Parts{IkSolver(arm, {.task = task_for(arm)}), ToolTarget(arm)});
  return true;
}

/// In: q. Out: X_WT, then X_WJ of each joint after its motion.
MJARM_EXPORT(fk) void ik_fk() {
  const Arm& arm = parts_->ik.arm();
  const JointVec q = joint_vec(Cursor().read(arm.dof()));
  std::array<Pose, kMaxDof> X_WJ;
  Cursor out;
  out.write(fk_all(arm, as_span(q), X_WJ));
  for (int i = 0; i < arm.dof(); ++i) out.write(X_WJ[static_cast<std::size_t>(i)]);
}

/// In: of each body that the arm moves the joint, X_JB. As many as the numbers hold.
MJARM_EXPORT(set_bodies) void ik_set_bodies(int count) {
  Cursor in;
  parts_->bodies.clear();
  for (int i = 0; i < count; ++i) {
    const auto joint = static_cast<std::size_t>(in.read());
    parts_->bodies.push_back({std::min(joint, parts_->ik.arm().joints.size() - 1), in.read_pose()});
  }
}

/// In: q. Out: X_WB of each body.
MJARM_EXPORT(bodies) void ik_bodies() {
  const Arm& arm = parts_->ik.arm();
  const JointVec q = joint_vec(Cursor().read(arm.dof()));
  std::array<Pose, kMaxDof> X_WJ;
  fk_all(arm, as_span(q), X_WJ);
  Cursor out;
  for (const Body& body : parts_->bodies) out.write(X_WJ[body.joint] * body.X_JB);
}

/// In: X_WT, the seed. Out: the answer (q, both errors); else the failure, and its line as text.
/// @return whether there is an answer.
MJARM_EXPORT(solve) bool ik_solve() {
  const IkSolver& ik = parts_->ik;
  Cursor in;
  const Pose X_WT = in.read_pose();
  const JointVec seed = joint_vec(in.read(ik.arm().dof()));
  const auto answer = ik.solve(X_WT, as_span(seed));
  Cursor out;
  if (answer) {
    out.write(*answer);
  } else {
    write(out, answer.error(), ik.arm().dof());
    text_ = describe(answer.error(), ik.arm());
  }
  return answer.has_value();
}

/// The same, all answers, the nearest first: q and both errors of each.
/// @return how many; 0: the failure instead.
MJARM_EXPORT(solve_all) int ik_solve_all() {
  const IkSolver& ik = parts_->ik;
  Cursor in;
  const Pose X_WT = in.read_pose();
  const JointVec seed = joint_vec(in.read(ik.arm().dof()));
  const auto answers = solve_all(ik, X_WT, as_span(seed), {.max = kMaxAnswers});
  Cursor out;
  if (!answers) {
    write(out, answers.error(), ik.arm().dof());
    text_ = describe(answers.error(), ik.arm());
    return 0;
  }
  for (const IkSolution& answer : *answers) out.write(answer);
  return static_cast<int>(answers->size());
}

// The target that is dragged. Each of these leaves its state in the numbers: pose, goal, grade,
// room [rad or m], the joint that it belongs to, the smallest singular value, the kind of
// singularity, whether there is a jump and where to, whether there is a failure and which. Text:
// its line.

MJARM_EXPORT(target_state) void ik_target_state() { write_state(parts_->target); }
/// In: q.
MJARM_EXPORT(target_set_goal) void ik_target_set_goal() {
  parts_->target.set_goal(joint_vec(Cursor().read(parts_->ik.arm().dof())));
  write_state(parts_->target);
}
/// In: X_WT.
MJARM_EXPORT(target_move_to) void ik_target_move_to() {
  parts_->target.move_to(Cursor().read_pose());
  write_state(parts_->target);
}
/// @param frame  of JogFrame
MJARM_EXPORT(target_jog) bool ik_target_jog(int frame, int axis, double amount) {
  const bool moved = parts_->target.jog(static_cast<JogFrame>(frame), axis, amount);
  write_state(parts_->target);
  return moved;
}
MJARM_EXPORT(target_take_jump) void ik_target_take_jump() {
  parts_->target.take_jump();
  write_state(parts_->target);
}
/// Out: orientation of a frame of JogFrame as the quaternion of a pose at the origin.
MJARM_EXPORT(target_axes) void ik_target_axes(int frame) {
  Cursor().write(Pose{Eigen::Vector3d::Zero(), parts_->target.axes(static_cast<JogFrame>(frame))});
}
MJARM_EXPORT(target_turns) bool ik_target_turns() { return parts_->target.turns(); }
