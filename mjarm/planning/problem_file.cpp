#include "mjarm/planning/problem_file.hpp"

#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "mjarm/core/json.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/planning.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/number.hpp"

namespace mjarm {
namespace {

constexpr std::size_t kLargest = std::size_t{1} << 27;  // [bytes], unpacked
constexpr std::size_t kMostValues = std::size_t{1} << 22;

template <class... Values>
tl::unexpected<Error> bad(const Msg& message, const Values&... values) {
  return fail(Errc::bad_input, text(message, values...));
}

/// `place: ` before what is wrong there.
Error at(const std::string& place, Error error) {
  error.what = text(msg::core_at_place, place, error.what);
  return error;
}

std::string element(const char* list, std::size_t i) {
  return std::string(list) + '[' + std::to_string(i) + ']';
}

/// The whole file; gzipped ones are unpacked.
Result<std::string> unpacked(const std::string& path) {
#if defined(_WIN32)
  const gzFile opened = gzopen_w(std::filesystem::path(path).c_str(), "rb");
#else
  const gzFile opened = gzopen(path.c_str(), "rb");
#endif
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(opened, gzclose);
  if (!file) return bad(msg::planning_file_cannot_open, path);
  std::string out;
  std::string block(std::size_t{1} << 16, '\0');
  for (;;) {
    const int count = gzread(file.get(), block.data(), static_cast<unsigned>(block.size()));
    if (count < 0) return bad(msg::planning_file_cannot_read, path);
    if (count == 0) return out;
    out.append(block, 0, static_cast<std::size_t>(count));
    if (out.size() > kLargest) return bad(msg::planning_file_large, path, kLargest >> 20);
  }
}

Result<const JsonValue*> member(const JsonValue& object, const char* key) {
  if (!object.is_object()) return bad(msg::planning_file_no_object);
  const JsonValue* const found = object.find(key);
  if (found != nullptr) return found;
  std::vector<std::string> keys;
  for (const JsonValue& item : object) keys.emplace_back(item.key());
  return bad(msg::planning_file_missing, key, did_you_mean(key, keys));
}

Result<const JsonValue*> list(const JsonValue& object, const char* key) {
  Result<const JsonValue*> found = member(object, key);
  if (found && !(*found)->is_list()) return bad(msg::planning_file_no_list, key);
  return found;
}

Result<std::string> string(const JsonValue& object, const char* key) {
  const Result<const JsonValue*> found = member(object, key);
  if (!found) return fail(found.error());
  if (!(*found)->is_string()) return bad(msg::planning_file_no_string, key);
  return (*found)->string();
}

Result<double> real(const JsonValue& object, const char* key) {
  const Result<const JsonValue*> found = member(object, key);
  if (!found) return fail(found.error());
  if (!(*found)->is_number()) return bad(msg::planning_file_no_number, key);
  return (*found)->number();
}

Result<Eigen::Vector3d> vector(const JsonValue& object, const char* key) {
  const Result<std::vector<double>> values = number_list(object, key, 3);
  if (!values) return fail(values.error());
  return Eigen::Vector3d((*values)[0], (*values)[1], (*values)[2]);
}

Result<Pose> pose(const JsonValue& object, const char* place) {
  const Result<Eigen::Vector3d> p = vector(object, place);
  if (!p) return fail(p.error());
  const Result<std::vector<double>> quat = number_list(object, "quat", 4);
  if (!quat) return fail(quat.error());
  const Result<Eigen::Matrix3d> R = rotation_of_quat(*quat);
  if (!R) return fail(R.error());
  return Pose{*p, *R};
}

/// Calls `take` with every entry of a list; its error gets the entry's place.
template <class Take>
Result<void> each(const JsonValue& object, const char* key, Take take) {
  const Result<const JsonValue*> entries = list(object, key);
  if (!entries) return fail(entries.error());
  for (std::size_t i = 0; i < (*entries)->size(); ++i) {
    Result<void> taken = take((**entries)[i]);
    if (!taken) return fail(at(element(key, i), std::move(taken.error())));
  }
  return {};
}

constexpr std::string_view kRobotKeys[] = {
    "name",  "base",  "joints",  "joint_names",
    "lower", "upper", "spheres", "self_collision_link_pairs"};
constexpr std::string_view kJointKeys[] = {"name", "type", "parent", "child",
                                           "xyz",  "quat", "axis",   "limits"};
constexpr std::string_view kSphereKeys[] = {"link", "center", "radius"};

/// Builds the arm and its spheres joint by joint, parents first.
class RobotReader {
 public:
  RobotReader(ProblemFile& out) : out_(out) {}

  Result<void> read(const JsonValue& robot) {
    const Result<std::string> name = string(robot, "name");
    if (!name) return fail(name.error());
    const Result<std::string> base = string(robot, "base");
    if (!base) return fail(base.error());
    out_.arm.name = *name;
    places_[*base] = {};
    return each(robot, "joints", [&](const JsonValue& joint) { return add_joint(joint); })
        .and_then([&] {
          out_.arm.limits.lower = joint_vec(lower_);
          out_.arm.limits.upper = joint_vec(upper_);
          return each(robot, "spheres",
                      [&](const JsonValue& sphere) { return add_sphere(sphere); });
        })
        .and_then([&] {
          return each(robot, "self_collision_link_pairs",
                      [&](const JsonValue& pair) { return add_pair(pair); });
        })
        .and_then([&] { return check_sphere_set(out_.spheres, out_.arm); })
        .and_then([&] { return check_keys(robot, kRobotKeys); })
        .and_then([&] { return check_summary(robot); });
  }

 private:
  /// What files say a second time must be what the joints say.
  Result<void> check_summary(const JsonValue& robot) const {
    if (robot.contains("joint_names")) {
      std::vector<std::string> names;
      for (const ArmJoint& joint : out_.arm.joints) names.push_back(joint.name);
      const JsonValue& given = *robot.find("joint_names");
      const bool same =
          given.is_list() &&
          std::equal(given.begin(), given.end(), names.begin(), names.end(),
                     [](const auto& a, const auto& b) { return a.is_string() && a.string() == b; });
      if (!same) return bad(msg::planning_file_contradicts, "joint_names", listed(names));
    }
    const std::pair<const char*, const std::vector<double>*> limits[] = {{"lower", &lower_},
                                                                         {"upper", &upper_}};
    for (const auto& [key, values] : limits) {
      if (!robot.contains(key)) continue;
      const Result<std::vector<double>> given = number_list(robot, key, values->size());
      if (!given) return fail(given.error());
      if (*given == *values) continue;
      std::vector<std::string> words;
      for (const double value : *values) words.push_back(number(value));
      return bad(msg::planning_file_contradicts, key, listed(words));
    }
    return {};
  }

  /// Where a link is: in the moved frame of a joint of the arm.
  struct Place {
    int joint = -1;
    Pose X;
  };

  Result<Place> place_of(const std::string& link) const {
    const auto found = places_.find(link);
    if (found != places_.end()) return found->second;
    std::vector<std::string> names;
    for (const auto& [name, place] : places_) names.push_back(name);
    return bad(msg::planning_file_unknown_link, link, did_you_mean(link, names));
  }

  Result<void> add_joint(const JsonValue& from) {
    const Result<std::string> parent = string(from, "parent");
    if (!parent) return fail(parent.error());
    const Result<std::string> child = string(from, "child");
    if (!child) return fail(child.error());
    const Result<std::string> type = string(from, "type");
    if (!type) return fail(type.error());
    Result<Place> place = place_of(*parent);
    if (!place) return fail(place.error());
    const Result<Pose> X = pose(from, "xyz");
    if (!X) return fail(X.error());
    place->X = place->X * *X;
    if (*type != "fixed") {
      if (Result<void> moved = add_moving(from, *type, *place); !moved) return moved;
      *place = {out_.arm.dof() - 1, Pose()};
    }
    if (!places_.emplace(*child, *place).second) return bad(msg::planning_file_link_twice, *child);
    return check_keys(from, kJointKeys);
  }

  Result<void> add_moving(const JsonValue& from, const std::string& type, const Place& place) {
    static const std::vector<std::string> kTypes{"fixed", "revolute", "continuous", "prismatic"};
    if (std::find(kTypes.begin(), kTypes.end(), type) == kTypes.end()) {
      return bad(msg::planning_file_joint_type, type, listed(kTypes));
    }
    if (out_.arm.dof() == kMaxDof) return bad(msg::planning_file_many_joints, kMaxDof);
    if (place.joint != out_.arm.dof() - 1) return bad(msg::planning_file_branch);
    const Result<std::string> name = string(from, "name");
    if (!name) return fail(name.error());
    const Result<Eigen::Vector3d> axis = vector(from, "axis");
    if (!axis) return fail(axis.error());
    if (!(axis->norm() > 1e-6 && axis->norm() < 1e6)) return bad(msg::planning_file_axis);
    const Result<std::vector<double>> limits = number_list(from, "limits", 2);
    if (!limits) return fail(limits.error());
    if (!((*limits)[0] <= (*limits)[1]))
      return bad(msg::planning_file_limits, (*limits)[0], (*limits)[1]);
    ArmJoint joint;
    joint.name = *name;
    joint.X_PJ = place.X;
    joint.axis = axis->normalized();
    joint.type = type == "prismatic" ? JointType::slide : JointType::hinge;
    out_.arm.joints.push_back(joint);
    lower_.push_back((*limits)[0]);
    upper_.push_back((*limits)[1]);
    return {};
  }

  Result<void> add_sphere(const JsonValue& from) {
    const Result<std::string> link = string(from, "link");
    if (!link) return fail(link.error());
    const Result<Place> place = place_of(*link);
    if (!place) return fail(place.error());
    const Result<Eigen::Vector3d> center = vector(from, "center");
    if (!center) return fail(center.error());
    const Result<double> radius = real(from, "radius");
    if (!radius) return fail(radius.error());
    const auto [entry, fresh] = links_.try_emplace(*link, static_cast<int>(links_.size()));
    if (fresh) out_.spheres.links.push_back({*link, place->joint, {}});
    out_.spheres.links[static_cast<std::size_t>(entry->second)].spheres.push_back(
        {place->X * *center, *radius});
    return check_keys(from, kSphereKeys);
  }

  Result<void> add_pair(const JsonValue& from) {
    if (!from.is_list() || from.size() != 2 || !from[0].is_string() || !from[1].is_string()) {
      return bad(msg::planning_file_pair);
    }
    std::array<int, 2> pair{};
    for (std::size_t k = 0; k < 2; ++k) {
      const std::string link = from[k].string();
      const auto found = links_.find(link);
      if (found == links_.end()) return bad(msg::planning_file_pair_link, link);
      pair[k] = found->second;
    }
    out_.spheres.pairs.push_back(pair);
    return {};
  }

  ProblemFile& out_;
  std::map<std::string, Place> places_;
  std::map<std::string, int> links_;
  std::vector<double> lower_, upper_;
};

Result<ObstacleShape> cylinder_of(const JsonValue& from, Cylinders cylinders) {
  const Result<double> radius = real(from, "radius");
  if (!radius) return fail(radius.error());
  const Result<double> length = real(from, "length");
  if (!length) return fail(length.error());
  const double half = 0.5 * *length;
  if (cylinders == Cylinders::exact || !from.contains("vamp_as")) {
    return CylinderShape{*radius, half};
  }
  const Result<std::string> as = string(from, "vamp_as");
  if (!as) return fail(as.error());
  if (*as == "capsule") return CapsuleShape{*radius, half};
  if (*as == "box") return BoxShape{{*radius, *radius, half}};
  return bad(msg::planning_file_replacement, *as);
}

Result<Obstacle> obstacle_of(const JsonValue& from, Cylinders cylinders) {
  const Result<std::string> type = string(from, "type");
  if (!type) return fail(type.error());
  constexpr std::string_view kKnown[] = {"type", "name",   "pos",    "quat",
                                         "half", "radius", "length", "vamp_as"};
  if (Result<void> fine = check_keys(from, kKnown); !fine) return fail(std::move(fine.error()));
  Obstacle out;
  if (from.contains("name")) {
    const Result<std::string> name = string(from, "name");
    if (!name) return fail(name.error());
    out.name = *name;
  }
  if (*type == "sphere") {
    const Result<Eigen::Vector3d> p = vector(from, "pos");
    if (!p) return fail(p.error());
    const Result<double> radius = real(from, "radius");
    if (!radius) return fail(radius.error());
    out.X_WO.p = *p;
    out.shape = BallShape{*radius};
    return out;
  }
  const Result<Pose> X = pose(from, "pos");
  if (!X) return fail(X.error());
  out.X_WO = *X;
  if (*type == "box") {
    const Result<Eigen::Vector3d> half = vector(from, "half");
    if (!half) return fail(half.error());
    out.shape = BoxShape{*half};
  } else if (*type == "cylinder") {
    Result<ObstacleShape> shape = cylinder_of(from, cylinders);
    if (!shape) return fail(shape.error());
    out.shape = *shape;
  } else {
    static const std::vector<std::string> kTypes{"box", "cylinder", "sphere"};
    return bad(msg::planning_file_obstacle_type, *type, listed(kTypes),
               did_you_mean(*type, kTypes));
  }
  return out;
}

Result<PlanProblem> problem_of(const JsonValue& from, std::size_t dof, Cylinders cylinders) {
  constexpr std::string_view kKnown[] = {"id", "scene", "start", "goals", "obstacles", "valid"};
  if (Result<void> fine = check_keys(from, kKnown); !fine) return fail(std::move(fine.error()));
  PlanProblem out;
  Result<std::string> id = string(from, "id");
  if (!id) return fail(id.error());
  out.id = *id;
  const JsonValue* const scene = from.find("scene");
  if (scene != nullptr && scene->is_string()) out.scene = scene->string();
  const JsonValue* const valid = from.find("valid");
  if (valid != nullptr && valid->is_boolean()) out.valid = valid->boolean();
  Result<std::vector<double>> start = number_list(from, "start", dof);
  if (!start) return fail(start.error());
  out.start = std::move(*start);
  Result<void> done = each(from, "goals", [&](const JsonValue& goal) -> Result<void> {
    const Result<std::vector<double>> q = numbers_of(goal, "goal", dof);
    if (!q) return fail(q.error());
    out.goals.push_back(joint_vec(*q));
    return {};
  });
  if (!done) return fail(done.error());
  done = each(from, "obstacles", [&](const JsonValue& solid) -> Result<void> {
    Result<Obstacle> obstacle = obstacle_of(solid, cylinders);
    if (!obstacle) return fail(obstacle.error());
    out.obstacles.solids.push_back(std::move(*obstacle));
    return {};
  });
  if (!done) return fail(done.error());
  done = check_obstacles(out.obstacles);
  if (!done) return fail(done.error());
  return out;
}

Result<ProblemFile> problems_of(const JsonValue& file, Cylinders cylinders) {
  ProblemFile out;
  const Result<const JsonValue*> robot = member(file, "robot");
  if (!robot) return fail(robot.error());
  Result<void> done = RobotReader(out).read(**robot);
  if (!done) return fail(at("robot", std::move(done.error())));
  std::set<std::string> ids;
  done = each(file, "problems", [&](const JsonValue& from) -> Result<void> {
    Result<PlanProblem> problem =
        problem_of(from, static_cast<std::size_t>(out.arm.dof()), cylinders);
    if (!problem) return fail(problem.error());
    if (!ids.insert(problem->id).second) return bad(msg::planning_file_id_twice, problem->id);
    out.problems.push_back(std::move(*problem));
    return {};
  });
  constexpr std::string_view kKnown[] = {"robot", "problems"};
  if (done) done = check_keys(file, kKnown);
  if (!done) return fail(done.error());
  return out;
}

}  // namespace

Result<ProblemFile> read_problem_file(const std::string& path, Cylinders cylinders) {
  Result<std::string> content = unpacked(path);
  if (!content) return fail(content.error());
  const auto object = JsonObject::parse(*content, {.values = kMostValues});
  if (!object) return fail(at(path, {Errc::bad_input, describe(object.error())}));
  content->clear();
  content->shrink_to_fit();  // it would stay beside what was read of it
  Result<ProblemFile> out = problems_of(**object, cylinders);
  if (!out) return fail(at(path, std::move(out.error())));
  return out;
}

}  // namespace mjarm
