#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "mjarm/core/messages/episode.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/core/shuffle.hpp"
#include "mjarm/episode/draw_looks_internal.hpp"
#include "mjarm/episode/plan_chain_internal.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/program/pick_place.hpp"

namespace mjarm::episode {
namespace {

constexpr std::size_t kOfAKind = 5, kSpots = 6;  // in scenes/sort.xml
constexpr std::size_t kToSort = 3;               // that do not lie in their bins yet
constexpr double kSortTable = 0.2;               // [m] height of the table
constexpr double kSortApart = 0.11;              // [m] between the middles of two that are to go
constexpr int kMaxSortDraws = 10000;             // of a place beside the others
constexpr double kAtSpot = 0.01;                 // [m] from its spot

constexpr DrawRange kSortX{"object_x", "m", 0.35, 0.57};
constexpr DrawRange kSortY{"object_y", "m", -0.14, 0.14};
constexpr DrawRange kSortYaw{"object_yaw", "rad", -std::numbers::pi, std::numbers::pi};

/// A kind of the scene's objects; bodies and sites begin with its name.
struct SortKind {
  const char* name;
  double height;  // [m] of its middle above what it stands on
  bool is_round;  // about the vertical; else it has four sides
};
constexpr SortKind kSortKinds[] = {{"cube", 0.018, false}, {"can", 0.035, true}};

/// An object, and the spot in its bin that is for it.
struct SortObject {
  const SortKind* kind = nullptr;
  Pose X_WB_spot;
  bool to_sort = false;
};

/// What is drawn of the table.
struct SortTable {
  DrawnScene scene;
  std::vector<SortObject> objects;  ///< in the order of those of the scene
};

/// Things of two kinds into the bins of their kinds.
class SortTask final : public Task {
 public:
  explicit SortTask(SortTable table)
      : Task(std::move(table.scene)), objects_(std::move(table.objects)) {}

  /// Whatever can be had goes next, so that one that another stands before waits.
  [[nodiscard]] TaskPlan plan(const PlanInput& input) const override {
    PlanChain chain(input, scene().q);
    std::vector<std::size_t> left;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      if (objects_[i].to_sort) left.push_back(i);
    }
    while (!left.empty()) {
      std::string reason;
      const auto next = std::ranges::find_if(left, [&](std::size_t i) {
        auto planned = program::plan_pick(input.robot, chain.scene(), as_span(chain.q()),
                                          pick_task(i), {.stop = input.stop});
        if (planned) {
          chain.append(std::move(planned->plan));
        } else {
          reason = name(planned.error().code);
        }
        return planned.has_value();
      });
      if (next == left.end()) {
        chain.refuse(std::move(reason));
        break;
      }
      left.erase(next);
    }
    return std::move(chain).finish(objects_[scene().target].X_WB_spot);
  }

  [[nodiscard]] Verdict judge(const SceneEnd& end) const override {
    Verdict out;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      const SortObject& one = objects_[i];
      const Pose& X_WB = end.X_WB[i];
      if (!one.to_sort) {
        out.others = std::max(out.others, (X_WB.p - scene().objects[i].X_WB.p).norm());
        continue;
      }
      out.position = std::max(out.position, (X_WB.p - one.X_WB_spot.p).norm());
      const double upright = std::clamp(X_WB.R(2, 2), -1.0, 1.0);
      out.rotation = std::max(out.rotation, std::acos(upright));
    }
    // The comparisons are false for what is no number.
    if (!(out.position <= kAtSpot && out.rotation <= kTurnedAtGoal)) {
      out.reason = "off_goal";
    } else if (!(out.others <= kOthersMoved)) {
      out.reason = "others_moved";
    }
    return out;
  }

  [[nodiscard]] JsonDoc goal_json(const Pose& goal) const override {
    std::vector<JsonDoc> places;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      if (!objects_[i].to_sort) continue;
      JsonDoc one = pose_json(objects_[i].X_WB_spot);
      one.set("name", scene().objects[i].name);
      places.push_back(std::move(one));
    }
    JsonDoc out = pose_json(goal);
    out.set("places", std::move(places));
    return out;
  }

 private:
  [[nodiscard]] program::PickTask pick_task(std::size_t i) const {
    const SortObject& one = objects_[i];
    program::PlaceGoal place{.X_WB = one.X_WB_spot, .any_turn = one.kind->is_round};
    for (int k = 0; k < 4 && !one.kind->is_round; ++k) {
      Pose turn;
      turn.R = from_euler({0, 0, 0.5 * k * std::numbers::pi});
      place.same.push_back(turn);
    }
    return {.object = scene().objects[i].name, .place = std::move(place)};
  }

  std::vector<SortObject> objects_;
};

/// Numbers 0 to n - 1 in any order.
std::vector<std::size_t> shuffled(Rng& rng, std::size_t n) {
  std::vector<std::size_t> out(n);
  std::iota(out.begin(), out.end(), std::size_t{0});
  shuffle(out, rng);
  return out;
}

/// Every object with a spot of its own in its bin.
std::vector<SortObject> draw_spots(Rng& rng, const Robot& robot, DrawnScene& out) {
  std::vector<SortObject> objects;
  for (const SortKind& kind : kSortKinds) {
    const std::vector<std::size_t> order = shuffled(rng, kSpots);
    for (std::size_t i = 0; i < kOfAKind; ++i) {
      const std::string name = kind.name;
      const auto spot = frame_pose(robot.model, name + "_spot" + std::to_string(order[i] + 1));
      SortObject one{.kind = &kind, .X_WB_spot = {.p = spot ? spot->p : Eigen::Vector3d::Zero()}};
      one.X_WB_spot.p.z() += kind.height;
      out.objects.push_back({name + std::to_string(i + 1), one.X_WB_spot, {}, {}});
      objects.push_back(one);
    }
  }
  return objects;
}

/// Some of them stand between the bins instead.
void take_out(Rng& rng, std::vector<SortObject>& objects, DrawnScene& out) {
  const std::vector<std::size_t> order = shuffled(rng, objects.size());
  std::vector<Eigen::Vector2d> taken;
  for (std::size_t k = 0; k < kToSort; ++k) {
    Eigen::Vector2d p;
    for (int i = 0; i < kMaxSortDraws; ++i) {
      p.x() = drawn(rng, kSortX);
      p.y() = drawn(rng, kSortY);
      const auto is_apart = [&](const Eigen::Vector2d& q) { return (q - p).norm() >= kSortApart; };
      if (std::ranges::all_of(taken, is_apart)) break;
    }
    taken.push_back(p);
    SortObject& one = objects[order[k]];
    one.to_sort = true;
    out.objects[order[k]].X_WB = {.p = {p.x(), p.y(), kSortTable + one.kind->height},
                                  .R = from_euler({0, 0, drawn(rng, kSortYaw)})};
  }
  out.target = order[0];
}

/// A colour for each kind.
std::vector<const NamedColor*> color_kinds(Rng& rng, const std::vector<SortObject>& objects,
                                           DrawnScene& out) {
  ColorBox box;
  std::vector<const NamedColor*> colors;
  for (std::size_t k = 0; k < std::size(kSortKinds); ++k) colors.push_back(&box.take(rng));
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const auto kind = static_cast<std::size_t>(objects[i].kind - kSortKinds);
    paint(rng, *colors[kind], out.objects[i], out.looks);
  }
  return colors;
}

std::unique_ptr<Task> draw_sort(const Robot& robot, EpisodeRng& rng) {
  SortTable table;
  DrawnScene& scene = table.scene;
  table.objects = draw_spots(rng.scene, robot, scene);
  take_out(rng.scene, table.objects, scene);
  draw_start(rng.scene, robot.arm, scene);

  const std::vector<const NamedColor*> colors = color_kinds(rng.looks, table.objects, scene);
  constexpr const char* kFurniture[] = {"table_top", "cube_bin_floor", "can_bin_floor"};
  draw_grays(rng.looks, kFurniture, scene);
  draw_light(rng.looks, scene);
  constexpr double kFromFront = std::numbers::pi - 0.45;  // beside the camera of the scene
  const DrawnView nominal[] = {
      {"front",
       {.lookat_W = {0.44, 0, 0.28}, .distance = 1.2, .azimuth = kFromFront, .elevation = -0.75}},
      {"side",
       {.lookat_W = {0.44, 0, 0.26}, .distance = 1.3, .azimuth = -2.2, .elevation = -0.75}}};
  draw_views(rng.looks, nominal, scene);
  tell_task(
      msg::episode_sort,
      [&](Language language) {
        return std::vector<std::string>{std::string(colors[0]->name.in(language)),
                                        std::string(colors[1]->name.in(language))};
      },
      scene);
  return std::make_unique<SortTask>(std::move(table));
}

}  // namespace

TaskKind sort_task() {
  return {"sort", "sort.xml", with_looks_ranges({kSortX, kSortY, kSortYaw}), draw_sort};
}

}  // namespace mjarm::episode
