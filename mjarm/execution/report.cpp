#include "mjarm/execution/report.hpp"

#include <algorithm>

#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/path/path_measures.hpp"

namespace mjarm {
namespace {

JsonDoc to_json(const PoseError& error) {
  return {{"position", error.position}, {"rotation", error.rotation}};
}

void put_errors(const Report& report, JsonDoc& out) {
  if (report.path_error) {
    out.set("path_error_max", report.path_error->max);
    out.set("path_error_rms", report.path_error->rms);
    out.set("path_error_at", report.path_error->at);
  }
  if (report.static_error) out.set("static_error", to_json(*report.static_error));
  if (report.static_errors.empty()) return;
  JsonDoc errors;
  for (const NamedError& entry : report.static_errors) {
    errors.set(entry.name.c_str(), to_json(entry.error));
  }
  out.set("static_errors", std::move(errors));
}

JsonDoc to_json(const ReportedDip& entry) {
  const SpeedDip& dip = entry.dip;
  JsonDoc out{{"s", {dip.s_from, dip.s_to}}, {"t", {dip.t_from, dip.t_to}},
              {"least", dip.least},          {"least_s", dip.s_least},
              {"joint", entry.joint},        {"limit", name(dip.limit)}};
  if (dip.kind != SingularKind::none) out.set("singularity", name(dip.kind));
  return out;
}

JsonDoc to_json(const ReportedMove& move) {
  JsonDoc out{{"line", move.line}, {"instruction", move.word}, {"duration", move.duration}};
  if (move.stopping) out.set("stopping_duration", *move.stopping);
  if (move.path_error) {
    out.set("path_error_max", move.path_error->max);
    out.set("path_error_rms", move.path_error->rms);
    out.set("coverage", move.path_error->coverage);
  }
  return out;
}

JsonDoc to_json(const ObservedObject& object) {
  JsonDoc out{{"name", object.name},         {"ok", object.fault == ObjectFault::none},
              {"carried", object.carried},   {"moved", object.moved},
              {"off_plan", object.off_plan}, {"turned", object.turned},
              {"fell", object.fell}};
  if (object.fault != ObjectFault::none) out.set("reason", std::string(name(object.fault)));
  if (object.at) out.set("at", *object.at);
  if (!object.touched.empty()) {
    out.set("touched", {{"what", object.touched}, {"at", object.touched_at}});
  }
  if (object.by_itself) out.set("by_itself", true);
  return out;
}

JsonDoc to_json(const HeldState& held) {
  JsonDoc out{{"joint", held.joint.name}};
  out.set("by", held.joint.actuator ? "actuator" : "lock");
  if (held.joint.actuator) out.set("actuator", held.joint.actuator->name);
  out.set("moved", held.moved);
  return out;
}

JsonDoc to_json(const std::map<std::string, double>& figures) {
  JsonDoc out{std::initializer_list<JsonDoc::Member>{}};
  for (const auto& [name, value] : figures) out.set(name.c_str(), value);
  return out;
}

/// A list as member `key`; nothing for an empty one.
template <class List, class ToDoc>
void put_list(const char* key, const List& list, const ToDoc& to_doc, JsonDoc& out) {
  std::vector<JsonDoc> docs;
  for (const auto& entry : list) docs.push_back(to_doc(entry));
  if (!docs.empty()) out.set(key, std::move(docs));
}

void put_planned(const Report& report, JsonDoc& out) {
  put_list("speed_dips", report.speed_dips, [](const auto& dip) { return to_json(dip); }, out);
  if (report.min_manipulability) out.set("min_manipulability", *report.min_manipulability);
  if (report.min_singular_value) out.set("min_singular_value", *report.min_singular_value);
}

void put_fact(const Fact& fact, JsonDoc& out) {
  const char* const key = fact.name.c_str();
  if (const auto* const figures = std::get_if<std::map<std::string, double>>(&fact.value)) {
    out.set(key, to_json(*figures));
  } else if (const auto* const word = std::get_if<std::string>(&fact.value)) {
    out.set(key, *word);
  } else {
    out.set(key, std::get<double>(fact.value));
  }
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

void put_outcome(const FollowOutcome& total, Report& report) {
  report.duration = total.duration;
  report.steps = static_cast<long>(total.steps);
  report.velocity_use = total.velocity_use;
  report.torque_use = total.torque_use;
  report.saturated_steps = static_cast<long>(total.limited_steps);
  if (!total.first_contact) return;
  const Contact& contact = total.first_contact->contact;
  report.first_contact =
      contact.first + " - " + contact.second + " at " + number(total.first_contact->time) + " s";
}

std::string to_json(const Report& report) {
  JsonDoc out{{"name", report.name}, {"model", report.model}, {"ok", report.ok}};
  if (!report.ok) {
    out.set("reason", report.reason);
    out.set("detail", report.detail);
  }
  if (!report.control.empty()) out.set("control", report.control);
  out.set("duration", report.duration);
  out.set("steps", report.steps);
  put_errors(report, out);
  out.set("coverage", report.done);
  out.set("max_joint_step", report.max_joint_step);
  if (report.tool_speed_max) out.set("tool_speed_max", *report.tool_speed_max);
  put_planned(report, out);
  out.set("limits_used", {{"velocity", report.velocity_use},
                          {"torque", report.torque_use},
                          {"saturated_steps", report.saturated_steps}});
  out.set("first_contact",
          report.first_contact.empty() ? JsonDoc() : JsonDoc(report.first_contact));
  put_list("unreachable", report.unreachable, [](std::size_t i) { return JsonDoc(i); }, out);
  if (report.shift) {
    out.set("fix", {{"shift", {report.shift->x(), report.shift->y(), report.shift->z()}}});
  }
  for (const Fact& fact : report.facts) put_fact(fact, out);
  put_list("moves", report.moves, [](const auto& move) { return to_json(move); }, out);
  put_list("objects", report.objects, [](const auto& one) { return to_json(one); }, out);
  put_list("held", report.held, [](const auto& one) { return to_json(one); }, out);
  if (report.rtf) out.set("rtf", *report.rtf);
  return out.document();
}

}  // namespace mjarm
