#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "mjarm/core/messages/json.hpp"
#include "mjarm/core/messages/planning.hpp"
#include "mjarm/planning/region_json_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr const char *kHinge = "hinge", *kSlide = "slide";

void append_bound(JsonWriter& json, double value) {
  if (std::isfinite(value)) {
    json.value(value);
  } else {
    json.value(nullptr);
  }
}

tl::unexpected<Error> bad_region() {
  return fail(Errc::bad_input, text(msg::planning_verify_bad_region));
}

/// A number, or what null stands for.
Result<double> bound_of(const JsonValue* value, double none) {
  if (value == nullptr || (!value->is_number() && !value->is_null())) return bad_region();
  return value->is_null() ? none : value->number();
}

Result<void> read_bounds(const JsonValue& entry, const char* key, double side, TaskRegion& out) {
  const JsonValue* const list = entry.find(key);
  if (list == nullptr || !list->is_list() || list->size() != 6) return bad_region();
  for (std::size_t k = 0; k < 6; ++k) {
    const double none = k < 3 ? kFreePlace : k == 4 ? kFreePitch : kFreeTurn;
    const Result<double> bound = bound_of(&(*list)[k], side * none);
    if (!bound) return fail(bound.error());
    const auto axis = static_cast<Eigen::Index>(k % 3);
    const bool is_min = side < 0;
    (k < 3 ? (is_min ? out.place_min : out.place_max)
           : (is_min ? out.turn_min : out.turn_max))[axis] = *bound;
  }
  return {};
}

void append_mechanism(JsonWriter& json, const Mechanism& mechanism) {
  json.key("mechanism").object();
  json.member("type", mechanism.type == JointType::hinge ? kHinge : kSlide);
  json.key("pos").list();
  for (const double x : mechanism.p_W) json.value(x);
  json.end_list().key("axis").list();
  for (const double x : mechanism.axis_W) json.value(x);
  json.end_list().member("min", mechanism.min).member("max", mechanism.max).end_object();
}

Result<Mechanism> read_mechanism(const JsonValue& entry) {
  constexpr std::string_view kKnown[] = {"type", "pos", "axis", "min", "max"};
  const auto bad = [] { return fail(Errc::bad_input, text(msg::planning_verify_bad_mechanism)); };
  if (!entry.is_object()) return fail(Errc::bad_input, text(msg::json_no_object));
  if (Result<void> fine = check_keys(entry, kKnown); !fine) return fail(std::move(fine.error()));
  const JsonValue *const type = entry.find("type"), *const min = entry.find("min"),
                         *const max = entry.find("max");
  const bool numbers = min != nullptr && max != nullptr && min->is_number() && max->is_number();
  if (!numbers || type == nullptr || !type->is_string()) return bad();
  const bool is_hinge = type->string() == kHinge;
  if (!is_hinge && type->string() != kSlide) return bad();
  const Result<std::vector<double>> p = number_list(entry, "pos", 3);
  const Result<std::vector<double>> axis = number_list(entry, "axis", 3);
  if (!p) return fail(p.error());
  if (!axis) return fail(axis.error());
  const Mechanism out{.type = is_hinge ? JointType::hinge : JointType::slide,
                      .p_W = {(*p)[0], (*p)[1], (*p)[2]},
                      .axis_W = {(*axis)[0], (*axis)[1], (*axis)[2]},
                      .min = min->number(),
                      .max = max->number()};
  if (!is_sound(out)) return bad();
  return out;
}

}  // namespace

void append_kept_region(JsonWriter& json, const TaskRegion& region, const RegionRoom& room) {
  json.object();
  json.key("frame").object().pose_members(region.X_WR).end_object();
  json.key("tool").object().pose_members(region.X_FT).end_object();
  std::array<TurnBounds, 3> turns{};
  for (int k = 0; k < 3; ++k) turns[static_cast<std::size_t>(k)] = turn_bounds(region, k);
  json.key("min").list();
  for (const double x : region.place_min) append_bound(json, x);
  for (const TurnBounds& turn : turns) append_bound(json, turn.min);
  json.end_list().key("max").list();
  for (const double x : region.place_max) append_bound(json, x);
  for (const TurnBounds& turn : turns) append_bound(json, turn.max);
  json.end_list().member("lean", region.lean).key("room").object().key("place");
  append_bound(json, room.place);
  json.key("turn");
  append_bound(json, room.turn);
  json.end_object();
  if (region.mechanism) append_mechanism(json, *region.mechanism);
  json.end_object();
}

Result<GivenRegion> read_kept_region(const JsonValue& entry) {
  constexpr std::string_view kKnown[] = {"frame", "tool", "min",      "max",
                                         "lean",  "room", "mechanism"};
  constexpr std::string_view kRoom[] = {"place", "turn"};
  if (!entry.is_object()) return fail(Errc::bad_input, text(msg::json_no_object));
  if (Result<void> fine = check_keys(entry, kKnown); !fine) return fail(std::move(fine.error()));
  const JsonValue* const frame = entry.find("frame");
  const JsonValue* const tool = entry.find("tool");
  const JsonValue* const room = entry.find("room");
  if (frame == nullptr || tool == nullptr || room == nullptr) return bad_region();
  if (Result<void> fine = check_keys(*room, kRoom); !fine) return fail(std::move(fine.error()));
  const Result<Pose> X_WR = pose_of(*frame), X_FT = pose_of(*tool);
  if (!X_WR) return fail(X_WR.error());
  if (!X_FT) return fail(X_FT.error());
  GivenRegion out{.region = {.X_WR = *X_WR, .X_FT = *X_FT}};
  for (const auto& [key, side] : {std::pair{"min", -1.0}, std::pair{"max", 1.0}}) {
    if (Result<void> read = read_bounds(entry, key, side, out.region); !read) {
      return fail(std::move(read.error()));
    }
  }
  const Result<double> lean = bound_of(entry.find("lean"), std::numbers::pi);
  const Result<double> place = bound_of(room->find("place"), kUnbounded);
  const Result<double> turn = bound_of(room->find("turn"), kUnbounded);
  if (!lean || !place || !turn) return bad_region();
  out.region.lean = *lean;
  out.room = {*place, *turn};
  if (const JsonValue* const mechanism = entry.find("mechanism"); mechanism != nullptr) {
    const Result<Mechanism> read = read_mechanism(*mechanism);
    if (!read) return fail(read.error());
    out.region.mechanism = *read;
  }
  if (!is_sound(out.region)) return bad_region();
  return out;
}

}  // namespace mjarm::detail
