#include "apps/bench/calligraphy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "apps/bench/suite.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "mjarm/core/utf8.hpp"
#include "mjarm/execution/execution.hpp"
#include "mjarm/path/letters.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/program/program_plan.hpp"
#include "mjarm/program/program_reader.hpp"

namespace mjarm::app {
namespace {

// The most frequent ones of written Chinese, in that order.
constexpr std::string_view kCommon =
    "的一是不了在人有我他这个们中来上大为和国地到以说时要就出会可也你对生能而子那得于着下自之"
    "年过发后作里用道行所然家种事成方多经么去法学如都同现当没动面起看定天分还进好小部其些主样"
    "理心她本前开但因只从想实";
constexpr double kHeight = 0.06;                   // [m] of a character
const Eigen::Vector3d kCorner(-0.03, -0.5, 0.08);  // [m] lower left of a character on the sheet

constexpr double kDegree = std::numbers::pi / 180;
constexpr Sheet kSheets[] = {{0, 0}, {2.5 * kDegree, 0}, {5 * kDegree, 0}, {5 * kDegree, 0.3}};

/// The shipped program with another text, up to its end.
program::Program writing(program::Program program, const std::string& text) {
  auto& what = std::get<program::DrawText>(program.instructions.front().what);
  what.text = text;
  what.height = kHeight;
  what.plane.X_FT.p = kCorner;
  program.instructions.erase(program.instructions.begin() + 1, program.instructions.end());
  return program;
}

/// A world of its own in which the sheet is tilted, half about each axis.
Sim world_of(const Model& world, const Arm& arm, const Sheet& sheet, const MotionPlan& plan) {
  Sim sim(world);
  sim.reset_home();
  std::vector<double> qpos(sim.qpos().begin(), sim.qpos().end());
  // The joints of the sheet are the first ones of the file.
  qpos[0] = sheet.tilt / std::numbers::sqrt2;
  qpos[1] = -qpos[0];
  sim.set_state(qpos, std::vector<double>(sim.qvel().size(), 0.0));
  sim.place(arm, as_span(plan.q_start));
  return sim;
}

/// Adds what one character came to; its squares are summed up in `ink_rms`, `points` of them.
Result<void> write_one(const Robot& robot, const Model& world, const MotionPlan& plan,
                       SheetResult& out, std::size_t& points) {
  Sim sim = world_of(world, robot.arm, out.sheet, plan);
  Result<Execution> execution =
      Execution::create(robot.model, plan, {.control = ControlMode::tool_impedance});
  if (!execution) return fail(std::move(execution.error()));
  const auto done = execution->run_to_end(sim, [](const Sim&) { return !interrupted(); });
  if (!done) return fail(done.error());
  if (done->stopped) return fail(stopped());
  for (const InkPoint& point : execution->presser()->ink()) {
    out.ink_max = std::max(out.ink_max, point.off);
    out.ink_rms += point.off * point.off;
    ++points;
  }
  for (const PressedStroke& stroke : execution->presser()->strokes()) {
    ++out.strokes;
    out.landing = std::max(out.landing, stroke.landing);
    if (!stroke.touched) {
      ++out.missed;
      continue;
    }
    out.least = std::min(out.least, stroke.least);
    out.most = std::max(out.most, stroke.most);
  }
  ++out.characters;
  return {};
}

}  // namespace

int sheet_count() { return static_cast<int>(std::size(kSheets)); }

Result<std::vector<SheetResult>> write_characters(int count, const std::function<void()>& advance) {
  const auto shipped = program::find_shipped_program("calligraphy").and_then([](const auto& file) {
    return program::read_program(file);
  });
  if (!shipped) return fail(shipped.error());
  const Result<Robot> robot = program::load_program_robot(*shipped, "");
  if (!robot) return fail(robot.error());
  std::vector<SheetResult> out;
  std::vector<Model> worlds;
  std::vector<std::size_t> points(std::size(kSheets), 0);
  for (const Sheet& sheet : kSheets) {
    out.push_back({.sheet = sheet, .least = std::numeric_limits<double>::infinity()});
    Result<Model> world = robot->model;
    if (sheet.payload > 0) world = robot->model.with_point_mass(robot->arm.tip, sheet.payload);
    if (!world) return fail(std::move(world.error()));
    worlds.push_back(std::move(*world));
  }
  if (count > 0) {
    const auto strokes = letter_strokes(kCommon, kHeight);
    if (!strokes) return fail(strokes.error());
  }
  std::string_view left = kCommon;
  for (int i = 0; i < count && !left.empty(); ++i) {
    const std::size_t bytes = utf8_length(left);
    const std::string character(left.substr(0, bytes));
    left.remove_prefix(bytes);
    const program::ProgramPlan plan =
        program::plan_program(robot->model, robot->arm, writing(*shipped, character));
    if (!plan.ok()) return fail(plan.faults.front().code, plan.faults.front().what);
    for (std::size_t k = 0; k < out.size(); ++k) {
      if (auto done = write_one(*robot, worlds[k], plan, out[k], points[k]); !done) {
        return fail(std::move(done.error()));
      }
      advance();
    }
  }
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].ink_rms =
        std::sqrt(out[k].ink_rms / static_cast<double>(std::max<std::size_t>(1, points[k])));
  }
  return out;
}

}  // namespace mjarm::app
