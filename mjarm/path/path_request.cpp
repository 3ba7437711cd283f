#include "mjarm/path/path_request.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/path.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/model/joint_values.hpp"
#include "mjarm/path/ellipse.hpp"

namespace mjarm {
namespace {

constexpr std::size_t kMaxPoses = 200'000;  // as many as a curve has waypoints at first

/// `place: ` before what is wrong there.
Error at(const std::string& place, Error error) {
  error.what = text(msg::core_at_place, place, error.what);
  return error;
}

/// Member `key`, a number; `otherwise` where it is missing, an error where that is none.
Result<double> number_of(const JsonValue& object, const char* key,
                         std::optional<double> otherwise = {}) {
  const JsonValue* const member = object.find(key);
  if (member == nullptr && otherwise) return *otherwise;
  if (member == nullptr || !member->is_number()) {
    return fail(Errc::bad_input, text(msg::path_request_no_number, key));
  }
  return member->number();
}

/// A pose that stands at `place`.
Result<Pose> pose_at(const JsonValue* entry, const std::string& place) {
  if (entry == nullptr || !entry->is_object()) {
    return fail(Errc::bad_input, text(msg::path_request_no_pose, place));
  }
  constexpr std::string_view kKnown[] = {"pos", "quat"};
  Result<Pose> pose = pose_of(*entry);
  const Result<void> fine = pose ? check_keys(*entry, kKnown) : fail(pose.error());
  if (!fine) return fail(at(place, fine.error()));
  return pose;
}

Result<Pose> pose_member(const JsonValue& object, const char* key) {
  return pose_at(object.find(key), key);
}

Result<std::vector<Pose>> pose_list(const JsonValue& object, const char* key) {
  const JsonValue* const member = object.find(key);
  if (member == nullptr || !member->is_list() || member->empty()) {
    return fail(Errc::bad_input, text(msg::path_request_no_poses, key));
  }
  if (member->size() > kMaxPoses) {
    return fail(Errc::bad_input, text(msg::path_request_too_many, key, kMaxPoses, member->size()));
  }
  std::vector<Pose> poses;
  poses.reserve(member->size());
  for (const JsonValue& entry : *member) {
    const Result<Pose> pose =
        pose_at(&entry, std::string(key) + "[" + std::to_string(poses.size()) + "]");
    if (!pose) return fail(pose.error());
    poses.push_back(*pose);
  }
  return poses;
}

Result<void> read_poses(const JsonValue& object, PathRequest& out) {
  Result<std::vector<Pose>> poses = pose_list(object, "poses");
  if (!poses) return fail(std::move(poses.error()));
  out.poses = std::move(*poses);
  return {};
}

Result<void> take(Result<Curve> curve, PathRequest& out) {
  if (!curve) return fail(std::move(curve.error()));
  out.curve = std::move(*curve);
  return {};
}

Result<void> read_line(const JsonValue& object, PathRequest& out) {
  const Result<Pose> from = pose_member(object, "from"), to = pose_member(object, "to");
  if (!from) return fail(from.error());
  if (!to) return fail(to.error());
  return take(Curve::line(*from, *to), out);
}

Result<void> read_arc(const JsonValue& object, PathRequest& out) {
  const Result<Pose> from = pose_member(object, "from"), via = pose_member(object, "via"),
                     to = pose_member(object, "to");
  for (const auto* pose : {&from, &via, &to}) {
    if (!*pose) return fail(pose->error());
  }
  return take(Curve::arc(*from, *via, *to), out);
}

Result<void> read_polyline(const JsonValue& object, PathRequest& out) {
  const Result<std::vector<Pose>> points = pose_list(object, "points");
  if (!points) return fail(points.error());
  const Result<double> blend = number_of(object, "blend", 0.0);
  if (!blend) return fail(blend.error());
  return take(Curve::polyline(*points, *blend), out);
}

Result<void> read_ellipse(const JsonValue& object, PathRequest& out) {
  const auto center = number_list(object, "center", 3);
  if (!center) return fail(center.error());
  const auto normal = number_list(object, "normal", 3);
  if (!normal) return fail(normal.error());
  const auto quat = number_list(object, "quat", 4);
  if (!quat) return fail(quat.error());
  const Result<Eigen::Matrix3d> R = rotation_of_quat(*quat);
  if (!R) return fail(R.error());
  const Result<double> a = number_of(object, "a"), b = number_of(object, "b");
  if (!a) return fail(a.error());
  if (!b) return fail(b.error());
  const Ellipse ellipse{{(*center)[0], (*center)[1], (*center)[2]},
                        *a,
                        *b,
                        {(*normal)[0], (*normal)[1], (*normal)[2]},
                        *R};
  if (Result<void> sound = take(Curve::ellipse(ellipse), out); !sound) return sound;
  const Result<double> points = number_of(object, "points", 0.0);
  if (!points) return fail(points.error());
  if (!object.contains("points")) return {};
  if (!(*points >= 1 && *points <= double{kMaxPoses}) || std::floor(*points) != *points) {
    return fail(Errc::bad_input, text(msg::path_request_points, kMaxPoses));
  }
  out.curve.reset();
  out.poses = ellipse_points(ellipse, static_cast<int>(*points));
  return {};
}

struct Type {
  const char* name;
  Result<void> (*read)(const JsonValue& object, PathRequest& out);
};
constexpr std::array<Type, 5> kTypes{{{"poses", read_poses},
                                      {"line", read_line},
                                      {"polyline", read_polyline},
                                      {"arc", read_arc},
                                      {"ellipse", read_ellipse}}};

Result<const Type*> type_of(const JsonValue& object) {
  std::vector<std::string> names;
  for (const Type& type : kTypes) names.emplace_back(type.name);
  const std::string all = listed(names);
  const JsonValue* const member = object.find("type");
  if (member == nullptr || !member->is_string()) {
    return fail(Errc::bad_input, text(msg::path_request_no_type, all));
  }
  const auto word = member->string();
  for (const Type& type : kTypes) {
    if (word == type.name) return &type;
  }
  const std::string meant = nearest_word(word, names).value_or(all);
  return fail(Errc::bad_input, text(msg::path_request_unknown_type, word.substr(0, 40), meant));
}

}  // namespace

Result<void> check_tilt(double tilt) {
  if (tilt >= 0 && tilt < std::numbers::pi / 2) return {};
  return fail(Errc::bad_input, text(msg::path_request_bad_tilt));
}

Result<PathRequest> path_request_of(const JsonValue& object, const Arm& arm) {
  constexpr std::string_view kKnown[] = {
      "type", "poses", "from",   "to",   "via",   "points",   "blend", "center",
      "a",    "b",     "normal", "quat", "start", "max_step", "speed", "orientation_tol"};
  if (Result<void> fine = check_keys(object, kKnown); !fine) return fail(std::move(fine.error()));
  const Result<const Type*> type = type_of(object);
  if (!type) return fail(type.error());
  PathRequest out;
  if (Result<void> read = (*type)->read(object, out); !read) return fail(std::move(read.error()));
  if (object.contains("start")) {
    auto q = number_list(object, "start", static_cast<std::size_t>(arm.dof()));
    if (!q) return fail(std::move(q.error()));
    if (Result<void> fine = check_joint_units(*q, arm); !fine)
      return fail(at("start", fine.error()));
    out.q = std::move(*q);
  }
  if (object.contains("max_step")) {
    const Result<double> max_step = number_of(object, "max_step");
    if (!max_step) return fail(max_step.error());
    if (!is_sound_step(*max_step)) return fail(Errc::bad_input, text(msg::path_request_max_step));
    out.max_step = *max_step;
  }
  if (object.contains("speed")) {
    const Result<double> speed = number_of(object, "speed");
    if (!speed) return fail(speed.error());
    if (!(*speed > 0)) return fail(Errc::bad_input, text(msg::path_request_bad_speed));
    out.speed = *speed;
  }
  if (object.contains("orientation_tol")) {
    const Result<double> tilt = number_of(object, "orientation_tol");
    if (!tilt) return fail(tilt.error());
    if (Result<void> fine = check_tilt(*tilt); !fine) return fail(std::move(fine.error()));
    out.tilt = *tilt;
  }
  return out;
}

}  // namespace mjarm
