#include "mjarm/trajectory/time_cases.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <utility>

#include "mjarm/core/json.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/json.hpp"
#include "mjarm/core/messages/trajectory.hpp"
#include "mjarm/trajectory/kept_limits_internal.hpp"
#include "mjarm/trajectory/point_to_point.hpp"
#include "mjarm/trajectory/via_points.hpp"

namespace mjarm {
namespace {

/// Member `key` of `object`: one finite number a joint.
Result<JointVec> joints_of(const JsonValue& object, const std::string& key, Eigen::Index dof) {
  const Result<std::vector<double>> values =
      number_list(object, key, static_cast<std::size_t>(dof));
  if (!values) return fail(values.error());
  return joint_vec(*values);
}

Result<JointLimits> limits_of(const JsonValue& file) {
  const JsonValue* const limits = file.find("limits");
  if (limits == nullptr) return fail(Errc::bad_input, text(msg::json_missing, "limits"));
  if (!limits->is_object())
    return fail(Errc::bad_input, text(msg::trajectory_cases_no_object, "limits"));
  const JsonValue* const v = limits->find("v");
  const std::size_t dof = v != nullptr && v->is_list() ? v->size() : 1;
  if (dof < 1 || dof > static_cast<std::size_t>(kMaxDof)) {
    return fail(Errc::bad_input, text(msg::trajectory_cases_bad_dof, dof, kMaxDof));
  }
  std::array<JointVec, 3> values;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string key(1, "vaj"[k]);
    Result<JointVec> list = joints_of(*limits, key, static_cast<Eigen::Index>(dof));
    if (!list)
      return fail(list.error().code, text(msg::core_at_place, "limits", list.error().what));
    if (!(list->minCoeff() > 0)) {
      return fail(Errc::bad_input, text(msg::trajectory_cases_bad_limit, key));
    }
    values[k] = *list;
  }
  constexpr std::string_view kKnown[] = {"v", "a", "j"};
  const Result<void> fine = check_keys(*limits, kKnown);
  if (!fine) return fail(fine.error().code, text(msg::core_at_place, "limits", fine.error().what));
  return unbounded(values[0], values[1], values[2]);
}

Result<std::string> id_of(const JsonValue& object) {
  const JsonValue* const id = object.find("id");
  if (id == nullptr) return fail(Errc::bad_input, text(msg::json_missing, "id"));
  if (id->is_string()) return id->string();
  if (id->is_whole()) return std::to_string(id->whole());
  if (id->negative() != 0) return std::to_string(id->negative());
  return fail(Errc::bad_input, text(msg::trajectory_cases_bad_id));
}

/// Fills in the two states; missing velocities and accelerations are zero.
Result<void> read_states(const JsonValue& object, Eigen::Index dof, TimeCase& entry) {
  const std::array<std::pair<const char*, JointVec*>, 6> members{{{"q0", &entry.start.q},
                                                                  {"q1", &entry.end.q},
                                                                  {"v0", &entry.start.v},
                                                                  {"v1", &entry.end.v},
                                                                  {"a0", &entry.start.a},
                                                                  {"a1", &entry.end.a}}};
  for (const auto& [key, target] : members) {
    if (key[0] != 'q' && !object.contains(key)) {
      *target = JointVec::Zero(dof);
      continue;
    }
    const Result<JointVec> values = joints_of(object, key, dof);
    if (!values) return fail(values.error());
    *target = *values;
  }
  return {};
}

Result<void> read_waypoints(const JsonValue& object, Eigen::Index dof, TimeCase& entry) {
  constexpr std::size_t kMax = 200'000;
  const JsonValue* const list = object.find("waypoints");
  if (list == nullptr) return fail(Errc::bad_input, text(msg::json_missing, "waypoints"));
  if (!list->is_list() || list->empty() || list->size() > kMax) {
    return fail(Errc::bad_input, text(msg::trajectory_cases_bad_waypoints, kMax));
  }
  for (std::size_t i = 0; i < list->size(); ++i) {
    const std::string key = "waypoints[" + std::to_string(i) + "]";
    const auto q = numbers_of((*list)[i], key, static_cast<std::size_t>(dof));
    if (!q) return fail(q.error());
    entry.waypoints.push_back(joint_vec(*q));
  }
  return {};
}

Result<TimeCase> read_case(const JsonValue& object, Eigen::Index dof, TimeProblem problem) {
  if (!object.is_object()) return fail(Errc::bad_input, text(msg::json_no_object));
  constexpr std::string_view kKnown[] = {"id", "q0", "q1", "v0", "v1", "a0", "a1", "waypoints"};
  if (Result<void> fine = check_keys(object, kKnown); !fine) return fail(std::move(fine.error()));
  TimeCase entry;
  Result<std::string> id = id_of(object);
  if (!id) return fail(std::move(id.error()));
  entry.id = std::move(*id);
  const Result<void> done = problem == TimeProblem::p2p ? read_states(object, dof, entry)
                                                        : read_waypoints(object, dof, entry);
  if (!done) return fail(done.error());
  return entry;
}

/// Whether every piece of a motion along a path is so long that its times tell how long it is. Such
/// a motion was stretched by the exact peaks of these very pieces (peaks_internal.hpp): there is
/// nothing left to look at.
bool keeps_its_times(const Trajectory& motion) {
  constexpr double kLeast = 1e-6;  // of the duration, whose times are exact to 1e-16 of it
  for (std::size_t i = 0; i < motion.pieces(); ++i) {
    if (!(motion.piece(i).duration > kLeast * motion.duration())) return false;
  }
  return std::isfinite(motion.duration());
}

}  // namespace

const char* name(TimeProblem problem) noexcept {
  switch (problem) {
    case TimeProblem::p2p:
      return "p2p";
    case TimeProblem::path_va:
      return "path_va";
    case TimeProblem::path_vaj:
      return "path_vaj";
    case TimeProblem::via_vaj:
      return "via_vaj";
  }
  return "";
}

JointLimits unbounded(const JointVec& v, const JointVec& a, const JointVec& j) {
  JointLimits limits;
  limits.upper = JointVec::Constant(v.size(), std::numeric_limits<double>::infinity());
  limits.lower = -limits.upper;
  limits.velocity = v;
  limits.acceleration = a;
  limits.jerk = j;
  return limits;
}

Result<TimeCases> read_time_cases(const std::string& content, TimeProblem problem) {
  const Result<JsonObject> object = parse_json_object(content);
  if (!object) return fail(object.error());
  const JsonValue& file = **object;
  Result<JointLimits> limits = limits_of(file);
  if (!limits) return fail(std::move(limits.error()));
  const JsonValue* const list = file.find("cases");
  if (list == nullptr) return fail(Errc::bad_input, text(msg::json_missing, "cases"));
  if (!list->is_list()) return fail(Errc::bad_input, text(msg::trajectory_cases_no_list));
  TimeCases cases{std::move(*limits), {}};
  std::set<std::string> ids;
  for (std::size_t i = 0; i < list->size(); ++i) {
    Result<TimeCase> entry = read_case((*list)[i], cases.limits.velocity.size(), problem);
    if (!entry) {
      return fail(entry.error().code, text(msg::trajectory_cases_in_case, i, entry.error().what));
    }
    if (!ids.insert(entry->id).second) {
      return fail(Errc::bad_input, text(msg::trajectory_cases_in_case, i,
                                        text(msg::trajectory_cases_id_twice, entry->id)));
    }
    cases.cases.push_back(std::move(*entry));
  }
  constexpr std::string_view kKnown[] = {"limits", "cases"};
  if (Result<void> fine = check_keys(file, kKnown); !fine) return fail(std::move(fine.error()));
  return cases;
}

Result<Trajectory> time_case(const TimeCase& entry, const JointLimits& limits, TimeProblem problem,
                             PathTimingOptions torque) {
  if (problem == TimeProblem::p2p) return point_to_point(entry.start, entry.end, limits);
  if (problem == TimeProblem::via_vaj) {
    Result<ViaMotion> motion = time_via_points(entry.waypoints, limits);
    if (!motion) return fail(std::move(motion.error()));
    return std::move(motion->trajectory);
  }
  torque.jerk_limits = problem == TimeProblem::path_vaj;
  Result<Trajectory> motion = time_waypoint_path(entry.waypoints, limits, torque);
  if (!motion || keeps_its_times(*motion)) return motion;
  return detail::check_kept(*motion, limits, torque.jerk_limits).map([&] {
    return *std::move(motion);
  });
}

}  // namespace mjarm
