#include "apps/mjarm/commands/path_answer.hpp"

#include <cmath>

#include "mjarm/core/json_writer.hpp"

namespace mjarm::app {
namespace {

void append_least(JsonWriter& json, const std::string& what, const LeastAlong& least) {
  json.member("min_" + what, least.value).member("min_" + what + "_at", least.at);
}

void append_measures(JsonWriter& json, const PathMeasures& measures) {
  append_least(json, "manipulability", measures.manipulability);
  append_least(json, "singular_value", measures.singular_value);
  if (std::isfinite(measures.clearance.value)) append_least(json, "clearance", measures.clearance);
}

void append_fix(JsonWriter& json, const PathFix& fix) {
  json.object().key(name(fix.kind));
  switch (fix.kind) {
    case FixKind::start:
      json.value(fix.start);
      break;
    case FixKind::shift:
      json.value(fix.change.shift);
      break;
    case FixKind::tilt:
      json.value(fix.change.tilt);
      break;
    case FixKind::max_step:
      json.value(fix.max_step);
      break;
    case FixKind::slower:
      json.value(fix.tool_speed);
      break;
  }
  json.end_object();
}

void append_cause(JsonWriter& json, const PathFailure& failure, const Arm& arm) {
  json.member("reason", name(failure.code))
      .member("at", failure.at)
      .member("s", failure.s)
      .member("detail", describe(failure, arm))
      .member("amount", failure.amount);
  if (failure.joint >= 0 && failure.joint < arm.dof()) {
    json.member("joint", arm.joints[static_cast<std::size_t>(failure.joint)].name);
  }
  if (failure.code == PathErrc::singularity) json.member("kind", name(failure.kind));
  if (!failure.pair.geom1.empty()) {
    json.key("pair").list().value(failure.pair.geom1).value(failure.pair.geom2).end_list();
  }
}

}  // namespace

void append_path(std::string& out, const JointPath& path, const PathMeasures& measures) {
  JsonWriter json(out);
  json.object()
      .member("ok", true)
      .member("fraction", 1.0)
      .member("q", path.q)
      .member("max_step", path.max_step());
  append_measures(json, measures);
}

void append_path_failure(std::string& out, const PathFailure& failure,
                         std::span<const PathFix> fixes, const Arm& arm,
                         const std::optional<PathMeasures>& measures, bool partial) {
  JsonWriter json(out);
  json.object()
      .member("ok", false)
      .member("fraction", failure.fraction)
      .member("q", std::span<const double>())
      .member("max_step", failure.partial.max_step());
  if (measures) append_measures(json, *measures);
  append_cause(json, failure, arm);
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    if (i == 0) json.key("fix");
    if (i == 1) json.key("more_fixes").list();
    append_fix(json, fixes[i]);
  }
  if (fixes.size() > 1) json.end_list();
  if (partial) json.member("partial", failure.partial.q);
}

void append_unreachable(std::string& out, std::span<const UnreachableRange> ranges) {
  if (ranges.empty()) return;
  JsonWriter json(out);
  json.key("unreachable").list();
  for (const UnreachableRange& range : ranges) {
    json.list().value(range.first).value(range.last).end_list();
  }
  json.end_list();
}

}  // namespace mjarm::app
