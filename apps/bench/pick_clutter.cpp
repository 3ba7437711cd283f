#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <span>
#include <utility>

#include "apps/bench/pick_scenes.hpp"
#include "apps/bench/suite.hpp"
#include "mjarm/model/scene_bodies.hpp"
#include "mjarm/perception/find_objects.hpp"
#include "mjarm/perception/symmetry.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::app {
namespace {

constexpr double kToSpare = 1e-3;  // [m] beside the fingers: more than a look is wrong by
constexpr int kDraws = 200;        // of a place for one object, before the scene is begun anew

/// Puts all objects of a scene on the table, some of them beside each other.
class Clutter {
 public:
  explicit Clutter(const Robot& robot)
      : robot_(robot), objects_(scene_bodies(robot.model, robot.arm).objects), sim_(robot.model) {
    for (const SceneObject& object : objects_) {
      const auto known = perception::known_object(robot.model, object.name);
      if (known) same_[object.name] = perception::symmetries(known->surface);
    }
  }

  Result<PickProblem> draw(Rng& rng) {
    int passed_over = 0;
    while (true) {
      PickProblem out{.seed = rng.next()};
      const std::vector<Rest> rests = put_all(rng, out);
      if (choose(rng, rests, out, passed_over)) {
        out.passed_over = passed_over;
        return out;
      }
      if (interrupted()) return fail(stopped());
    }
  }

 private:
  /// @return how each object rests.
  std::vector<Rest> put_all(Rng& rng, PickProblem& out) {
    std::vector<Rest> rests;
    while (out.objects.size() < objects_.size()) {
      if (out.objects.empty()) begin();
      const SceneObject& object = objects_[out.objects.size()];
      rests.resize(out.objects.size());
      rests.push_back(random_rest(rng, object.name));
      if (const auto pose = put(rng, object, rests.back(), out.objects)) {
        out.objects.push_back({object.name, *pose});
      } else {
        out.objects.clear();
      }
    }
    return rests;
  }

  /// All objects out of each other's way.
  void begin() {
    sim_.reset_home();
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      sim_.place_free(objects_[i].name, {.p = {10 + static_cast<double>(i), 0, 10}});
    }
  }

  std::optional<Pose> put(Rng& rng, const SceneObject& object, const Rest& rest,
                          const std::vector<PlacedObject>& others) {
    for (int i = 0; i < kDraws; ++i) {
      const Pose pose = others.empty() || rng.below(2) == 0
                            ? somewhere_on_table(rng, rest)
                            : beside(rng, object, rest, others[rng.below(others.size())].X_WB);
      sim_.place_free(object.name, pose);
      if (is_on_table(pose.p.x(), pose.p.y()) && !touches(object)) return pose;
    }
    return {};
  }

  /// As near to another object as it gets in a random direction, or some millimetres off.
  Pose beside(Rng& rng, const SceneObject& object, const Rest& rest, const Pose& other) {
    constexpr int kHalvings = 16;
    const double way = rng.uniform(-std::numbers::pi, std::numbers::pi);
    const double yaw = rng.uniform(-std::numbers::pi, std::numbers::pi);
    const double gap = rng.below(2) == 0 ? 2e-4 : rng.uniform(1e-3, 6e-3);
    const auto at = [&](double far) {
      return on_table(rest, other.p.x() + far * std::cos(way), other.p.y() + far * std::sin(way),
                      yaw);
    };
    double touching = 0, free = 0.15;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = (touching + free) / 2;
      sim_.place_free(object.name, at(middle));
      (touches(object) ? touching : free) = middle;
    }
    return at(free + gap);
  }

  /// Anything but what it rests on.
  [[nodiscard]] bool touches(const SceneObject& object) const {
    const std::vector<Contact> contacts = sim_.contacts();
    return std::ranges::any_of(contacts, [&](const Contact& contact) {
      if (contact.body1 != object.body && contact.body2 != object.body) return false;
      return contact.first != "table_top" && contact.second != "table_top";
    });
  }

  /// One that can be had, and its place.
  bool choose(Rng& rng, const std::vector<Rest>& rests, PickProblem& out, int& passed_over) {
    std::vector<std::size_t> left(objects_.size());
    for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
    const SceneState truth{.qpos = {sim_.qpos().begin(), sim_.qpos().end()}, .attached = {}};
    while (!left.empty() && !interrupted()) {
      const std::size_t k = rng.below(left.size());
      const std::size_t target = left[k];
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(k));
      out.task = {.object = objects_[target].name, .place = somewhere_in_tray(rng, rests[target])};
      program::PickTask task = out.task;
      task.place->same = same_[task.object];
      if (program::plan_pick(robot_, truth, as_span(robot_.arm.home), task,
                             {.keep_off = kToSpare, .stop = interrupted})) {
        return true;
      }
      ++passed_over;
    }
    return false;
  }

  Robot robot_;
  std::vector<SceneObject> objects_;
  Sim sim_;
  std::map<std::string, std::vector<Pose>> same_;
};

}  // namespace

Result<PickSet> clutter_scenes(const std::string& robot, std::uint64_t seed) {
  const char* file =
      robot == "panda" ? "franka_emika_panda/clutter.xml" : "universal_robots_ur5e/clutter.xml";
  Result<Robot> loaded = mjarm::load_robot(file);
  if (!loaded) return fail(std::move(loaded.error()));
  auto clutter = std::make_shared<Clutter>(*loaded);
  return PickSet{.name = "clutter",
                 .robot = robot,
                 .loaded = std::move(*loaded),
                 .draw = [seed, clutter](std::uint64_t i) {
                   Rng rng(seed, i);
                   return clutter->draw(rng);
                 }};
}

}  // namespace mjarm::app
