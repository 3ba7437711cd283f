#include "mjarm/execution/report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "mjarm/path/path_measures.hpp"

namespace mjarm {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const PoseError& error) {
  return {{"position", error.position}, {"rotation", error.rotation}};
}

void put_errors(const Report& report, Json& out) {
  if (report.path_error) {
    out["path_error_max"] = report.path_error->max;
    out["path_error_rms"] = report.path_error->rms;
    out["path_error_at"] = report.path_error->at;
  }
  if (report.static_error) out["static_error"] = to_json(*report.static_error);
  for (const NamedError& entry : report.static_errors) {
    out["static_errors"][entry.name] = to_json(entry.error);
  }
}

Json to_json(const ReportedDip& entry) {
  const SpeedDip& dip = entry.dip;
  Json out{{"s", {dip.s_from, dip.s_to}}, {"t", {dip.t_from, dip.t_to}},
           {"least", dip.least},          {"least_s", dip.s_least},
           {"joint", entry.joint},        {"limit", name(dip.limit)}};
  if (dip.kind != SingularKind::none) out["singularity"] = name(dip.kind);
  return out;
}

Json to_json(const ReportedMove& move) {
  Json out{{"line", move.line}, {"instruction", move.word}, {"duration", move.duration}};
  if (move.path_error) {
    out["path_error_max"] = move.path_error->max;
    out["path_error_rms"] = move.path_error->rms;
    out["coverage"] = move.path_error->coverage;
  }
  return out;
}

void put_planned(const Report& report, Json& out) {
  for (const ReportedDip& entry : report.speed_dips) out["speed_dips"].push_back(to_json(entry));
  if (report.min_manipulability) out["min_manipulability"] = *report.min_manipulability;
  if (report.min_singular_value) out["min_singular_value"] = *report.min_singular_value;
}

/// Keeps the least of each.
void add_measures(double manipulability, double singular_value, Report& report) {
  const auto least = [](std::optional<double>& known, double value) {
    known = std::min(known.value_or(value), value);
  };
  least(report.min_manipulability, manipulability);
  least(report.min_singular_value, singular_value);
}

void add_dips(const std::vector<SpeedDip>& dips, const Arm& arm, Report& report) {
  for (const SpeedDip& dip : dips) {
    report.speed_dips.push_back({dip, arm.joints[static_cast<std::size_t>(dip.joint)].name});
  }
}

}  // namespace

void add_motion(const ToolMotion& motion, const Arm& arm, Report& report) {
  const PathMeasures measures = measure_path(arm, motion.path.q);
  add_measures(measures.manipulability.value, measures.singular_value.value, report);
  add_dips(motion.dips, arm, report);
  report.max_joint_step = std::max(report.max_joint_step, motion.path.max_step());
}

void add_motion(const PlannedMove& move, const Arm& arm, Report& report) {
  if (!move.measures) return;
  report.max_joint_step = std::max(report.max_joint_step, move.measures->max_step);
  if (!move.curve) return;
  add_measures(move.measures->manipulability, move.measures->singularity.smallest, report);
  add_dips(move.dips, arm, report);
}

std::string to_json(const Report& report) {
  Json out;
  out["name"] = report.name;
  out["model"] = report.model;
  out["ok"] = report.ok;
  if (!report.ok) {
    out["reason"] = report.reason;
    out["detail"] = report.detail;
  }
  if (!report.control.empty()) out["control"] = report.control;
  out["duration"] = report.duration;
  out["steps"] = report.steps;
  put_errors(report, out);
  out["coverage"] = report.done;
  out["max_joint_step"] = report.max_joint_step;
  if (report.tool_speed_max) out["tool_speed_max"] = *report.tool_speed_max;
  put_planned(report, out);
  out["limits_used"] = {{"velocity", report.velocity_use},
                        {"torque", report.torque_use},
                        {"saturated_steps", report.saturated_steps}};
  out["first_contact"] = report.first_contact.empty() ? Json() : Json(report.first_contact);
  if (!report.unreachable.empty()) out["unreachable"] = report.unreachable;
  if (report.shift) out["fix"]["shift"] = {report.shift->x(), report.shift->y(), report.shift->z()};
  for (const Fact& fact : report.facts) {
    std::visit([&](const auto& value) { out[fact.name] = value; }, fact.value);
  }
  for (const ReportedMove& move : report.moves) out["moves"].push_back(to_json(move));
  if (report.rtf) out["rtf"] = *report.rtf;
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace mjarm
