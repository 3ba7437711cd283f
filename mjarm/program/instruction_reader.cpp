#include <array>
#include <cmath>
#include <utility>

#include "mjarm/core/messages/identification.hpp"
#include "mjarm/core/messages/program.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/identification/excitation.hpp"
#include "mjarm/planning/plan_path.hpp"
#include "mjarm/program/fields_internal.hpp"

namespace mjarm::program::detail {
namespace {

constexpr double kMaxRepeats = 10000;
constexpr double kMaxSeconds = 86400;
constexpr double kMaxPayload = 1000;  // [kg] more is a slip of the pen, as grams

std::optional<double> speed_of(const Fields& fields) {
  return fields.positive("speed", Quantity::speed, 100);
}

/// A share of the joint limits; 50 was meant as 50 %.
std::optional<double> share_of(const Fields& fields, std::string_view key) {
  const YamlNode* node = fields.find(key);
  if (node == nullptr) return std::nullopt;
  return or_noted(fields.faults(), std::optional<double>(), [&]() -> std::optional<double> {
    const double share = number_of(*node, fields.named(key), Quantity::number);
    if (share > 0 && share <= 1) return share;
    throw ReadFault{node->place, text(msg::program_bad_share, fields.named(key), share)};
  });
}

/// `branch: {shoulder: left, elbow: up, wrist: no_flip}`, or some of it; `joints` go without.
std::optional<Branch> branch_of(const Fields& fields) {
  const YamlNode* node = fields.find("branch");
  if (node == nullptr) return std::nullopt;
  return or_noted(fields.faults(), std::optional<Branch>(), [&]() -> std::optional<Branch> {
    const std::string what = fields.named("branch");
    const Fields parts(*node, what, {"shoulder", "elbow", "wrist"}, fields.faults());
    if (fields.find("joints") != nullptr) {
      throw ReadFault{node->place, text(msg::program_pose_and, fields.named("joints"), "branch")};
    }
    Branch out;
    for (int part = 0; part < Branch::kParts; ++part) {
      const auto ways = branch_ways(part);
      const std::string_view name = branch_parts()[static_cast<std::size_t>(part)];
      const YamlNode* way = parts.find(name);
      if (way == nullptr) continue;
      or_noted(fields.faults(), 0, [&] {
        const std::string word = word_of(*way, parts.named(name), {ways.begin(), ways.end()});
        out.way[static_cast<std::size_t>(part)] = word == ways[0] ? 0 : 1;
        return 0;
      });
    }
    return out;
  });
}

/// `payload: {mass: 1.2, com: [0, 0, 0.05]}`, or the mass alone.
std::optional<Payload> payload_of(const Fields& fields) {
  const YamlNode* node = fields.find("payload");
  if (node == nullptr) return std::nullopt;
  return or_noted(fields.faults(), std::optional<Payload>(), [&]() -> std::optional<Payload> {
    const auto mass_of = [](const YamlNode& given, const std::string& what) {
      const double mass = number_of(given, what, Quantity::number);
      if (mass >= 0 && mass <= kMaxPayload) return mass;
      throw ReadFault{given.place, text(msg::program_not_between, what, kMaxPayload, mass)};
    };
    const std::string what = fields.named("payload");
    if (node->kind == YamlNode::Kind::scalar) return Payload{mass_of(*node, what)};
    const Fields parts(*node, what, {"mass", "com"}, fields.faults());
    Payload out;
    if (parts.find("com") != nullptr) out.center = parts.vector("com", Quantity::length);
    out.mass = parts.take("mass", 0.0, mass_of);
    return out;
  });
}

/// A pose that is a member of its own.
ProgramPose pose_at(const Fields& fields, std::string_view key, const NamedThings& named) {
  return fields.take(key, ProgramPose{}, [&](const YamlNode& node, const std::string& what) {
    return pose_of(node, what, named);
  });
}

std::variant<JointValues, ProgramPose> goal_of(const Fields& fields, const NamedThings& named) {
  const YamlNode* joints = fields.find("joints");
  if (joints == nullptr) return pose_of(fields, named);
  for (const char* other : {"pos", "euler", "quat", "matrix", "pose", "frame"}) {
    if (const YamlNode* node = fields.find(other)) {
      throw ReadFault{node->place, text(msg::program_pose_and, fields.named("joints"), other)};
    }
  }
  return fields.take("joints", JointValues{}, [&](const YamlNode& node, const std::string& what) {
    return joints_of(node, what, named);
  });
}

Instruction::What read_movej(const YamlNode& node, const NamedThings& named) {
  if (node.kind == YamlNode::Kind::scalar) return MoveJ{pose_of(node, "movej", named)};
  const Fields fields(node, "movej", {"joints", MJARM_POSE_KEYS, "speed", "branch"}, named.faults);
  const std::optional<double> share = share_of(fields, "speed");
  const std::optional<Branch> branch = branch_of(fields);
  return MoveJ{goal_of(fields, named), share, branch};
}

Instruction::What read_movel(const YamlNode& node, const NamedThings& named) {
  if (node.kind == YamlNode::Kind::scalar) return MoveL{pose_of(node, "movel", named)};
  const Fields fields(node, "movel", {MJARM_POSE_KEYS, "speed", "blend"}, named.faults);
  const std::optional<double> speed = speed_of(fields);
  const std::optional<double> blend = fields.not_negative("blend", Quantity::length);
  return MoveL{pose_of(fields, named), speed, blend};
}

Instruction::What read_movec(const YamlNode& node, const NamedThings& named) {
  const Fields fields(node, "movec", {"via", "to", "speed", "blend"}, named.faults);
  const std::optional<double> speed = speed_of(fields);
  const std::optional<double> blend = fields.not_negative("blend", Quantity::length);
  const ProgramPose via = pose_at(fields, "via", named);
  return MoveC{via, pose_at(fields, "to", named), speed, blend};
}

/// @param a, b  keys of the semi-axes.
DrawEllipse ellipse_of(const Fields& fields, const char* word, const char* a, const char* b) {
  DrawEllipse out;
  const auto semi_axis = [](const YamlNode& node, const std::string& what) {
    return positive_of(node, what, Quantity::length);
  };
  out.word = word;
  out.frame = fields.frame();
  out.speed = speed_of(fields);
  out.center = fields.vector("center", Quantity::length);
  out.normal = fields.vector("normal", Quantity::number);
  out.a = fields.take(a, out.a, semi_axis);
  out.b = std::string_view(a) == b ? out.a : fields.take(b, out.b, semi_axis);
  out.R_FT = fields.rotation();
  return out;
}

Instruction::What read_ellipse(const YamlNode& node, const NamedThings& named) {
  const Fields fields(node, "ellipse",
                      {"center", "a", "b", "normal", "euler", "quat", "matrix", "frame", "speed"},
                      named.faults);
  return ellipse_of(fields, "ellipse", "a", "b");
}

Instruction::What read_circle(const YamlNode& node, const NamedThings& named) {
  const Fields fields(
      node, "circle",
      {"center", "radius", "normal", "via", "to", "euler", "quat", "matrix", "frame", "speed"},
      named.faults);
  if (fields.find("via") != nullptr || fields.find("to") != nullptr) {
    const Fields round(node, "circle", {"via", "to", "speed"}, named.faults);
    const std::optional<double> speed = speed_of(round);
    const ProgramPose via = pose_at(round, "via", named);
    return MoveC{.via = via, .to = pose_at(round, "to", named), .speed = speed, .whole = true};
  }
  return ellipse_of(fields, "circle", "radius", "radius");
}

/// `points`: positions with one rotation for all, or poses.
std::vector<ProgramPose> points_of(const Fields& fields, const NamedThings& named) {
  std::vector<ProgramPose> out;
  const YamlNode& points = fields.need("points");
  const std::string what = fields.named("points");
  if (points.kind != YamlNode::Kind::list || points.items.size() < 2) {
    throw ReadFault{points.place, text(msg::program_expected_points, what)};
  }
  std::optional<Eigen::Matrix3d> R;
  for (const YamlNode& point : points.items) {
    const bool bare = point.kind == YamlNode::Kind::list;
    if (bare && !R) R = fields.rotation();
    out.push_back(or_noted(fields.faults(), ProgramPose{}, [&]() -> ProgramPose {
      if (!bare) return pose_of(point, what, named);
      return {{vector_of(point, what, Quantity::length), *R}, fields.frame()};
    }));
  }
  return out;
}

Instruction::What read_polyline(const YamlNode& node, const NamedThings& named) {
  const Fields fields(node, "polyline",
                      {"points", "euler", "quat", "matrix", "frame", "speed", "blend"},
                      named.faults);
  DrawPolyline out;
  out.speed = speed_of(fields);
  out.blend = fields.not_negative("blend", Quantity::length);
  out.points = points_of(fields, named);
  return out;
}

Instruction::What read_spline(const YamlNode& node, const NamedThings& named) {
  const Fields fields(node, "spline",
                      {"points", "euler", "quat", "matrix", "frame", "speed", "corner"},
                      named.faults);
  DrawSpline out;
  out.speed = speed_of(fields);
  out.corner = fields.positive("corner", Quantity::angle).value_or(out.corner);
  out.points = points_of(fields, named);
  return out;
}

/// Axes of the plane of a text, in its frame: `right` and `up`, made perpendicular.
Eigen::Matrix3d plane_of(const Fields& fields) {
  Eigen::Vector3d right = Eigen::Vector3d::UnitX(), up = Eigen::Vector3d::UnitY();
  if (fields.find("right") != nullptr) right = fields.vector("right", Quantity::number);
  if (fields.find("up") != nullptr) up = fields.vector("up", Quantity::number);
  const Eigen::Vector3d out = right.cross(up);
  constexpr double kParallel = 1e-6;
  if (!(out.norm() > kParallel * right.norm() * up.norm())) {
    throw ReadFault{fields.place(), text(msg::program_no_plane)};
  }
  Eigen::Matrix3d R;
  R.col(0) = right.normalized();
  R.col(2) = out.normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  return R;
}

Instruction::What read_text(const YamlNode& node, const NamedThings& named) {
  const Fields fields(node, "text",
                      {"text", "pos", "right", "up", "height", "lift", "press", "euler", "quat",
                       "matrix", "frame", "speed"},
                      named.faults);
  DrawText out;
  out.plane.frame = fields.frame();
  out.height = fields.positive("height", Quantity::length).value_or(out.height);
  out.lift = fields.positive("lift", Quantity::length).value_or(out.lift);
  out.press = fields.positive("press", Quantity::number);
  out.speed = speed_of(fields);
  out.plane.X_FT.R = or_noted(fields.faults(), out.plane.X_FT.R, [&] { return plane_of(fields); });
  out.text = fields.take("text", out.text, text_of);
  out.plane.X_FT.p = fields.vector("pos", Quantity::length);
  out.R_FT = fields.rotation();
  return out;
}

Instruction::What read_wait(const YamlNode& node, const NamedThings&) {
  const double seconds = number_of(node, "wait", Quantity::time);
  if (!(seconds >= 0 && seconds <= kMaxSeconds)) {
    throw ReadFault{node.place, text(msg::program_not_between, "wait", kMaxSeconds, seconds)};
  }
  return Wait{seconds};
}

Instruction::What read_set(const YamlNode& node, const NamedThings& named) {
  return set_of(Fields(node, "set",
                       {"tool", "frame", "speed", "joint_speed", "zone", "branch", "payload"},
                       named.faults));
}

Instruction::What read_plan(const YamlNode& node, const NamedThings& named) {
  if (node.kind == YamlNode::Kind::scalar) return PlanMove{pose_of(node, "plan", named)};
  const Fields fields(node, "plan", {"joints", MJARM_POSE_KEYS, "branch", "clearance"},
                      named.faults);
  const std::optional<Branch> branch = branch_of(fields);
  const auto clearance = [](const YamlNode& given, const std::string& what) {
    const double value = number_of(given, what, Quantity::length);
    if (value >= 0 && value <= kMaxClearanceAsked) return std::optional<double>(value);
    throw ReadFault{given.place, text(msg::program_not_between, what, kMaxClearanceAsked, value)};
  };
  const bool asked = fields.find("clearance") != nullptr;
  const auto kept = asked ? fields.take("clearance", std::optional<double>(), clearance)
                          : std::optional<double>();
  return PlanMove{goal_of(fields, named), branch, kept};
}

/// `excite: 20`, or with fields.
Instruction::What read_excite(const YamlNode& node, const NamedThings& named) {
  static constexpr double kMaxSeed = 1e9;
  Excite out;
  const auto seconds_of = [](const YamlNode& given, const std::string& what) {
    const double seconds = number_of(given, what, Quantity::time);
    if (seconds >= kLeastExcitation && seconds <= kMostExcitation) return seconds;
    throw ReadFault{given.place, text(msg::program_in, what,
                                      text(msg::identification_bad_seconds, kLeastExcitation,
                                           kMostExcitation, seconds))};
  };
  const auto seed_of = [](const YamlNode& given, const std::string& what) {
    const double seed = number_of(given, what, Quantity::number);
    if (seed >= 0 && seed <= kMaxSeed && std::floor(seed) == seed) {
      return static_cast<std::uint64_t>(seed);
    }
    throw ReadFault{given.place, text(msg::program_bad_count, what, kMaxSeed)};
  };
  if (node.kind == YamlNode::Kind::scalar) return Excite{seconds_of(node, "excite")};
  const Fields fields(node, "excite", {"seconds", "seed"}, named.faults);
  if (fields.find("seconds") != nullptr) out.seconds = fields.take("seconds", 20.0, seconds_of);
  if (fields.find("seed") != nullptr) out.seed = fields.take("seed", out.seed, seed_of);
  return out;
}

Instruction::What read_grip(const YamlNode& node, const NamedThings&) {
  return Grip{word_of(node, "grip", {"open", "close"}) == "close"};
}

/// `look: rgbd`, or with fields.
Instruction::What read_look(const YamlNode& node, const NamedThings& named) {
  if (node.kind == YamlNode::Kind::scalar) return Look{text_of(node, "look"), node.place};
  const Fields fields(node, "look", {"camera"}, named.faults);
  const YamlNode& camera = fields.need("camera");
  return Look{fields.take("camera", std::string(), text_of), camera.place};
}

/// `pick: can`, or with fields.
Instruction::What read_pick(const YamlNode& node, const NamedThings& named) {
  if (node.kind == YamlNode::Kind::scalar) return Pick{text_of(node, "pick"), node.place};
  const Fields fields(node, "pick", {"object"}, named.faults);
  const YamlNode& object = fields.need("object");
  return Pick{fields.take("object", std::string(), text_of), object.place};
}

/// Without an orientation it may be turned as the arm likes, upright as its body is.
Instruction::What read_place(const YamlNode& node, const NamedThings& named) {
  if (node.kind == YamlNode::Kind::scalar) return Place{pose_of(node, "place", named)};
  const Fields fields(node, "place", {MJARM_POSE_KEYS}, named.faults);
  for (const char* key : {"euler", "quat", "matrix", "pose"}) {
    if (fields.find(key) != nullptr) return Place{pose_of(fields, named)};
  }
  const ProgramPose goal{{fields.vector("pos", Quantity::length), Eigen::Matrix3d::Identity()},
                         fields.frame()};
  return Place{.goal = goal, .any_turn = true};
}

Instruction::What read_repeat(const YamlNode& node, const NamedThings& named) {
  const Fields fields(node, "repeat", {"times", "program"}, named.faults);
  Repeat out;
  if (const YamlNode* body = fields.find("program")) {
    out.body = instructions_of(*body, fields.named("program"), named);
  }
  out.times = fields.take("times", 1, [](const YamlNode& times, const std::string& what) {
    const double count = number_of(times, what, Quantity::number);
    if (count >= 0 && count <= kMaxRepeats && std::floor(count) == count) {
      return static_cast<int>(count);
    }
    throw ReadFault{times.place, text(msg::program_bad_count, what, kMaxRepeats)};
  });
  static_cast<void>(fields.need("program"));
  return out;
}

struct Word {
  const char* word;
  Instruction::What (*read)(const YamlNode& node, const NamedThings& named);
};
constexpr std::array<Word, 17> kWords{{{"movej", read_movej},
                                       {"movel", read_movel},
                                       {"movec", read_movec},
                                       {"ellipse", read_ellipse},
                                       {"circle", read_circle},
                                       {"polyline", read_polyline},
                                       {"spline", read_spline},
                                       {"text", read_text},
                                       {"wait", read_wait},
                                       {"set", read_set},
                                       {"repeat", read_repeat},
                                       {"plan", read_plan},
                                       {"excite", read_excite},
                                       {"grip", read_grip},
                                       {"look", read_look},
                                       {"pick", read_pick},
                                       {"place", read_place}}};

}  // namespace

Set set_of(const Fields& fields) {
  Set out;
  if (fields.find("tool") != nullptr) out.tool = fields.take("tool", std::string(), text_of);
  if (fields.find("frame") != nullptr) out.frame = fields.frame();
  out.speed = speed_of(fields);
  out.share = share_of(fields, "joint_speed");
  out.zone = fields.not_negative("zone", Quantity::length);
  out.branch = branch_of(fields);
  out.payload = payload_of(fields);
  return out;
}

Instruction instruction_of(const YamlNode& node, const NamedThings& named) {
  if (node.kind != YamlNode::Kind::map || node.members.size() != 1) {
    throw ReadFault{node.place, text(msg::program_expected_instruction)};
  }
  const auto& [key, value] = node.members.front();
  std::vector<std::string> known;
  for (const Word& word : kWords) {
    if (key.text == word.word) return {word.read(value, named), key.place};
    known.emplace_back(word.word);
  }
  throw ReadFault{key.place,
                  text(msg::program_unknown_instruction, key.text) + did_you_mean(key.text, known)};
}

std::vector<Instruction> instructions_of(const YamlNode& node, std::string_view what,
                                         const NamedThings& named) {
  if (node.kind != YamlNode::Kind::list || node.items.empty()) {
    throw ReadFault{node.place, text(msg::program_expected_instructions, what)};
  }
  std::vector<Instruction> out;
  for (const YamlNode& item : node.items) {
    auto read = or_noted(named.faults, std::optional<Instruction>(),
                         [&] { return std::optional<Instruction>(instruction_of(item, named)); });
    if (read) out.push_back(std::move(*read));
  }
  return out;
}

}  // namespace mjarm::program::detail
