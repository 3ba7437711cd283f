#include "apps/bench/pick_creep.hpp"

#include <fmt/format.h>

#include <array>
#include <numbers>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/pick.hpp"
#include "apps/bench/suite.hpp"
#include "apps/mjarm/cli/table.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm::app {
namespace {

/// A part and how it lies in the tool's frame.
struct Part {
  const char* name;
  Pose X_TB = {};
};
/// The can lies across the hand, into which it would reach otherwise.
const std::array kParts{Part{"cube"}, Part{"can", {.R = from_euler({0, std::numbers::pi / 2, 0})}},
                        Part{"prism"}};
constexpr double kRobotStep = 0.002;  ///< [s] the time step of robots alone
constexpr std::size_t kSteps = 3;     ///< that one, the scene's and half of it

constexpr double kMostAtRest = 1e-4;   // [m]
constexpr double kMostCarried = 5e-4;  // [m]
constexpr double kLeastFallen = 0.05;  // [m] out of the fingers

/// Holds a part in a changed scene.
Result<HeldPart> grip_in(const Robot& scene, const PhysicsChange& change, const Part& part) {
  Result<Model> model = scene.model.with_physics(change);
  if (!model) return fail(std::move(model.error()));
  return HeldPart::grip({std::move(*model), scene.arm}, part.name, part.X_TB, interrupted);
}

Result<HoldVerdict> hold(const Robot& scene, const Part& part, double timestep,
                         const HoldTimes& times) {
  HoldVerdict out{
      .part = part.name, .timestep = timestep, .own_step = timestep == scene.model.timestep()};
  Result<HeldPart> held = grip_in(scene, {.timestep = timestep}, part);
  if (!held) return fail(std::move(held.error()));
  const Result<Creep> rest = held->rest(times.rest);
  if (!rest) return fail(rest.error());
  out.rest = *rest;
  const Result<Creep> carried = held->carry(times.carry());
  if (!carried) return fail(carried.error());
  out.carried = *carried;
  return out;
}

/// The control: HoldVerdict::fallen.
Result<double> drop(const Robot& scene, const Part& part) {
  const Result<HeldPart> icy = grip_in(scene, {.friction = 0}, part);
  if (!icy) return fail(icy.error());
  return icy->in_tool().p.norm();
}

std::string millimetres(const Creep& creep) {
  return fmt::format("{:.4f} mm, {:.3f} deg", 1e3 * creep.moved, in_degrees(creep.turned));
}

JsonDoc to_json(const Creep& creep) {
  return {{"moved", creep.moved}, {"turned", creep.turned}, {"fastest", creep.fastest}};
}

}  // namespace

Result<std::vector<HoldVerdict>> measure_creep(const std::string& robot, const HoldTimes& times) {
  std::vector<HoldVerdict> out;
  Progress progress(text(msg::bench_creep_progress),
                    (robot.empty() ? 2 : 1) * kParts.size() * kSteps);
  for (const auto& [name, file] : {std::pair("ur5e", "universal_robots_ur5e/hold.xml"),
                                   std::pair("panda", "franka_emika_panda/hold.xml")}) {
    if (!robot.empty() && robot != name) continue;
    const Result<Robot> scene = mjarm::load_robot(file);
    if (!scene) return fail(scene.error());
    for (const Part& part : kParts) {
      const Result<double> fallen = drop(*scene, part);
      if (!fallen) return fail(fallen.error());
      const double own = scene->model.timestep();
      for (const double step : std::array<double, kSteps>{kRobotStep, own, own / 2}) {
        Result<HoldVerdict> verdict = hold(*scene, part, step, times);
        if (!verdict) return fail(std::move(verdict.error()));
        verdict->robot = name;
        verdict->fallen = *fallen;
        out.push_back(std::move(*verdict));
        progress.advance();
      }
    }
  }
  return out;
}

bool HoldVerdict::is_good() const {
  return rest.moved < kMostAtRest && carried.moved < kMostCarried && fallen > kLeastFallen;
}

std::string creep_table(std::span<const HoldVerdict> verdicts, const HoldTimes& times) {
  std::vector<std::vector<std::string>> rows{
      {text(msg::bench_pick_robot), text(msg::bench_creep_part), text(msg::bench_creep_step),
       text(msg::bench_creep_rest, times.rest), text(msg::bench_creep_carried, times.carry()),
       text(msg::bench_creep_fastest), text(msg::bench_creep_fallen), text(msg::bench_creep_good)}};
  for (const HoldVerdict& one : verdicts) {
    const double step_ms = 1e3 * one.timestep;
    std::string step =
        one.own_step ? text(msg::bench_creep_own, step_ms) : fmt::format("{:g}", step_ms);
    rows.push_back({one.robot, one.part, std::move(step), millimetres(one.rest),
                    millimetres(one.carried), fmt::format("{:.2f}", one.carried.fastest),
                    fmt::format("{:.0f}", 1e3 * one.fallen),
                    text(one.is_good() ? msg::bench_creep_yes : msg::bench_creep_no)});
  }
  return markdown_table(rows);
}

JsonDoc creep_json(std::span<const HoldVerdict> verdicts) {
  std::vector<JsonDoc> out;
  for (const HoldVerdict& one : verdicts) {
    out.push_back({{"robot", one.robot},
                   {"part", one.part},
                   {"timestep", one.timestep},
                   {"own_step", one.own_step},
                   {"rest", to_json(one.rest)},
                   {"carried", to_json(one.carried)},
                   {"fallen", one.fallen},
                   {"good", one.is_good()}});
  }
  return out;
}

}  // namespace mjarm::app
