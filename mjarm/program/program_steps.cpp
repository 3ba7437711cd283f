#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "mjarm/core/messages/program.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/model/joint_values.hpp"
#include "mjarm/path/ellipse.hpp"
#include "mjarm/program/program_steps_internal.hpp"
#include "mjarm/program/write_text_internal.hpp"

namespace mjarm::program::detail {
namespace {

constexpr std::size_t kMaxSteps = 100'000;
constexpr std::size_t kMaxVisits = 10 * kMaxSteps;  // of instructions that make no step as well

/// Ends the work on one instruction.
struct StepFault {
  FilePlace place;
  std::string reason;
  std::string what;
};

template <class T>
T value_or_fault(Result<T> result, FilePlace place, const char* reason) {
  if (!result) throw StepFault{place, reason, result.error().what};
  return std::move(*result);
}

class StepWriter {
 public:
  StepWriter(const Program& program, const Model& model, const Arm& arm)
      : program_(program), model_(model), qpos_(model.qpos0().begin(), model.qpos0().end()) {
    out_.arms.push_back(arm);
    out_.q_start = arm.home;
    tools_[arm.tip] = 0;
    for (int i = 0; i < arm.dof(); ++i) {
      qpos_[static_cast<std::size_t>(arm.joints[static_cast<std::size_t>(i)].qpos)] = arm.home[i];
    }
  }

  Steps write() {
    attempt("program", [&] { take(program_.settings, {}); });
    attempt("start", [&] { out_.q_start = joints(program_.start, program_.start_place); });
    is_free_ = program_.start.values.empty();
    add_all(program_.instructions);
    return std::move(out_);
  }

 private:
  /// Does a part of what stands before the instructions.
  void attempt(const char* part, const std::function<void()>& work) {
    try {
      work();
    } catch (const StepFault& fault) {
      out_.faults.push_back({fault.place, part, fault.reason, fault.what, Errc::bad_input});
    }
  }

  void add_all(const std::vector<Instruction>& instructions) {
    for (const Instruction& instruction : instructions) {
      if (full_) return;
      try {
        if (++visits_ > kMaxVisits) too_long(instruction.place);
        std::visit([&](const auto& what) { add(what, instruction); }, instruction.what);
      } catch (const StepFault& fault) {
        note(instruction, fault);
      }
    }
  }

  void note(const Instruction& instruction, const StepFault& fault) {
    ++noted_;
    const FilePlace place = fault.place.line > 0 ? fault.place : instruction.place;
    add_fault(out_.faults, {place, std::string(word(instruction)), fault.reason, fault.what,
                            code_of(fault.reason)});
  }

  static Errc code_of(const std::string& reason) {
    const bool sound = reason == "too_long" || reason == "not_available";
    return sound ? Errc::impossible : Errc::bad_input;
  }

  [[nodiscard]] Step begun(Step::Kind kind, const Instruction& instruction,
                           std::optional<double> speed = {}) const {
    Step step;
    step.kind = kind;
    step.word = word(instruction);
    step.place = instruction.place;
    step.tool = tool_;
    step.speed = speed.value_or(speed_.value_or(0));
    step.keep_speed = speed.has_value() || speed_.has_value();
    step.share = share_;
    step.payload = payload_;
    step.branch = branch_;
    step.is_free = is_free_;
    return step;
  }

  [[noreturn]] void too_long(FilePlace place) {
    full_ = true;
    throw StepFault{place, "too_long", text(msg::program_too_long, kMaxSteps)};
  }

  void push(Step step) {
    if (out_.steps.size() >= kMaxSteps) too_long(step.place);
    out_.steps.push_back(std::move(step));
  }

  /// X_WF of the frame of that name, or of the one that is set.
  Pose frame(const FrameName& name) {
    const std::string& wanted = name.name.empty() ? frame_.name : name.name;
    const FilePlace place = name.name.empty() ? frame_.place : name.place;
    std::set<std::string> seen;
    return frame(wanted, place, seen);
  }

  Pose frame(const std::string& name, FilePlace place, std::set<std::string>& seen) {
    if (name.empty() || name == "world") return {};
    const auto own = program_.frames.find(name);
    if (own != program_.frames.end()) {
      if (!seen.insert(name).second) {
        throw StepFault{place, "unknown_name", text(msg::program_frame_loop, name)};
      }
      return frame(own->second.frame.name, own->second.frame.place, seen) * own->second.X_FT;
    }
    const auto known_frame = model_frames_.find(name);
    if (known_frame != model_frames_.end()) return known_frame->second;
    const Result<Pose> X_WF = frame_pose(model_, name, qpos_);
    if (!X_WF) {
      std::vector<std::string> known{"world"};
      for (const auto& [other, pose] : program_.frames) known.push_back(other);
      const std::string near = did_you_mean(name, known);
      throw StepFault{
          place, "unknown_name",
          near.empty() ? X_WF.error().what : text(msg::program_unknown_frame, name) + near};
    }
    if (moves(name, *X_WF)) {
      throw StepFault{place, "unknown_name", text(msg::program_frame_moves, name)};
    }
    return model_frames_[name] = *X_WF;
  }

  /// Whether a frame of the model is carried along by the arm.
  bool moves(const std::string& name, const Pose& X_WF) const {
    constexpr double kNudge = 0.1;
    for (const ArmJoint& joint : out_.arms.front().joints) {
      std::vector<double> qpos = qpos_;
      qpos[static_cast<std::size_t>(joint.qpos)] += kNudge;
      const Result<Pose> moved = frame_pose(model_, name, qpos);
      if (moved && (moved->p - X_WF.p).norm() + (moved->R - X_WF.R).norm() > 1e-9) return true;
    }
    return false;
  }

  Pose world(const ProgramPose& pose) { return frame(pose.frame) * pose.X_FT; }

  void take(const Set& set, FilePlace place) {
    if (set.frame) {
      static_cast<void>(frame(*set.frame));  // a fault where there is no such frame
      frame_ = *set.frame;
    }
    if (set.speed) speed_ = set.speed;
    if (set.share) share_ = *set.share;
    if (set.zone) zone_ = *set.zone;
    if (set.branch) branch_ = known(*set.branch, place);
    if (set.tool) tool_ = tool(*set.tool, place);
    if (set.payload) {
      const Pose X_TU = out_.arms.front().X_JT.inverse() * out_.arms[tool_].X_JT;
      payload_ = {set.payload->mass, X_TU * set.payload->center};
    }
  }

  /// A fault where the arm has no such words.
  Branch known(const Branch& branch, FilePlace place) const {
    const Arm& arm = out_.arms[tool_];
    const Result<void> fits = check_branch(IkSolver(arm, {.task = task_for(arm)}), branch);
    if (!fits)
      throw StepFault{place, "bad_input", text(msg::program_in, "branch", fits.error().what)};
    return branch;
  }

  std::size_t tool(const std::string& name, FilePlace place) {
    const auto known = tools_.find(name);
    if (known != tools_.end()) return known->second;
    Arm arm = value_or_fault(find_arm(model_, {.tip = name}), place, "unknown_name");
    const Arm& first = out_.arms.front();
    const bool same =
        std::ranges::equal(arm.joints, first.joints, {}, &ArmJoint::qpos, &ArmJoint::qpos);
    if (!same) throw StepFault{place, "unknown_name", text(msg::program_other_arm, name)};
    arm.limits = first.limits;
    arm.home = first.home;
    out_.arms.push_back(std::move(arm));
    return tools_[name] = out_.arms.size() - 1;
  }

  JointVec joints(const JointValues& given, FilePlace place) const {
    const Arm& arm = out_.arms.front();
    const std::size_t count = given.values.size();
    if (count == 0) return arm.home;
    if (static_cast<int>(count) != arm.dof()) {
      throw StepFault{place, "bad_input", text(msg::program_wrong_joints, arm.dof(), count)};
    }
    for (std::size_t i = 0; i < given.units.size() && i < count; ++i) {
      const WrittenNumber written{given.values[i], given.units[i]};
      const bool bare = written.unit == Quantity::number;
      static_cast<void>(value_or_fault(joint_value(written, arm, static_cast<int>(i)), place,
                                       bare ? "joint_limit" : "bad_input"));
    }
    return joint_vec(given.values);
  }

  void set_goal(Step& step, const std::variant<JointValues, ProgramPose>& goal) {
    if (const auto* q = std::get_if<JointValues>(&goal)) {
      step.kind = Step::Kind::joints;
      step.q = joints(*q, step.place);
      is_free_ = q->values.empty();
    } else {
      step.X_WT = world(std::get<ProgramPose>(goal));
    }
  }

  void add(const MoveJ& what, const Instruction& instruction) {
    Step step = begun(Step::Kind::pose, instruction);
    step.share = what.share.value_or(share_);
    if (what.branch) step.branch = known(*what.branch, step.place);
    set_goal(step, what.goal);
    push(std::move(step));
  }

  void add(const MoveL& what, const Instruction& instruction) {
    Step step = begun(Step::Kind::line, instruction, what.speed);
    step.X_WT = world(what.goal);
    step.blend = what.blend.value_or(zone_);
    push(std::move(step));
  }

  void add(const MoveC& what, const Instruction& instruction) {
    Step step = begun(Step::Kind::arc, instruction, what.speed);
    step.X_via = world(what.via);
    step.X_WT = world(what.to);
    step.whole = what.whole;
    step.blend = what.whole ? 0 : what.blend.value_or(zone_);
    push(std::move(step));
  }

  void add(const DrawEllipse& what, const Instruction& instruction) {
    Step step = begun(Step::Kind::curve, instruction, what.speed);
    const Pose X_WF = frame(what.frame);
    const Ellipse ellipse{X_WF * what.center, what.a, what.b, X_WF.R * what.normal,
                          X_WF.R * what.R_FT};
    step.curve = value_or_fault(Curve::ellipse(ellipse), step.place, "bad_input");
    push(std::move(step));
  }

  void add(const DrawPolyline& what, const Instruction& instruction) {
    Step step = begun(Step::Kind::curve, instruction, what.speed);
    std::vector<Pose> points;
    for (const ProgramPose& point : what.points) points.push_back(world(point));
    step.blend = what.blend.value_or(zone_);
    step.curve = value_or_fault(Curve::polyline(points, step.blend), step.place, "bad_input");
    step.points = std::move(points);
    push(std::move(step));
  }

  void add(const DrawSpline& what, const Instruction& instruction) {
    Step step = begun(Step::Kind::curve, instruction, what.speed);
    std::vector<Pose> points;
    for (const ProgramPose& point : what.points) points.push_back(world(point));
    step.curve = value_or_fault(Curve::spline(points, what.corner), step.place, "bad_input");
    push(std::move(step));
  }

  void add(const DrawText& what, const Instruction& instruction) {
    const Pose X_WP = world(what.plane);
    const Eigen::Matrix3d R = frame(what.plane.frame).R * what.R_FT;
    if (what.press) return press(what, X_WP, R, instruction);
    Step step = begun(Step::Kind::curve, instruction, what.speed);
    WrittenText written = value_or_text_fault(write_text(what, X_WP, R), step.place);
    step.curve = std::move(written.curve);
    step.right_W = X_WP.R.col(0);
    step.points = std::move(written.corners);
    push(std::move(step));
  }

  /// A stroke at a time, each from where a straight way above the text leads.
  void press(const DrawText& what, const Pose& X_WP, const Eigen::Matrix3d& R,
             const Instruction& instruction) {
    constexpr double kDeeper = 2;  // times the lift: where nothing is met the stroke is given up
    bool first = true;
    for (Curve& curve : value_or_text_fault(lifted_strokes(what, X_WP, R), instruction.place)) {
      if (!first) {
        Step travel = begun(Step::Kind::line, instruction);
        travel.X_WT = curve.at(0);
        push(std::move(travel));
      }
      first = false;
      Step step = begun(Step::Kind::curve, instruction, what.speed);
      step.curve = std::move(curve);
      step.right_W = X_WP.R.col(0);
      step.press = ToolPress{.force = *what.press, .reach = kDeeper * what.lift};
      push(std::move(step));
    }
  }

  template <class T>
  static T value_or_text_fault(Result<T> written, FilePlace place) {
    if (written) return std::move(*written);
    const bool fetchable = written.error().code == Errc::not_available;
    throw StepFault{place, fetchable ? "not_available" : "bad_input", written.error().what};
  }

  void add(const Wait& what, const Instruction& instruction) {
    Step step = begun(Step::Kind::wait, instruction);
    step.seconds = what.seconds;
    push(std::move(step));
  }

  void add(const Excite& what, const Instruction& instruction) {
    Step step = begun(Step::Kind::excite, instruction);
    step.seconds = what.seconds;
    step.seed = what.seed;
    push(std::move(step));
  }

  void add(const Set& what, const Instruction& instruction) { take(what, instruction.place); }

  void add(const PlanMove& what, const Instruction& instruction) {
    Step step = begun(Step::Kind::plan, instruction);
    if (what.branch) step.branch = known(*what.branch, step.place);
    set_goal(step, what.goal);
    step.kind = Step::Kind::plan;
    step.clearance = what.clearance;
    push(std::move(step));
  }

  void add(const Grip& what, const Instruction& instruction) {
    Step step = begun(Step::Kind::grip, instruction);
    step.close = what.close;
    push(std::move(step));
  }

  void add(const Look& what, const Instruction& instruction) {
    // The whole program is planned before it runs, so only what is there at first can be seen.
    const auto rests = [](const Step& step) {
      return step.kind == Step::Kind::look || step.kind == Step::Kind::wait;
    };
    if (!std::ranges::all_of(out_.steps, rests)) {
      throw StepFault{instruction.place, "bad_input", text(msg::program_late_look)};
    }
    Step step = begun(Step::Kind::look, instruction);
    step.object = what.camera;
    step.place = what.place;
    push(std::move(step));
  }

  void add(const Pick& what, const Instruction& instruction) {
    Step step = begun(Step::Kind::pick, instruction);
    step.object = what.object;
    step.place = what.place;
    push(std::move(step));
  }

  void add(const Place& what, const Instruction& instruction) {
    Step step = begun(Step::Kind::place, instruction);
    step.X_WT = world(what.goal);
    step.any_turn = what.any_turn;
    push(std::move(step));
  }

  void add(const Repeat& what, const Instruction&) {
    if (what.body.empty()) return;
    const std::size_t before = noted_;
    // What is wrong in a body is wrong in each of its repeats.
    for (int i = 0; i < what.times && !full_ && noted_ == before; ++i) add_all(what.body);
  }

  const Program& program_;
  const Model& model_;
  std::vector<double> qpos_;  // the arm at home
  Steps out_;
  std::map<std::string, std::size_t> tools_;
  std::map<std::string, Pose> model_frames_;  // X_WF, as they are asked for
  std::size_t tool_ = 0;
  FrameName frame_;
  std::optional<double> speed_;
  double share_ = 1;
  double zone_ = 0;
  Payload payload_;
  Branch branch_;
  bool is_free_ = true;  // no joint values were given of late, `home` aside
  bool full_ = false;
  std::size_t visits_ = 0;
  std::size_t noted_ = 0;  // faults, repeated ones counted
};

}  // namespace

void add_fault(std::vector<ProgramFault>& faults, ProgramFault fault) {
  const auto same = [&](const ProgramFault& other) {
    return fault.place.line > 0 && other.place.line == fault.place.line &&
           other.place.column == fault.place.column && other.reason == fault.reason;
  };
  if (std::ranges::none_of(faults, same)) faults.push_back(std::move(fault));
}

Steps steps_of(const Program& program, const Model& model, const Arm& arm) {
  return StepWriter(program, model, arm).write();
}

}  // namespace mjarm::program::detail

namespace mjarm::program {

std::vector<ProgramFault> find_misfits(const Model& model, const Arm& arm, const Program& program) {
  return detail::steps_of(program, model, arm).faults;
}

}  // namespace mjarm::program
