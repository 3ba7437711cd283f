#include "mjarm/program/pick_place.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "mjarm/collision/exact.hpp"
#include "mjarm/core/messages/program.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/home.hpp"
#include "mjarm/model/scene_bodies.hpp"

namespace mjarm::program {
namespace {

using Eigen::Vector3d;

constexpr double kFingersOpen = 1e-3;  // [m or rad] so near to open they need not be opened
constexpr double kRest = 1e-3;         // [m] what is carried may be so deep in what it lies on
constexpr int kTurns = 8;              // about the vertical that are tried at a place
constexpr double kClear = 0.05;        // [m] more clearance than that makes no grasp better
constexpr double kBeside = 1e-3;       // [m] from all but the object, where the fingers close

/// What a grasp costs that comes from aside, in the place of one from above; the same as so many
/// metres off the centre of mass.
constexpr double kAside = 0.03;

/// A grasp that can be had, and where.
struct GoodGrasp {
  Grasp grasp = {};
  Pose X_WT = {};        ///< the tool when the fingers close
  Pose X_TB = {};        ///< the object then
  Pose X_WT_place = {};  ///< the tool when they open
  Pose X_WB_place = {};
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
  PickPlanner(const Robot& robot, const SceneState& scene, std::span<const double> q, PickTask task,
              const PickOptions& options)
      : robot_(robot),
        scene_(scene),
        q_(q),
        task_(std::move(task)),
        options_(options),
        reach_(robot.arm, {.task = task_for(robot.arm)}) {
    if (!scene_.qpos.empty()) return;
    const std::span<const double> home = home_configuration(robot.model.raw());
    scene_.qpos.assign(home.begin(), home.end());
  }

  Result<PickPlan, PickFailure> plan() {
    if (auto ready = look(); !ready) return tl::unexpected(std::move(ready.error()));
    for (const GoodGrasp& one : choose()) {
      if (is_stopped(options_.stop)) break;
      std::vector<Instruction> list = to_grasp(one);
      if (task_.place) std::ranges::move(to_place(one), std::back_inserter(list));
      if (auto plan = planned(one, std::move(list))) return std::move(*plan);
    }
    return none();
  }

  Result<PickPlan, PickFailure> plan_from_hand() {
    if (scene_.attached.size() != 1) {
      return failure(PickErrc::hand_full, text(msg::pick_hand_empty));
    }
    task_.object = scene_.attached.front().body;
    find_approach();
    sort_bodies(scene_bodies(robot_.model, robot_.arm));
    GoodGrasp one;
    one.X_TB = scene_.attached.front().X_TB;
    q_grasp_ = joint_vec(q_);
    if (auto fine = look_at_place(one, scene_); !fine) {
      drop({}, std::move(fine.error()));
    } else if (auto plan = planned(one, to_place(one))) {
      return std::move(*plan);
    }
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
      std::vector<std::string> names;
      for (const SceneObject& one : bodies.objects) names.push_back(one.name);
      std::string list;
      for (const std::string& one : names) list += (list.empty() ? "" : ", ") + one;
      return failure(PickErrc::no_object, text(msg::pick_no_object, task_.object,
                                               list.empty() ? "" : text(msg::pick_objects, list)) +
                                              did_you_mean(task_.object, names));
    }
    sort_bodies(bodies);
    if (!scene_.attached.empty()) {
      return failure(PickErrc::hand_full, text(msg::pick_hand_full, scene_.attached.front().body));
    }
    const Result<Jaws> jaws = find_jaws(robot_.model, robot_.arm);
    if (!jaws) return failure(PickErrc::no_gripper, jaws.error().what);
    jaws_ = *jaws;
    approach_T_ = jaws_.approach_T;
    Result<SceneState> open = open_gripper(robot_.model, robot_.arm, q_, scene_);
    if (!open) return failure(PickErrc::no_gripper, open.error().what);
    open_ = std::move(*open);
    grasps_ = find_grasps(object_shape(robot_.model, object->body), jaws_, options_.grasp);
    if (!grasps_.all.empty()) return {};
    if (!std::isfinite(grasps_.narrowest)) {
      return failure(PickErrc::too_wide, text(msg::pick_no_sides, task_.object));
    }
    return failure(PickErrc::too_wide, text(msg::pick_too_wide, task_.object,
                                            1000 * grasps_.narrowest, 1000 * jaws_.opening));
  }

  /// The names of the links and of what moves with the tool.
  void sort_bodies(const SceneBodies& bodies) {
    for (std::size_t b = 1; b < bodies.role.size(); ++b) {
      const BodyRole role = bodies.role[b];
      const int object = bodies.object_of[b];
      if (role == BodyRole::link) links_.insert(bodies.name[b]);
      if (role == BodyRole::hand) hand_.insert(bodies.name[b]);
      if (object >= 0 && bodies.objects[static_cast<std::size_t>(object)].name == task_.object) {
        object_.insert(bodies.name[b]);
      }
    }
  }

  /// Where the fingers point, as far as that can be told.
  void find_approach() {
    if (const Result<Jaws> jaws = find_jaws(robot_.model, robot_.arm)) {
      approach_T_ = jaws->approach_T;
    }
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
      GoodGrasp one{.grasp = grasp, .X_WT = *X_WB * grasp.X_BT};
      const double down = -(one.X_WT.R * jaws_.approach_T).z();
      one.cost = grasp.off_center + kAside * (1 - down);
      all.push_back(std::move(one));
    }
    std::ranges::stable_sort(all, {}, &GoodGrasp::cost);
    ExactChecker checker(robot_.model, robot_.arm, {.qpos = open_.qpos});
    ExactChecker beside(robot_.model, robot_.arm,
                        {.margin = kClear, .rules = without_object(), .qpos = open_.qpos});
    const IkSolver ik = solver(checker);
    std::vector<GoodGrasp> good;
    for (GoodGrasp& one : all) {
      if (good.size() == options_.tries || is_stopped(options_.stop)) break;
      if (auto fine = look_at(one, ik, checker, beside); !fine) {
        drop(one.grasp, std::move(fine.error()));
      } else {
        good.push_back(std::move(one));
      }
    }
    std::ranges::stable_sort(good, {}, &GoodGrasp::cost);
    return good;
  }

  /// The hand and the object do not count for each other.
  [[nodiscard]] ContactRules without_object() const {
    ContactRules rules;
    for (const std::string& object : object_) {
      for (const std::string& hand : hand_) {
        if (!hand.starts_with('#')) rules.allowed.push_back({hand, object});
      }
    }
    return rules;
  }

  /// An answer without contact to a pose. Where the hand, or what it holds, is in contact with what
  /// stands, no answer is without: that is seen at any of them.
  Result<JointVec, Drop> posture(const IkSolver& ik, const Pose& X_WT, ExactChecker& checker,
                                 bool holds) const {
    const PickErrc far = holds ? PickErrc::place_out_of_reach : PickErrc::grasp_out_of_reach;
    const PickErrc blocked = holds ? PickErrc::place_blocked : PickErrc::grasp_blocked;
    const auto any = reach_.solve(X_WT, q_);
    if (!any) return tl::unexpected(Drop{far, describe(any.error(), robot_.arm)});
    const auto report = checker.check(as_span(any->q));
    if (report && report->free) return any->q;
    for (const ContactPoint& contact : report ? report->contacts : std::vector<ContactPoint>()) {
      if (!is_of_hand(contact.pair, holds)) continue;
      return tl::unexpected(Drop{blocked, describe(CollisionReport{false, {contact}, {}})});
    }
    const auto answer = ik.solve(X_WT, q_);
    if (answer) return answer->q;
    return tl::unexpected(Drop{blocked, report ? describe(*report) : report.error().what});
  }

  /// Between what moves with the tool and what the arm does not move.
  [[nodiscard]] bool is_of_hand(const GeomPair& pair, bool holds) const {
    const auto moves = [&](const std::string& body) {
      return hand_.contains(body) || (holds && object_.contains(body));
    };
    const auto stands = [&](const std::string& body) {
      return !moves(body) && !links_.contains(body);
    };
    return (moves(pair.body1) && stands(pair.body2)) || (moves(pair.body2) && stands(pair.body1));
  }

  /// Fills in what is known of a grasp that can be had and put down with.
  /// @param beside  leaves out what the hand is near to in any case: the object.
  Result<void, Drop> look_at(GoodGrasp& one, const IkSolver& ik, ExactChecker& checker,
                             ExactChecker& beside) {
    const auto same = [&](const Grasp& tried) {
      return tried.X_BT.p == one.grasp.X_BT.p && tried.X_BT.R == one.grasp.X_BT.R;
    };
    if (std::ranges::any_of(options_.avoid, same)) {
      return tl::unexpected(Drop{PickErrc::failed_before, text(msg::pick_failed_before)});
    }
    for (const Pose& X_WT : {back_from(one.X_WT), one.X_WT}) {
      auto q = posture(ik, X_WT, checker, false);
      if (!q) return tl::unexpected(std::move(q.error()));
      q_grasp_ = *q;
    }
    if (const auto report = beside.check(as_span(q_grasp_)); report && report->nearest) {
      const NearestPair& near = *report->nearest;
      if (near.distance < kBeside) {
        return tl::unexpected(
            Drop{PickErrc::grasp_blocked,
                 text(msg::pick_too_near, near.pair.body1, near.pair.body2, 1000 * near.distance)});
      }
      one.cost += kClear - std::min(near.distance, kClear);
    }
    Result<SceneState> held = close_gripper(robot_.model, robot_.arm, as_span(q_grasp_), open_);
    const bool holds = held && held->attached.size() == 1;
    if (!holds || held->attached.front().body != task_.object) {
      return tl::unexpected(
          Drop{PickErrc::not_held, holds ? text(msg::pick_holds_other, held->attached.front().body)
                                         : text(msg::pick_holds_nothing)});
    }
    one.X_TB = held->attached.front().X_TB;
    return task_.place ? look_at_place(one, *held) : Result<void, Drop>{};
  }

  /// All that is as good as the goal.
  static std::vector<Pose> poses_at(const PlaceGoal& place) {
    std::vector<Pose> out;
    for (int k = 0; k < (place.any_turn ? kTurns : 1); ++k) {
      const Eigen::AngleAxisd turn(2 * std::numbers::pi * k / kTurns, Vector3d::UnitZ());
      const Pose X_WB{place.X_WB.p, turn.toRotationMatrix() * place.X_WB.R};
      if (place.same.empty()) out.push_back(X_WB);
      for (const Pose& X_BS : place.same) out.push_back(X_WB * X_BS);
    }
    return out;
  }

  Result<void, Drop> look_at_place(GoodGrasp& one, const SceneState& held) const {
    const Pose X_BT = one.X_TB.inverse();
    const PlaceGoal& place = *task_.place;
    ExactChecker checker(
        robot_.model, robot_.arm,
        {.rules = {.attached = held.attached}, .qpos = held.qpos, .rest_depth = kRest});
    const IkSolver ik = solver(checker);
    std::optional<Drop> why;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Pose& X_WB : poses_at(place)) {
      const Pose X_WT = moved(X_WB * X_BT, options_.drop * Vector3d::UnitZ());
      auto q = posture(ik, X_WT, checker, true);
      if (q) q = posture(ik, above(X_WT), checker, true);
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

  static Instruction plan_to(const Pose& X_WT) {
    return {PlanMove{.goal = ProgramPose{.X_FT = X_WT}}};
  }
  static Instruction line_to(const Pose& X_WT) {
    return {MoveL{.goal = ProgramPose{.X_FT = X_WT}}};
  }
  [[nodiscard]] Pose back_from(const Pose& X_WT) const {
    return moved(X_WT, -options_.approach * (X_WT.R * approach_T_));
  }
  [[nodiscard]] Pose above(const Pose& X_WT) const {
    return moved(X_WT, options_.lift * Vector3d::UnitZ());
  }

  [[nodiscard]] std::vector<Instruction> to_grasp(const GoodGrasp& one) const {
    std::vector<Instruction> out;
    if (!stand_open()) out.push_back({Grip{.close = false}});
    out.push_back(plan_to(back_from(one.X_WT)));
    out.push_back(line_to(one.X_WT));
    out.push_back({Grip{.close = true}});
    out.push_back(line_to(above(one.X_WT)));
    return out;
  }

  [[nodiscard]] std::vector<Instruction> to_place(const GoodGrasp& one) const {
    return {plan_to(above(one.X_WT_place)),
            line_to(one.X_WT_place),
            {Grip{.close = false}},
            line_to(back_from(one.X_WT_place))};
  }

  /// The whole of it, planned and proved; where that fails the grasp is dropped.
  std::optional<PickPlan> planned(const GoodGrasp& one, std::vector<Instruction> instructions) {
    Program program;
    program.name = "pick " + task_.object;
    program.start.values.assign(q_.begin(), q_.end());
    program.instructions = std::move(instructions);
    ProgramPlan plan = plan_program(robot_.model, robot_.arm, program, plan_options());
    if (!plan.ok()) {
      drop(one.grasp, {PickErrc::no_way, plan.faults.front().what});
      return std::nullopt;
    }
    PickPlan out{.plan = std::move(plan),
                 .grasp = one.grasp,
                 .X_TB = one.X_TB,
                 .X_WB_place = {},
                 .dropped = dropped_};
    if (task_.place) out.X_WB_place = one.X_WB_place;
    return out;
  }

  /// The fingers are open already.
  [[nodiscard]] bool stand_open() const {
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
    if (is_stopped(options_.stop)) return failure(PickErrc::stopped, stopped().what);
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
    std::string what = text(msg::pick_none, dropped_.size(), task_.object, list, farthest->what);
    const PickErrc code = farthest->code;
    return tl::unexpected(PickFailure{code, std::move(what), std::move(dropped_)});
  }

  const Robot& robot_;
  SceneState scene_;
  std::span<const double> q_;
  PickTask task_;
  const PickOptions& options_;
  IkSolver reach_;                               ///< geometry alone
  std::set<std::string> links_, hand_, object_;  ///< names of bodies
  Jaws jaws_;
  Vector3d approach_T_ = Vector3d::UnitZ();
  Grasps grasps_;
  SceneState open_;  ///< with open fingers
  JointVec q_grasp_;
  std::vector<DroppedGrasp> dropped_;
};

}  // namespace

std::string_view name(PickErrc code) noexcept {
  switch (code) {
    case PickErrc::not_seen:
      return "not_seen";
    case PickErrc::no_object:
      return "no_object";
    case PickErrc::no_gripper:
      return "no_gripper";
    case PickErrc::hand_full:
      return "hand_full";
    case PickErrc::too_wide:
      return "too_wide";
    case PickErrc::failed_before:
      return "failed_before";
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

Result<PickPlan, PickFailure> plan_place(const Robot& robot, const SceneState& scene,
                                         std::span<const double> q, const PlaceGoal& place,
                                         const PickOptions& options) {
  return PickPlanner(robot, scene, q, {.object = {}, .place = place}, options).plan_from_hand();
}

}  // namespace mjarm::program
