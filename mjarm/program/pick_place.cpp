#include "mjarm/program/pick_place.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "mjarm/collision/exact.hpp"
#include "mjarm/core/messages/program.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/joint_values.hpp"
#include "mjarm/model/scene_bodies.hpp"

namespace mjarm::program {
namespace {

using Eigen::Vector3d;

constexpr double kFingersOpen = 1e-3;  // [m or rad] so near to open they need not be opened
constexpr double kRest = 1e-3;         // [m] what is carried may be so deep in what it lies on
constexpr int kTurns = 8;              // about the vertical that are tried at a place
constexpr double kClear = 0.05;        // [m] more clearance than that makes no grasp better

/// What a grasp costs that comes from aside, in the place of one from above; the same as so many
/// metres off the centre of mass.
constexpr double kAside = 0.03;

/// A grasp that can be had, and where.
struct GoodGrasp {
  Grasp grasp;
  Pose X_WT;        ///< the tool when the fingers close
  Pose X_WT_place;  ///< the tool when they open
  Pose X_WB_place;
  double cost = 0;  ///< [m] see kAside
};

struct Drop {
  PickErrc code;
  std::string what;
};

/// The tool moved by `way_W`.
Pose moved(const Pose& X_WT, const Vector3d& way_W) { return {X_WT.p + way_W, X_WT.R}; }

class PickPlanner {
 public:
  PickPlanner(const Robot& robot, const SceneState& scene, std::span<const double> q,
              const PickTask& task, const PickOptions& options)
      : robot_(robot), scene_(scene), q_(q), task_(task), options_(options) {}

  Result<PickPlan, PickFailure> plan() {
    if (auto ready = look(); !ready) return tl::unexpected(std::move(ready.error()));
    const std::vector<GoodGrasp> good = choose();
    for (const GoodGrasp& one : good) {
      if (is_stopped(options_.stop)) break;
      ProgramPlan plan = plan_program(robot_.model, robot_.arm, program(one), plan_options());
      if (plan.ok()) return PickPlan{std::move(plan), one.grasp, one.X_WB_place, dropped_};
      drop(one.grasp, {PickErrc::no_way, plan.faults.front().what});
    }
    if (is_stopped(options_.stop)) return failure(PickErrc::stopped, stopped().what);
    return none();
  }

 private:
  static tl::unexpected<PickFailure> failure(PickErrc code, std::string what) {
    return tl::unexpected(PickFailure{code, std::move(what), {}});
  }

  void drop(const Grasp& grasp, Drop why) {
    dropped_.push_back({grasp, why.code, std::move(why.what)});
  }

  /// Object, gripper, and how things stand with open fingers.
  Result<void, PickFailure> look() {
    const SceneBodies bodies = scene_bodies(robot_.model, robot_.arm);
    const auto object = std::ranges::find(bodies.objects, task_.object, &SceneObject::name);
    if (object == bodies.objects.end()) {
      std::string names;
      for (const SceneObject& one : bodies.objects) names += (names.empty() ? "" : ", ") + one.name;
      return failure(PickErrc::no_object,
                     text(msg::pick_no_object, task_.object,
                          names.empty() ? "" : text(msg::pick_objects, names)));
    }
    if (!scene_.attached.empty()) {
      return failure(PickErrc::hand_full,
                     text(msg::pick_hand_full, scene_.attached.front().body));
    }
    Result<Jaws> jaws = find_jaws(robot_.model, robot_.arm);
    if (!jaws) return failure(PickErrc::no_gripper, jaws.error().what);
    jaws_ = *jaws;
    Result<SceneState> open = open_gripper(robot_.model, robot_.arm, q_, scene_);
    if (!open) return failure(PickErrc::no_gripper, open.error().what);
    open_ = std::move(*open);
    grasps_ = find_grasps(object_shape(robot_.model, object->body), jaws_, options_.grasp);
    if (!grasps_.all.empty()) return {};
    if (!std::isfinite(grasps_.narrowest)) {
      return failure(PickErrc::too_wide, text(msg::pick_no_sides, task_.object));
    }
    return failure(PickErrc::too_wide,
                   text(msg::pick_too_wide, task_.object, 1000 * grasps_.narrowest,
                        1000 * jaws_.opening));
  }

  /// Gives answers that `checker` calls free.
  [[nodiscard]] IkSolver solver(ExactChecker& checker) const {
    IkOptions options{.task = task_for(robot_.arm), .valid = {}};
    options.valid = [&checker](std::span<const double> q) { return checker.is_free(q); };
    return IkSolver(robot_.arm, options);
  }

  /// The grasps that can be had and put down with, the best first.
  std::vector<GoodGrasp> choose() {
    const Result<Pose> X_WB = frame_pose(robot_.model, task_.object, open_.qpos);
    if (!X_WB) return {};
    std::vector<GoodGrasp> all;
    for (const Grasp& grasp : grasps_.all) {
      GoodGrasp one{.grasp = grasp, .X_WT = *X_WB * grasp.X_BT, .X_WT_place = {}, .X_WB_place = {}};
      const double down = -(one.X_WT.R * jaws_.approach_T).z();
      one.cost = grasp.off_center + kAside * (1 - down);
      all.push_back(std::move(one));
    }
    std::ranges::stable_sort(all, {}, &GoodGrasp::cost);
    ExactChecker checker(robot_.model, robot_.arm, {.qpos = open_.qpos});
    const IkSolver ik = solver(checker);
    std::vector<GoodGrasp> good;
    for (GoodGrasp& one : all) {
      if (good.size() == options_.tries || is_stopped(options_.stop)) break;
      if (auto fine = look_at(one, ik, checker); !fine) {
        drop(one.grasp, std::move(fine.error()));
      } else {
        good.push_back(std::move(one));
      }
    }
    std::ranges::stable_sort(good, {}, &GoodGrasp::cost);
    return good;
  }

  /// An answer without contact to a pose.
  Result<JointVec, Drop> posture(const IkSolver& ik, const Pose& X_WT, ExactChecker& checker,
                                 PickErrc far, PickErrc blocked) const {
    const auto answer = ik.solve(X_WT, q_);
    if (answer) return answer->q;
    if (answer.error().code != IkErrc::collision) {
      return tl::unexpected(Drop{far, describe(answer.error(), robot_.arm)});
    }
    const auto report = checker.check(as_span(answer.error().best.q));
    return tl::unexpected(
        Drop{blocked, report && !report->free ? describe(*report)
                                              : describe(answer.error(), robot_.arm)});
  }

  /// Fills in what is known of a grasp that can be had and put down with.
  Result<void, Drop> look_at(GoodGrasp& one, const IkSolver& ik, ExactChecker& checker) {
    const Vector3d back = -options_.approach * (one.X_WT.R * jaws_.approach_T);
    for (const Pose& X_WT : {moved(one.X_WT, back), one.X_WT}) {
      auto q = posture(ik, X_WT, checker, PickErrc::grasp_out_of_reach, PickErrc::grasp_blocked);
      if (!q) return tl::unexpected(std::move(q.error()));
      q_grasp_ = *q;
    }
    if (const auto report = checker.check(as_span(q_grasp_)); report && report->nearest) {
      one.cost += kClear - std::min(report->nearest->distance, kClear);
    }
    Result<SceneState> held = close_gripper(robot_.model, robot_.arm, as_span(q_grasp_), open_);
    const bool holds = held && held->attached.size() == 1;
    if (!holds || held->attached.front().body != task_.object) {
      return tl::unexpected(Drop{PickErrc::not_held,
                                 holds ? text(msg::pick_holds_other, held->attached.front().body)
                                       : text(msg::pick_holds_nothing)});
    }
    return look_at_place(one, *held);
  }

  Result<void, Drop> look_at_place(GoodGrasp& one, const SceneState& held) const {
    const Pose X_BT = held.attached.front().X_TB.inverse();
    ExactChecker checker(robot_.model, robot_.arm,
                         {.rules = {.attached = held.attached}, .qpos = held.qpos,
                          .rest_depth = kRest});
    const IkSolver ik = solver(checker);
    std::optional<Drop> why;
    double nearest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < (task_.place.any_turn ? kTurns : 1); ++k) {
      const Eigen::AngleAxisd turn(2 * std::numbers::pi * k / kTurns, Vector3d::UnitZ());
      const Pose X_WB{task_.place.X_WB.p, turn.toRotationMatrix() * task_.place.X_WB.R};
      const Pose X_WT = moved(X_WB * X_BT, options_.drop * Vector3d::UnitZ());
      auto q = posture(ik, X_WT, checker, PickErrc::place_out_of_reach, PickErrc::place_blocked);
      if (q) q = posture(ik, moved(X_WT, options_.lift * Vector3d::UnitZ()), checker,
                         PickErrc::place_out_of_reach, PickErrc::place_blocked);
      if (!q) {
        if (!why || why->code < q.error().code) why = std::move(q.error());
        continue;
      }
      const double far = (*q - q_grasp_).cwiseAbs().maxCoeff();
      if (far >= nearest) continue;
      nearest = far;
      one.X_WT_place = X_WT;
      one.X_WB_place = X_WB;
    }
    if (std::isfinite(nearest)) return {};
    return tl::unexpected(std::move(*why));
  }

  [[nodiscard]] Program program(const GoodGrasp& one) const {
    const Vector3d back = -options_.approach * (one.X_WT.R * jaws_.approach_T);
    const Vector3d back_place = -options_.approach * (one.X_WT_place.R * jaws_.approach_T);
    const Vector3d up = options_.lift * Vector3d::UnitZ();
    const auto pose = [](const Pose& X_WT) { return ProgramPose{.X_FT = X_WT}; };
    const auto plan = [&](const Pose& X_WT) { return Instruction{PlanMove{.goal = pose(X_WT)}}; };
    const auto line = [&](const Pose& X_WT) { return Instruction{MoveL{.goal = pose(X_WT)}}; };
    Program out;
    out.name = "pick " + task_.object;
    out.start.values.assign(q_.begin(), q_.end());
    if (!stand_open()) out.instructions.push_back({Grip{.close = false}});
    for (Instruction& next : std::vector<Instruction>{
             plan(moved(one.X_WT, back)), line(one.X_WT), {Grip{.close = true}},
             line(moved(one.X_WT, up)), plan(moved(one.X_WT_place, up)), line(one.X_WT_place),
             {Grip{.close = false}}, line(moved(one.X_WT_place, back_place))}) {
      out.instructions.push_back(std::move(next));
    }
    return out;
  }

  /// The fingers are open already.
  [[nodiscard]] bool stand_open() const {
    if (scene_.qpos.empty()) return false;
    double most = 0;
    for (std::size_t k = 0; k < open_.qpos.size(); ++k) {
      most = std::max(most, std::abs(open_.qpos[k] - scene_.qpos[k]));
    }
    return most < kFingersOpen;
  }

  [[nodiscard]] ProgramPlanOptions plan_options() const {
    return {.tool_speed = options_.tool_speed,
            .scene = scene_,
            .after_step = {},
            .stop = options_.stop};
  }

  /// Why none of the grasps will do: how many fail for which reason.
  Result<PickPlan, PickFailure> none() {
    std::map<PickErrc, std::size_t> counts;
    const DroppedGrasp* farthest = nullptr;
    for (const DroppedGrasp& one : dropped_) {
      ++counts[one.code];
      if (farthest == nullptr || farthest->code < one.code) farthest = &one;
    }
    if (farthest == nullptr) return failure(PickErrc::no_object, task_.object);
    std::string list;
    for (const auto& [code, count] : counts) {
      list += (list.empty() ? "" : ", ") + text(msg::pick_count, count, std::string(name(code)));
    }
    std::string what =
        text(msg::pick_none, dropped_.size(), task_.object, list, farthest->what);
    const PickErrc code = farthest->code;
    return tl::unexpected(PickFailure{code, std::move(what), std::move(dropped_)});
  }

  const Robot& robot_;
  const SceneState& scene_;
  std::span<const double> q_;
  const PickTask& task_;
  const PickOptions& options_;
  Jaws jaws_;
  Grasps grasps_;
  SceneState open_;  ///< with open fingers
  JointVec q_grasp_;
  std::vector<DroppedGrasp> dropped_;
};

}  // namespace

std::string_view name(PickErrc code) noexcept {
  switch (code) {
    case PickErrc::no_object:
      return "no_object";
    case PickErrc::no_gripper:
      return "no_gripper";
    case PickErrc::hand_full:
      return "hand_full";
    case PickErrc::too_wide:
      return "too_wide";
    case PickErrc::grasp_out_of_reach:
      return "grasp_out_of_reach";
    case PickErrc::grasp_blocked:
      return "grasp_blocked";
    case PickErrc::not_held:
      return "not_held";
    case PickErrc::place_out_of_reach:
      return "place_out_of_reach";
    case PickErrc::place_blocked:
      return "place_blocked";
    case PickErrc::no_way:
      return "no_way";
    case PickErrc::stopped:
      break;
  }
  return "stopped";
}

Result<PickPlan, PickFailure> plan_pick(const Robot& robot, const SceneState& scene,
                                        std::span<const double> q, const PickTask& task,
                                        const PickOptions& options) {
  return PickPlanner(robot, scene, q, task, options).plan();
}

}  // namespace mjarm::program
