#include "apps/mjarm/commands/program_text.hpp"

#include <fmt/format.h>

#include <cmath>

#include "apps/mjarm/cli/table.hpp"
#include "apps/mjarm/messages/motion_program.hpp"
#include "mjarm/core/nearest_word.hpp"

namespace mjarm::app {
namespace {

std::string or_dash(bool known, const std::string& words) { return known ? words : "-"; }

std::string pair_of(const GeomPair& pair) { return pair.geom1 + " - " + pair.geom2; }

std::vector<std::string> row_of(const program::ProgramPlan& plan, const PlannedMove& move) {
  const Arm& arm = plan.arms[move.tool];
  const bool moves = move.measures.has_value();
  const MoveMeasures measures = move.measures.value_or(MoveMeasures{});
  const Singularity& singular = measures.singularity;
  const bool near = singular.kind != SingularKind::none;
  return {
      move.place.line > 0 ? std::to_string(move.place.line) : "-",
      move.instructions > 1 ? fmt::format("{} x{}", move.word, move.instructions) : move.word,
      fmt::format("{:.2f} s", move.trajectory.duration()),
      or_dash(move.curve.has_value(),
              fmt::format("{:.3f} m", move.curve ? move.curve->length() : 0.0)),
      or_dash(moves, fmt::format("{:.3g}{}{}", singular.smallest, near ? " " : "",
                                 describe(singular.kind))),
      or_dash(moves && measures.limit_joint >= 0,
              fmt::format("{:.3g} {}", measures.limit_room,
                          measures.limit_joint < 0
                              ? ""
                              : arm.joints[static_cast<std::size_t>(measures.limit_joint)].name)),
      or_dash(moves,
              std::isfinite(measures.clearance)
                  ? fmt::format("{:.1f} mm {}", 1e3 * measures.clearance, pair_of(measures.nearest))
                  : text(msg::motion_program_far))};
}

std::vector<std::string> held_names(const PlannedMove& move) {
  std::vector<std::string> out;
  for (const AttachedBody& one : move.attached) out.push_back(one.body);
  return out;
}

/// What the gripper holds once it has closed.
std::string grip_line(const PlannedMove& move) {
  const std::vector<std::string> names = held_names(move);
  if (names.empty()) return text(msg::motion_program_holds_nothing, move.place.line) + "\n";
  return text(msg::motion_program_holds, move.place.line, listed(names)) + "\n";
}

JsonDoc move_json(const program::ProgramPlan& plan, const PlannedMove& move) {
  const Arm& arm = plan.arms[move.tool];
  JsonDoc out = {{"line", move.place.line},
                 {"instruction", move.word},
                 {"instructions", move.instructions},
                 {"duration", move.trajectory.duration()}};
  if (move.stopping) out.set("stopping_duration", *move.stopping);
  if (move.curve) out.set("length", move.curve->length());
  if (move.close || !move.attached.empty()) out.set("holds", held_names(move));
  if (!move.measures) return out;
  const MoveMeasures& measures = *move.measures;
  out.set("min_singular_value", measures.singularity.smallest);
  out.set("singularity", std::string_view(name(measures.singularity.kind)));
  out.set("min_manipulability", measures.manipulability);
  out.set("limit_room", measures.limit_room);
  if (measures.limit_joint >= 0) {
    out.set("limit_joint", arm.joints[static_cast<std::size_t>(measures.limit_joint)].name);
  }
  out.set("clearance", measures.clearance);
  if (std::isfinite(measures.clearance)) {
    out.set("nearest", std::vector<std::string>{measures.nearest.geom1, measures.nearest.geom2});
  }
  out.set("max_joint_step", measures.max_step);
  return out;
}

JsonDoc fault_json(const program::ProgramFault& fault) {
  return {{"line", fault.place.line},
          {"column", fault.place.column},
          {"instruction", fault.word},
          {"reason", fault.reason},
          {"detail", fault.what}};
}

/// As `path` gives it, and its kind.
JsonDoc fix_json(const PathFix& fix) {
  JsonDoc out = {{"kind", std::string(name(fix.kind))}};
  const auto list = [](const auto& values) {
    return std::vector<double>(values.begin(), values.end());
  };
  switch (fix.kind) {
    case FixKind::start:
      out.set("start", list(fix.start));
      break;
    case FixKind::shift:
      out.set("shift", list(fix.change.shift));
      break;
    case FixKind::tilt:
      out.set("tilt", list(fix.change.tilt));
      break;
    case FixKind::max_step:
      out.set("max_step", fix.max_step);
      break;
    case FixKind::slower:
      out.set("slower", fix.tool_speed);
      break;
  }
  return out;
}

}  // namespace

std::string faults_text(const std::string& file, const std::vector<program::ProgramFault>& faults) {
  std::string out;
  for (const program::ProgramFault& fault : faults) out += line_of(file, fault) + "\n";
  return out;
}

JsonDoc faults_json(const std::vector<program::ProgramFault>& faults) {
  std::vector<JsonDoc> told;
  for (const program::ProgramFault& fault : faults) told.push_back(fault_json(fault));
  return {{"ok", false}, {"moves", std::vector<JsonDoc>()}, {"faults", std::move(told)}};
}

std::string plan_text(const program::LoadedProgram& loaded) {
  const program::ProgramPlan& plan = loaded.plan;
  std::vector<std::vector<std::string>> rows{
      {text(msg::motion_program_line), text(msg::motion_program_instruction),
       text(msg::motion_program_time), text(msg::motion_program_way),
       text(msg::motion_program_singular), text(msg::motion_program_room),
       text(msg::motion_program_clearance)}};
  for (const PlannedMove& move : plan.moves) rows.push_back(row_of(plan, move));
  std::string out = aligned(rows);
  for (const PlannedMove& move : plan.moves) {
    if (move.close.value_or(false)) out += grip_line(move);
  }
  for (const PlannedMove& move : plan.moves) {
    if (move.stopping && move.corners.size() > 2) {
      out += text(msg::motion_program_one_motion, move.place.line, move.trajectory.duration(),
                  *move.stopping) +
             "\n";
    }
    for (const SpeedDip& dip : move.dips) {
      out += text(msg::motion_program_dip, move.place.line, describe(dip, plan.arms[move.tool])) +
             "\n";
    }
  }
  for (const program::ProgramFault& fault : plan.faults) {
    out += line_of(loaded, fault) + "\n";
    if (!fault.detour) continue;
    out += text(msg::motion_program_detour, fault.place.line, fault.word, fault.detour->edges,
                fault.detour->duration) +
           "\n";
  }
  if (plan.ok()) out += text(msg::motion_program_total, plan.duration()) + "\n";
  return out;
}

JsonDoc plan_json(const program::LoadedProgram& loaded) {
  const program::ProgramPlan& plan = loaded.plan;
  std::vector<JsonDoc> moves, faults;
  for (const PlannedMove& move : plan.moves) moves.push_back(move_json(plan, move));
  for (const program::ProgramFault& fault : plan.faults) {
    JsonDoc& told = faults.emplace_back(fault_json(fault));
    if (fault.fix) told.set("fix", fix_json(*fault.fix));
    if (!fault.detour) continue;
    JsonDoc fix = {{"kind", "detour"},
                   {"instruction", "plan"},
                   {"edges", fault.detour->edges},
                   {"duration", fault.detour->duration}};
    if (std::isfinite(fault.detour->clearance)) fix.set("clearance", fault.detour->clearance);
    told.set("fix", std::move(fix));
  }
  return {{"ok", plan.ok()},
          {"cycle_time", plan.duration()},
          {"moves", std::move(moves)},
          {"faults", std::move(faults)}};
}

}  // namespace mjarm::app
