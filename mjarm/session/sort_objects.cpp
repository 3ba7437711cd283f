#include "mjarm/session/sort_objects.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include "mjarm/core/messages/program.hpp"
#include "mjarm/core/messages/show.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/model/scene_bodies.hpp"
#include "mjarm/model/surface.hpp"

namespace mjarm::session {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// How a body stands: the middle of what is below it, on what it stands.
Vector3d foot_of(const Surface& surface, const Pose& X_WB) {
  Eigen::Array3d low = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array3d high = -low;
  for (const Vector3d& v : surface.vertices) {
    const Eigen::Array3d p_W = (X_WB * v).array();
    low = low.min(p_W);
    high = high.max(p_W);
  }
  return {(low.x() + high.x()) / 2, (low.y() + high.y()) / 2, low.z()};
}

/// Turned about the vertical by the least angle that brings the most level of a body's axes along x
/// or y, and by so many quarter turns.
Matrix3d along_the_sides(const Matrix3d& R_WB, int quarters) {
  Eigen::Index axis = 0;
  R_WB.topRows<2>().colwise().norm().maxCoeff(&axis);
  const double quarter = std::numbers::pi / 2;
  const double yaw = std::atan2(R_WB(1, axis), R_WB(0, axis));
  return from_euler({0, 0, quarter * (std::round(yaw / quarter) + quarters) - yaw}) * R_WB;
}

/// An object, and what is known of it.
struct Thing {
  SortedObject told;
  Surface surface;
  int qpos = 0;                  ///< SceneObject::qpos
  Pose X_WB = {};                ///< where it was seen last, or is thought to be
  bool is_seen = false;          ///< in the last look
  std::optional<Pose> put = {};  ///< where it was put down and not seen elsewhere since
  int failures = 0;
  std::optional<std::size_t> failed_at = {};  ///< after so many changes
};

class Sorter {
 public:
  Sorter(const Robot& robot, Sim& sim, std::span<const SortBin> bins, const SortOptions& options)
      : robot_(robot), sim_(sim), bins_(bins), options_(options) {
    for (Vantage& vantage : options_.pick.vantages) vantage.look = knowing(std::move(vantage.look));
  }

  Result<void> find_things() {
    if (!(options_.at_spot > 0) || options_.chances < 1) {
      return fail(Errc::bad_input, text(msg::sort_bad_options, options_.at_spot, options_.chances));
    }
    const std::vector<SceneObject> objects = scene_bodies(robot_.model, robot_.arm).objects;
    for (std::size_t b = 0; b < bins_.size(); ++b) {
      for (const std::string& name : bins_[b].objects) {
        Result<Surface> surface = body_surface(robot_.model, name);
        if (!surface) return fail(std::move(surface.error()));
        const auto object = std::ranges::find(objects, name, &SceneObject::name);
        if (object == objects.end()) {
          return fail(Errc::bad_input, text(msg::sort_not_free, name));
        }
        things_.push_back({.told = {.name = name, .bin = b, .spot = {}},
                           .surface = std::move(*surface),
                           .qpos = object->qpos});
      }
    }
    return {};
  }

  Result<SortOutcome> run(const Look& look) {
    const Look looking = knowing(look);
    std::string end;
    while (end.empty()) {
      Result<program::SeenScene> seen = looking(truth(), as_span(q()));
      if (!seen) return fail(std::move(seen.error()));
      take_in(std::move(*seen));
      Thing* const next = choose();
      if (next == nullptr) break;
      const Result<void> done = sort(*next, looking, end);
      if (!done) return fail(done.error());
      if (options_.after_object) options_.after_object(next->told);
      if (is_stopped(options_.pick.pick.stop)) end = stopped().what;
    }
    for (Thing& thing : things_) {
      if (!thing.told.spot && thing.told.what.empty()) thing.told.what = end;
      if (thing.told.spot) thing.told.what.clear();
      out_.objects.push_back(std::move(thing.told));
    }
    return std::move(out_);
  }

 private:
  [[nodiscard]] JointVec q() const { return sim_.arm_state(robot_.arm).q; }
  [[nodiscard]] SceneState truth() const {
    return {.qpos = {sim_.qpos().begin(), sim_.qpos().end()}, .attached = {}};
  }

  /// `look`, and what was put down stands there where it is not seen.
  [[nodiscard]] Look knowing(Look look) const {
    return [this, look = std::move(look)](const SceneState& scene, std::span<const double> at) {
      Result<program::SeenScene> seen = look(scene, at);
      for (const Thing& thing : things_) {
        if (!seen || !thing.put || seen->unseen.erase(thing.told.name) == 0) continue;
        seen->anywhere.erase(thing.told.name);
        const Quat turn = to_quat(thing.put->R);
        const Vector3d& p = thing.put->p;
        std::ranges::copy(std::array{p.x(), p.y(), p.z(), turn.w(), turn.x(), turn.y(), turn.z()},
                          seen->scene.qpos.begin() + thing.qpos);
      }
      return seen;
    };
  }

  /// Where all things are now.
  void take_in(program::SeenScene seen) {
    seen_ = std::move(seen);
    for (Thing& thing : things_) {
      const auto at = seen_.scene.qpos.begin() + thing.qpos;
      thing.X_WB = {.p = {at[0], at[1], at[2]}, .R = to_matrix(Quat(at[3], at[4], at[5], at[6]))};
      thing.is_seen = !seen_.unseen.contains(thing.told.name);
      thing.told.spot = thing.is_seen ? spot_under(thing) : std::nullopt;
      if (!thing.put || thing.told.spot) continue;
      thing.put.reset();
      thing.told.what = text(msg::sort_not_at_spot);
      ++thing.failures;
    }
  }

  [[nodiscard]] std::optional<std::size_t> spot_under(const Thing& thing) const {
    const Vector3d foot = foot_of(thing.surface, thing.X_WB);
    const std::vector<Vector3d>& spots = bins_[thing.told.bin].spots_W;
    const auto nearest = std::ranges::min_element(
        spots, {}, [&](const Vector3d& spot) { return (spot - foot).norm(); });
    if (nearest == spots.end() || (*nearest - foot).norm() > options_.at_spot) return {};
    return static_cast<std::size_t>(nearest - spots.begin());
  }

  /// The one to be tried next: seen, without failures, with much room about it. Null for none.
  Thing* choose() {
    Thing* best = nullptr;
    std::tuple<bool, int, double> least;
    for (Thing& thing : things_) {
      const bool in_vain = thing.failures >= options_.chances || thing.failed_at == changes_;
      if (thing.told.spot || in_vain) continue;
      const std::tuple rank(!thing.is_seen, thing.failures, -room_about(thing));
      if (best != nullptr && rank >= least) continue;
      best = &thing;
      least = rank;
    }
    return best;
  }

  [[nodiscard]] double room_about(const Thing& thing) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Thing& other : things_) {
      if (&other != &thing) least = std::min(least, (other.X_WB.p - thing.X_WB.p).norm());
    }
    return least;
  }

  /// Tries the free spots in turn, as long as it is the spot that will not do.
  /// @param end  gets the reason where nothing can be done any more.
  Result<void> sort(Thing& thing, const Look& look, std::string& end) {
    if (!thing.is_seen) {
      Result<program::SeenScene> seen =
          look_for(robot_, sim_, last_look_first(look), thing.told.name, options_.pick);
      if (!seen) return fail(std::move(seen.error()));
      take_in(std::move(*seen));
      if (thing.told.spot) return {};
      if (!thing.is_seen) {
        give_up(thing,
                text(msg::program_not_seen, thing.told.name, seen_.unseen.at(thing.told.name)));
        return {};
      }
    }
    std::string what = text(msg::sort_bin_full, bins_[thing.told.bin].spots_W.size());
    for (const auto& [spot, quarters] : free_places(thing.told.bin)) {
      const program::PickTask task{thing.told.name, goal_at(thing, spot, quarters)};
      const Result<PickAndPlaceOutcome> outcome =
          pick_and_place(robot_, sim_, last_look_first(look), task, options_.pick);
      if (!outcome) return fail(outcome.error());
      std::ranges::copy(outcome->tries, std::back_inserter(out_.tries));
      if (!outcome->tries.empty()) ++changes_;
      if (outcome->done) {
        thing.told.what.clear();
        thing.told.spot = spot;
        thing.put = outcome->tries.back().planned.X_WB_place;
        return {};
      }
      what = outcome->failure ? outcome->failure->what : outcome->tries.back().what;
      const bool blocked =
          !outcome->tries.empty() && outcome->tries.back().fault == GripFault::blocked;
      if (blocked) end = what;
      if (!outcome->tries.empty() || !is_of_spot(outcome->failure->code)) break;
    }
    give_up(thing, std::move(what));
    return {};
  }

  /// Until something else has moved.
  void give_up(Thing& thing, std::string what) const {
    thing.told.what = std::move(what);
    ++thing.failures;
    thing.failed_at = changes_;
  }

  /// Nothing has moved since the last look; later ones are new.
  [[nodiscard]] Look last_look_first(const Look& look) const {
    return [look, first = std::optional(seen_)](const SceneState& scene,
                                                std::span<const double> at) mutable {
      if (!first) return look(scene, at);
      return Result<program::SeenScene>(*std::exchange(first, std::nullopt));
    };
  }

  static bool is_of_spot(program::PickErrc code) {
    return code == program::PickErrc::place_out_of_reach ||
           code == program::PickErrc::place_blocked || code == program::PickErrc::no_way;
  }

  /// Free spots, and quarter turns there: all spots come before any turn.
  [[nodiscard]] std::vector<std::pair<std::size_t, int>> free_places(std::size_t bin) const {
    std::vector<std::pair<std::size_t, int>> out;
    for (const int quarters : {0, 1}) {
      for (std::size_t k = 0; k < bins_[bin].spots_W.size(); ++k) {
        const bool taken = std::ranges::any_of(things_, [&](const Thing& thing) {
          return thing.told.bin == bin && thing.told.spot == k;
        });
        if (!taken) out.emplace_back(k, quarters);
      }
    }
    return out;
  }

  /// As it rests, over the spot.
  [[nodiscard]] program::PlaceGoal goal_at(const Thing& thing, std::size_t spot,
                                           int quarters) const {
    Pose X_WB{.p = Vector3d::Zero(), .R = along_the_sides(thing.X_WB.R, quarters)};
    X_WB.p = bins_[thing.told.bin].spots_W[spot] - foot_of(thing.surface, X_WB);
    // One that looks the same in several ways is turned as the arm likes by these.
    const auto same = seen_.same.find(thing.told.name);
    const bool one_way = same == seen_.same.end() || same->second.size() <= 2;
    return {.X_WB = X_WB, .any_turn = one_way};
  }

  const Robot& robot_;
  Sim& sim_;
  std::span<const SortBin> bins_;
  SortOptions options_;
  std::vector<Thing> things_;
  program::SeenScene seen_;  ///< the last look
  std::size_t changes_ = 0;  ///< how often something was moved
  SortOutcome out_;
};

}  // namespace

std::size_t SortOutcome::placed() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(objects, [](const SortedObject& one) { return one.spot.has_value(); }));
}

Result<SortOutcome> sort_objects(const Robot& robot, Sim& sim, const Look& look,
                                 std::span<const SortBin> bins, const SortOptions& options) {
  Sorter sorter(robot, sim, bins, options);
  if (Result<void> found = sorter.find_things(); !found) return fail(std::move(found.error()));
  return sorter.run(look);
}

}  // namespace mjarm::session
