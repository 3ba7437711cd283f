#include "mjarm/program/urscript.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/program/urscript_arm_internal.hpp"
#include "mjarm/program/urscript_clock_internal.hpp"
#include "mjarm/program/urscript_targets_internal.hpp"

namespace mjarm::program {
namespace {

using detail::UrArm;
using detail::UrTarget;

/// Letters, digits and underscores, with a prefix: "movej.yaml" must not hide the word movej.
std::string function_name(const std::string& name) {
  std::string out = "mjarm_";
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    out += plain ? c : '_';
  }
  return out;
}

/// A name as a comment shows it: one line of ASCII.
std::string plain_text(std::string text) {
  std::ranges::replace_if(text, [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

/// A number with so many decimals at most, and no exponent.
std::string decimal(double value, int decimals) {
  std::string out = fmt::format("{:.{}f}", value, decimals);
  while (out.ends_with('0') && !out.ends_with(".0")) out.pop_back();
  return out == "-0.0" ? "0.0" : out;
}

std::string list_of(std::span<const double> values) {
  constexpr int kDecimals = 12;  // of [m] and [rad]
  std::string out;
  for (const double value : values) out += (out.empty() ? "" : ", ") + decimal(value, kDecimals);
  return "[" + out + "]";
}

std::string pose_of(const Pose& X) {
  const Eigen::Vector3d w = rotation_log(X.R);
  const double numbers[] = {X.p.x(), X.p.y(), X.p.z(), w.x(), w.y(), w.z()};
  return "p" + list_of(numbers);
}

std::string pace_of(double accel, double speed) {
  constexpr int kDecimals = 9;
  return fmt::format("a={}, v={}", decimal(accel, kDecimals), decimal(speed, kDecimals));
}

class UrscriptWriter {
 public:
  UrscriptWriter(const Program& program, const ProgramPlan& plan, const UrscriptOptions& options,
                 const UrArm& ur)
      : program_(program), plan_(plan), options_(options), ur_(ur) {}

  std::string write() {
    const std::string name = function_name(program_.name);
    out_ = "def " + name + "():\n";
    head();
    comment("to where the plan begins; slow, for this way was not planned");
    set_tool(0);
    line(fmt::format("movej({}, {})", list_of(as_span(plan_.q_start)), pace_of(0.5, 0.25)));
    for (const PlannedMove& move : plan_.moves) add(move);
    out_ += "end\n" + name + "()\n";
    return std::move(out_);
  }

 private:
  void line(const std::string& text) { out_ += "  " + text + "\n"; }
  void comment(const std::string& text) { line("# " + text); }

  void comment(FilePlace place, const std::string& text) {
    comment(place.line > 0 ? fmt::format("line {}: {}", place.line, text) : text);
  }

  void head() {
    comment(fmt::format("{}, for a {}; written by mjarm{}", plain_text(program_.name),
                        ur_.lengths.name,
                        options_.version.empty() ? "" : " " + plain_text(options_.version)));
    comment("units: m, rad, s, m/s, m/s^2 (movej: rad/s, rad/s^2 of the leading joint);");
    comment("p[x, y, z, rx, ry, rz]: the tool in the controller's base frame, a rotation vector");
    comment("v: the plan's fastest on the way there (mean where joint limits slow the tool down);");
    comment("a: so that ramps of a and a stretch at v take as long as planned;");
    comment("set payload and safety on the controller, and try it at low speed first");
    comment(fmt::format("planned: {} s; points of curves: within {} mm",
                        decimal(plan_.duration(), 3), decimal(1e3 * options_.pos_tol, 6)));
    comment(fmt::format(
        "with the same joint values the tool of the model and of a {} by its nominal lengths are",
        ur_.lengths.name));
    comment(fmt::format("up to {} mm apart: before a curve the tool is put on its start",
                        decimal(1e3 * apart(), 2)));
  }

  [[nodiscard]] Pose tool_in_flange(std::size_t i) const {
    return ur_.X_JF.inverse() * plan_.arms[i].X_JT;
  }

  /// Largest distance [m] between the tool by the model and by the nominal lengths, where motions
  /// end.
  [[nodiscard]] double apart() const {
    double worst = 0;
    for (const PlannedMove& move : plan_.moves) {
      const JointVec q = move.trajectory.at(move.trajectory.duration()).q;
      const Pose nominal =
          ur_.X_WB * detail::ur_flange(ur_.lengths, as_span(q)) * tool_in_flange(move.tool);
      worst = std::max(worst, (nominal.p - fk(plan_.arms[move.tool], as_span(q)).p).norm());
    }
    return worst;
  }

  void set_tool(std::size_t i) {
    if (tool_ == i) return;
    tool_ = i;
    comment("tool: " + plain_text(plan_.arms[i].tip) + ", in the flange");
    line(fmt::format("set_tcp({})", pose_of(tool_in_flange(i))));
  }

  [[nodiscard]] Pose in_base(const Pose& X_WT) const { return ur_.X_WB.inverse() * X_WT; }

  void add(const PlannedMove& move) {
    set_tool(move.tool);
    if (move.curve) {
      tool_move(move);
    } else if (!move.corners.empty()) {
      detour(move);
    } else if (move.measures) {
      joint_move(move);
    } else {
      rest(move);
    }
  }

  void rest(const PlannedMove& move) {
    comment(move.place, move.word);
    if (move.close) {
      comment(*move.close ? "the gripper closes: tool output 0 is on"
                          : "the gripper opens: tool output 0 is off");
      line(fmt::format("set_tool_digital_out(0, {})", *move.close ? "True" : "False"));
    }
    const double seconds = move.trajectory.duration();
    if (seconds > 0) line(fmt::format("sleep({})", decimal(seconds, 9)));
    if (!move.close && !(seconds > 0)) comment("the tool is there already");
  }

  void joint_move(const PlannedMove& move) {
    comment(move.place, move.word == "approach" ? "to where the curve begins" : move.word);
    joint_move(move.trajectory);
  }

  /// Edge by edge with a stop at each corner: what is proved free is the edges.
  void detour(const PlannedMove& move) {
    comment(move.place, move.word);
    const JointLimits& limits = plan_.arms[move.tool].limits;
    constexpr double kLeastShare = 0.01;
    const double share = check_limits(move.trajectory, limits).velocity.maxCoeff();
    for (std::size_t i = 1; i < move.corners.size(); ++i) {
      const auto edge =
          time_joint_move(as_span(move.corners[i - 1]), as_span(move.corners[i]), limits,
                          {.joint_share = std::clamp(share, kLeastShare, 1.0)});
      if (edge) joint_move(*edge);
    }
    if (move.corners.size() == 1) comment("the arm is there already");
  }

  void joint_move(const Trajectory& trajectory) {
    const double seconds = trajectory.duration();
    const JointVec q0 = trajectory.at(0).q, q1 = trajectory.at(seconds).q;
    Eigen::Index leading = 0;
    const double way = (q1 - q0).cwiseAbs().maxCoeff(&leading);
    if (!(seconds > 0) || !(way > 0)) {
      comment("the arm is there already");
      return;
    }
    constexpr int kSamples = 4000;
    double peak = 0;
    for (int i = 0; i <= kSamples; ++i) {
      peak = std::max(peak, std::abs(trajectory.at(seconds * i / kSamples).v[leading]));
    }
    const detail::Trapezoid pace = detail::trapezoid(way, seconds, peak);
    line(fmt::format("movej({}, {})", list_of(as_span(q1)), pace_of(pace.accel, pace.speed)));
    by_joints_ = true;
  }

  void tool_move(const PlannedMove& move) {
    if (by_joints_) {
      comment(move.place, "onto the start of the " + move.word);
      line(fmt::format("movel({}, {})", pose_of(in_base(move.curve->at(0))), pace_of(0.5, 0.05)));
      by_joints_ = false;
    }
    const std::vector<UrTarget> targets = detail::ur_targets(move, plan_.arms[move.tool], options_);
    const UrTarget* before = nullptr;
    for (const UrTarget& target : targets) {
      const bool another = before == nullptr || before->place.line != target.place.line;
      if (another) comment(target.place, move.word);
      line(statement(target));
      before = &target;
    }
  }

  [[nodiscard]] std::string statement(const UrTarget& target) const {
    const std::string to = pose_of(in_base(target.X_WT));
    if (target.word == UrTarget::Word::turn) {
      return fmt::format("movel({}, t={})", to, decimal(target.time, 9));
    }
    std::string pace = pace_of(target.accel, target.speed);
    if (target.radius > 0) pace += ", r=" + decimal(target.radius, 9);
    if (target.word == UrTarget::Word::arc) {
      return fmt::format("movec({}, {}, {})", pose_of(in_base(target.X_via)), to, pace);
    }
    return fmt::format("{}({}, {})", target.word == UrTarget::Word::line ? "movel" : "movep", to,
                       pace);
  }

  const Program& program_;
  const ProgramPlan& plan_;
  const UrscriptOptions& options_;
  const UrArm& ur_;
  std::optional<std::size_t> tool_;
  bool by_joints_ = true;  ///< the tool is where joint values put it
  std::string out_;
};

}  // namespace

Result<std::string> to_urscript(const Program& program, const Robot& robot, const ProgramPlan& plan,
                                const UrscriptOptions& options) {
  if (!plan.ok()) return fail(plan.faults.front().code, plan.faults.front().what);
  const auto excites = [](const PlannedMove& move) { return move.word == "excite"; };
  if (std::ranges::any_of(plan.moves, excites)) {
    return fail(Errc::not_available, text(msg::program_urscript_excite));
  }
  const Result<UrArm> ur = detail::find_ur_arm(robot.model, robot.arm);
  if (!ur) return fail(ur.error());
  return UrscriptWriter(program, plan, options, *ur).write();
}

}  // namespace mjarm::program
