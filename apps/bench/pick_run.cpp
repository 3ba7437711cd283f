#include <algorithm>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/pick.hpp"
#include "apps/bench/suite.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/session/pick_and_place.hpp"
#include "mjarm/session/see_scene.hpp"

namespace mjarm::app {
namespace {

constexpr double kPlaced = 5e-3;        // [m]
constexpr double kPlacedTurn = 0.0873;  // [rad] 5 deg
constexpr double kMoved = 1e-3;         // [m] that nothing else may be moved by

/// A world of one problem, and what is true in it.
class PickWorld {
 public:
  PickWorld(const PickSet& set, const PickProblem& problem)
      : problem_(problem),
        sim_(set.loaded.model),
        bodies_(scene_bodies(set.loaded.model, set.loaded.arm)) {
    sim_.reset_home();
    sim_.hold_others(set.loaded.arm);
    for (const PlacedObject& object : problem.objects) sim_.place_free(object.name, object.X_WB);
  }

  [[nodiscard]] Sim& sim() { return sim_; }
  [[nodiscard]] Pose pose(const std::string& object) const {
    const auto found = std::ranges::find(bodies_.objects, object, &SceneObject::name);
    return sim_.body_pose(found->body);
  }

  /// How far off what was seen is.
  void judge_look(const perception::FoundScene& found, PickVerdict& out) const {
    for (const perception::FoundObject& one : found.objects) {
      if (!one.pose) continue;
      const Pose X_WB = pose(one.name);
      out.seen_position = std::max(out.seen_position, (one.pose->X_WO.p - X_WB.p).norm());
      out.seen_rotation =
          std::max(out.seen_rotation, turn_between(one.name, one.pose->X_WO.R, X_WB.R));
    }
  }

  void judge(PickVerdict& out) const {
    const Pose X_WB = pose(problem_.task.object), &place = problem_.task.place->X_WB;
    out.position = (X_WB.p - place.p).norm();
    out.rotation = turn_between(problem_.task.object, X_WB.R, place.R);
    for (const PlacedObject& object : problem_.objects) {
      if (object.name == problem_.task.object) continue;
      out.others = std::max(out.others, (pose(object.name).p - object.X_WB.p).norm());
    }
    if (!out.miss.empty()) return;
    if (out.position > kPlaced || out.rotation > kPlacedTurn) {
      out.miss = text(msg::bench_pick_off, 1e3 * out.position, in_degrees(out.rotation));
    } else if (out.others > kMoved) {
      out.miss = text(msg::bench_pick_moved, 1e3 * out.others);
    }
    out.placed = out.miss.empty();
  }

 private:
  const PickProblem& problem_;
  Sim sim_;
  SceneBodies bodies_;
};

/// What is wrong with how it was done, whatever came of it.
std::string fault_of(const session::PickAndPlaceOutcome& outcome) {
  if (outcome.failure) {
    return std::string(name(outcome.failure->code)) + ": " + outcome.failure->what;
  }
  if (!outcome.done) return outcome.tries.back().what;
  const session::PickTry& last = outcome.tries.back();
  for (const ObservedObject& object : last.objects) {
    if (object.fault != ObjectFault::none) return describe(object);
  }
  if (last.contact) {
    return text(msg::bench_pick_contact, last.contact->contact.first, last.contact->contact.second);
  }
  return {};
}

/// Where the camera at the wrist sees all of the things, from straight above; turned in four ways,
/// as one may be out of reach.
std::vector<Pose> over_the_table() {
  std::vector<Pose> out;
  for (int k = 0; k < 4; ++k) {
    const double yaw = std::numbers::pi * k / 2;
    out.push_back({.p = {0.49, 0.18, 0.58}, .R = from_euler({std::numbers::pi, 0, yaw})});
  }
  return out;
}

}  // namespace

Result<PickVerdict> solve_pick(const PickSet& set, const PickProblem& problem) {
  Result<session::SceneEye> eye =
      session::SceneEye::open(set.loaded, "rgbd", {.seed = problem.seed});
  if (!eye) return fail(std::move(eye.error()));
  PickWorld world(set, problem);
  PickVerdict out{.object = problem.task.object, .passed_over = problem.passed_over};
  const auto look_with = [&](session::SceneEye& with, const SceneState& scene,
                             std::span<const double> q) {
    Result<program::SeenScene> seen = with.look(scene, q);
    if (seen) world.judge_look(with.found(), out);
    return seen;
  };
  const session::Look look = [&](const SceneState& scene, std::span<const double> q) {
    return look_with(*eye, scene, q);
  };
  // Opened where it is needed: most things are seen without it.
  std::optional<session::SceneEye> wrist;
  const session::Look from_above = [&](const SceneState& scene,
                                       std::span<const double> q) -> Result<program::SeenScene> {
    if (!wrist) {
      auto opened = session::SceneEye::open(set.loaded, "wrist", {.seed = problem.seed + 1});
      if (!opened) return fail(std::move(opened.error()));
      wrist = std::move(*opened);
    }
    return look_with(*wrist, scene, q);
  };
  session::PickAndPlaceOptions options{.pick = {.stop = interrupted}};
  for (const Pose& X_WT : over_the_table()) {
    options.vantages.push_back({X_WT, from_above});
  }
  const auto outcome =
      session::pick_and_place(set.loaded, world.sim(), look, problem.task, options);
  if (interrupted()) return fail(stopped());
  if (!outcome) return fail(outcome.error());
  out.tries = outcome->tries.size();
  for (const session::PickTry& one : outcome->tries) out.seconds += one.seconds;
  out.miss = fault_of(*outcome);
  world.judge(out);
  return out;
}

}  // namespace mjarm::app
