#include "apps/mjarm/commands/path_answer.hpp"

#include <cmath>

#include "apps/mjarm/cli/answer_json.hpp"
#include "mjarm/core/number.hpp"

namespace mjarm::app {
namespace {

void append_least(std::string& out, const char* key, const LeastAlong& least) {
  append_value(out, (std::string("min_") + key).c_str(), least.value);
  append_key(out, (std::string("min_") + key + "_at").c_str());
  out += std::to_string(least.at);
}

void append_measures(std::string& out, const PathMeasures& measures) {
  append_least(out, "manipulability", measures.manipulability);
  append_least(out, "singular_value", measures.singular_value);
  if (std::isfinite(measures.clearance.value)) append_least(out, "clearance", measures.clearance);
}

void append_fix(std::string& out, const PathFix& fix) {
  out += "{\"";
  out += name(fix.kind);
  out += "\":";
  const auto vector = [&](const Eigen::Vector3d& v) { append_numbers(out, {v.data(), 3}); };
  switch (fix.kind) {
    case FixKind::start:
      append_numbers(out, as_span(fix.start));
      break;
    case FixKind::shift:
      vector(fix.change.shift);
      break;
    case FixKind::tilt:
      vector(fix.change.tilt);
      break;
    case FixKind::max_step:
      append_number(out, fix.max_step);
      break;
    case FixKind::slower:
      append_number(out, fix.tool_speed);
      break;
  }
  out += '}';
}

void append_cause(std::string& out, const PathFailure& failure, const Arm& arm) {
  append_key(out, "reason");
  append_json_string(out, name(failure.code));
  append_key(out, "at");
  out += std::to_string(failure.at);
  append_value(out, "s", failure.s);
  append_key(out, "detail");
  append_json_string(out, describe(failure, arm));
  append_value(out, "amount", failure.amount);
  if (failure.joint >= 0 && failure.joint < arm.dof()) {
    append_key(out, "joint");
    append_json_string(out, arm.joints[static_cast<std::size_t>(failure.joint)].name);
  }
  if (failure.code == PathErrc::singularity) {
    append_key(out, "kind");
    append_json_string(out, name(failure.kind));
  }
  if (!failure.pair.geom1.empty()) {
    append_key(out, "pair");
    out += '[';
    append_json_string(out, failure.pair.geom1);
    out += ',';
    append_json_string(out, failure.pair.geom2);
    out += ']';
  }
}

}  // namespace

void append_path(std::string& out, const JointPath& path, const PathMeasures& measures) {
  out += "{\"ok\":true,\"fraction\":1.0";
  append_rows(out, "q", path.q);
  append_value(out, "max_step", path.max_step());
  append_measures(out, measures);
}

void append_path_failure(std::string& out, const PathFailure& failure,
                         std::span<const PathFix> fixes, const Arm& arm,
                         const std::optional<PathMeasures>& measures, bool partial) {
  out += "{\"ok\":false";
  append_value(out, "fraction", failure.fraction);
  out += ",\"q\":[]";
  append_value(out, "max_step", failure.partial.max_step());
  if (measures) append_measures(out, *measures);
  append_cause(out, failure, arm);
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    out += i == 0 ? ",\"fix\":" : (i == 1 ? ",\"more_fixes\":[" : ",");
    append_fix(out, fixes[i]);
  }
  if (fixes.size() > 1) out += ']';
  if (partial) append_rows(out, "partial", failure.partial.q);
}

void append_unreachable(std::string& out, std::span<const UnreachableRange> ranges) {
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    out += i == 0 ? ",\"unreachable\":[" : ",";
    out += "[" + std::to_string(ranges[i].first) + "," + std::to_string(ranges[i].last) + "]";
  }
  if (!ranges.empty()) out += ']';
}

}  // namespace mjarm::app
