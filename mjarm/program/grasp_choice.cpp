#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "mjarm/core/messages/program.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/model/home.hpp"
#include "mjarm/program/grasp_choice_internal.hpp"

namespace mjarm::program::detail {
namespace {

using Eigen::Vector3d;

constexpr double kFingersOpen = 1e-3;  // [m or rad] so near to open they need not be opened
constexpr double kRest = 1e-3;         // [m] what is carried may be so deep in what it lies on
constexpr int kTurns = 8;              // about the vertical that are tried at a place
constexpr double kClear = 0.05;        // [m] more clearance than that makes no grasp better

/// What a grasp costs that comes from aside, in the place of one from above; the same as so many
/// metres off the centre of mass.
constexpr double kAside = 0.03;

/// The tool moved by `way_W`.
Pose moved(const Pose& X_WT, const Vector3d& way_W) { return {X_WT.p + way_W, X_WT.R}; }

bool same(const Grasp& a, const Grasp& b) { return a.X_BT.p == b.X_BT.p && a.X_BT.R == b.X_BT.R; }

tl::unexpected<PickFailure> failure(PickErrc code, std::string what) {
  return tl::unexpected(PickFailure{code, std::move(what), {}});
}

/// All that is as good as the goal.
std::vector<Pose> poses_at(const PlaceGoal& place) {
  std::vector<Pose> out;
  for (int k = 0; k < (place.any_turn ? kTurns : 1); ++k) {
    const Eigen::AngleAxisd turn(2 * std::numbers::pi * k / kTurns, Vector3d::UnitZ());
    const Pose X_WB{place.X_WB.p, turn.toRotationMatrix() * place.X_WB.R};
    if (place.same.empty()) out.push_back(X_WB);
    for (const Pose& X_BS : place.same) out.push_back(X_WB * X_BS);
  }
  return out;
}

/// @param opened  with open fingers, whatever these are to the object
Result<JointVec, Drop> free_once_open(ExactChecker& opened, const JointVec& q) {
  if (opened.is_free(as_span(q))) return q;
  const auto report = opened.check(as_span(q));
  return tl::unexpected(
      Drop{PickErrc::place_blocked, report ? describe(*report) : report.error().what});
}

}  // namespace

GraspChoice::GraspChoice(const Robot& robot, const SceneState& scene, std::span<const double> q,
                         PickTask task, const PickOptions& options)
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

/// Object, gripper, and how things stand with open fingers.
Result<void, PickFailure> GraspChoice::look() {
  const SceneBodies bodies = scene_bodies(robot_.model, robot_.arm);
  const auto object = std::ranges::find(bodies.objects, task_.object, &SceneObject::name);
  if (object == bodies.objects.end()) {
    std::vector<std::string> names;
    for (const SceneObject& one : bodies.objects) names.push_back(one.name);
    return failure(PickErrc::no_object,
                   text(msg::pick_no_object, task_.object,
                        names.empty() ? "" : text(msg::pick_objects, listed(names))) +
                       did_you_mean(task_.object, names));
  }
  sort_bodies(bodies);
  if (!scene_.attached.empty()) {
    return failure(PickErrc::hand_full, text(msg::pick_hand_full, scene_.attached.front().body));
  }
  const Result<Jaws> jaws = find_jaws(robot_.model, robot_.arm);
  if (!jaws) return failure(PickErrc::no_gripper, jaws.error().what);
  jaws_ = *jaws;
  Result<SceneState> open = open_gripper(robot_.model, robot_.arm, q_, scene_);
  if (!open) return failure(PickErrc::no_gripper, open.error().what);
  open_ = std::move(*open);
  shape_ = object_shape(robot_.model, object->body);
  const Grasps grasps = find_grasps(shape_, jaws_, options_.grasp);
  if (!grasps.all.empty()) {
    opened_.emplace(robot_.model, robot_.arm,
                    ExactOptions{.margin = kClear, .rules = without_object(), .qpos = open_.qpos});
    return {};
  }
  if (!std::isfinite(grasps.narrowest)) {
    return failure(PickErrc::too_wide, text(msg::pick_no_sides, task_.object));
  }
  return failure(PickErrc::too_wide, text(msg::pick_too_wide, task_.object, 1000 * grasps.narrowest,
                                          1000 * jaws_.opening));
}

/// The names of the links and of what moves with the tool.
void GraspChoice::sort_bodies(const SceneBodies& bodies) {
  for (std::size_t b = 1; b < bodies.role.size(); ++b) {
    const BodyRole role = bodies.role[b];
    const int object = bodies.object_of[b];
    if (role == BodyRole::link) links_.insert(bodies.name[b]);
    if (role == BodyRole::hand) hand_.insert(bodies.name[b]);
    if (object >= 0 && bodies.objects[static_cast<std::size_t>(object)].name == task_.object) {
      object_.insert(bodies.name[b]);
    }
  }
  for (const SceneObject& one : bodies.objects) {
    if (one.name != task_.object) others_.push_back(one);
  }
}

/// Gives answers that `checker` calls free.
IkSolver GraspChoice::solver(ExactChecker& checker) const {
  IkOptions options{.task = task_for(robot_.arm), .valid = {}};
  options.valid = [&checker](std::span<const double> q) { return checker.is_free(q); };
  return IkSolver(robot_.arm, options);
}

/// The grasps that can be had and put down with, the best first.
std::vector<GoodGrasp> GraspChoice::choose(int turns) {
  const Result<Pose> X_WB = frame_pose(robot_.model, task_.object, open_.qpos);
  if (!X_WB) return {};
  GraspOptions how = options_.grasp;
  how.turns = turns;
  how.approach_B = X_WB->R.transpose() * -Vector3d::UnitZ();
  std::vector<GoodGrasp> all;
  for (const Grasp& grasp : find_grasps(shape_, jaws_, how).all) {
    if (std::ranges::any_of(dropped_, [&](const auto& one) { return same(one.grasp, grasp); })) {
      continue;
    }
    GoodGrasp one{.grasp = grasp, .X_WT = *X_WB * grasp.X_BT};
    const double down = -(one.X_WT.R * jaws_.approach_T).z();
    one.cost = grasp.off_center + kAside * (1 - down);
    all.push_back(std::move(one));
  }
  std::ranges::stable_sort(all, {}, &GoodGrasp::cost);
  ExactChecker checker(robot_.model, robot_.arm, {.margin = 0, .qpos = open_.qpos});
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

/// The hand and the object do not count for each other.
ContactRules GraspChoice::without_object() const {
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
Result<JointVec, Drop> GraspChoice::posture(const IkSolver& ik, const Pose& X_WT,
                                            ExactChecker& checker, bool holds) const {
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
bool GraspChoice::is_of_hand(const GeomPair& pair, bool holds) const {
  const auto moves = [&](const std::string& body) {
    return hand_.contains(body) || (holds && object_.contains(body));
  };
  const auto stands = [&](const std::string& body) {
    return !moves(body) && !links_.contains(body);
  };
  return (moves(pair.body1) && stands(pair.body2)) || (moves(pair.body2) && stands(pair.body1));
}

/// Fills in what is known of a grasp that can be had and put down with.
Result<void, Drop> GraspChoice::look_at(GoodGrasp& one, const IkSolver& ik, ExactChecker& checker) {
  const auto tried = [&](const Grasp& other) { return same(other, one.grasp); };
  if (std::ranges::any_of(options_.avoid, tried)) {
    return tl::unexpected(Drop{PickErrc::failed_before, text(msg::pick_failed_before)});
  }
  for (const Pose& X_WT : {back_from(one.X_WT), one.X_WT}) {
    auto q = posture(ik, X_WT, checker, false);
    if (!q) return tl::unexpected(std::move(q.error()));
    q_grasp_ = *q;
  }
  double clear = kClear;
  if (auto fine = keep_off(*opened_, clear); !fine) return fine;
  Result<SceneState> held = close_gripper(robot_.model, robot_.arm, as_span(q_grasp_), open_);
  const bool holds = held && held->attached.size() == 1;
  if (!holds || held->attached.front().body != task_.object) {
    return tl::unexpected(
        Drop{PickErrc::not_held, holds ? text(msg::pick_holds_other, held->attached.front().body)
                                       : text(msg::pick_holds_nothing)});
  }
  if (auto fine = look_at_closing(*held, clear); !fine) return fine;
  one.cost += kClear - clear;
  one.X_TB = held->attached.front().X_TB;
  return task_.place ? look_at_place(one, *held) : Result<void, Drop>{};
}

/// The fingers where they hold it, and on the way there.
Result<void, Drop> GraspChoice::look_at_closing(const SceneState& held, double& clear) const {
  for (const SceneObject& other : others_) {
    if (!std::equal(open_.qpos.begin() + other.qpos, open_.qpos.begin() + other.qpos + 7,
                    held.qpos.begin() + other.qpos)) {
      return tl::unexpected(Drop{PickErrc::grasp_blocked, text(msg::pick_pushes, other.name)});
    }
  }
  ExactChecker beside(robot_.model, robot_.arm,
                      {.margin = kClear, .rules = without_object(), .qpos = held.qpos});
  return keep_off(beside, clear);
}

/// Whether the hand that is about to hold the object is far enough from all else.
/// @param clear  [m] becomes less where something is nearer.
Result<void, Drop> GraspChoice::keep_off(ExactChecker& beside, double& clear) const {
  const auto report = beside.check(as_span(q_grasp_));
  if (!report || !report->nearest) return {};
  const NearestPair& near = *report->nearest;
  clear = std::min(clear, near.distance);
  if (near.distance >= options_.keep_off) return {};
  return tl::unexpected(Drop{PickErrc::grasp_blocked, text(msg::pick_too_near, near.pair.body1,
                                                           near.pair.body2, 1000 * near.distance)});
}

Result<void, Drop> GraspChoice::look_at_place(GoodGrasp& one, const SceneState& held) {
  const Pose X_BT = one.X_TB.inverse();
  const PlaceGoal& place = *task_.place;
  ExactChecker checker(
      robot_.model, robot_.arm,
      {.margin = 0, .rules = {.attached = held.attached}, .qpos = held.qpos, .rest_depth = kRest});
  const IkSolver ik = solver(checker);
  std::optional<Drop> why;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Pose& X_WB : poses_at(place)) {
    const Pose X_WT = moved(X_WB * X_BT, options_.drop * Vector3d::UnitZ());
    auto q = posture(ik, X_WT, checker, true);
    if (q && opened_) q = free_once_open(*opened_, *q);
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

Pose GraspChoice::back_from(const Pose& X_WT) const {
  return moved(X_WT, -options_.approach * (X_WT.R * jaws_.approach_T));
}
Pose GraspChoice::above(const Pose& X_WT) const {
  return moved(X_WT, options_.lift * Vector3d::UnitZ());
}

void GraspChoice::drop(const Grasp& grasp, Drop why) {
  dropped_.push_back({grasp, why.code, std::move(why.what)});
}

Result<GoodGrasp, Drop> GraspChoice::in_hand(const AttachedBody& object) {
  task_.object = object.body;
  if (const Result<Jaws> jaws = find_jaws(robot_.model, robot_.arm)) jaws_ = *jaws;
  sort_bodies(scene_bodies(robot_.model, robot_.arm));
  q_grasp_ = joint_vec(q_);
  GoodGrasp out;
  out.X_TB = object.X_TB;
  if (auto fine = look_at_place(out, scene_); !fine) return tl::unexpected(std::move(fine.error()));
  return out;
}

bool GraspChoice::stands_open() const {
  double most = 0;
  for (std::size_t k = 0; k < open_.qpos.size(); ++k) {
    most = std::max(most, std::abs(open_.qpos[k] - scene_.qpos[k]));
  }
  return most < kFingersOpen;
}

}  // namespace mjarm::program::detail
