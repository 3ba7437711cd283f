#include <array>
#include <cmath>
#include <utility>

#include "mjarm/core/messages/program.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/program/fields_internal.hpp"

namespace mjarm::program::detail {
namespace {

constexpr double kMaxRepeats = 10000;
constexpr double kMaxSeconds = 86400;

std::optional<double> speed_of(const Fields& fields) {
  return fields.positive("speed", Quantity::speed, 100);
}

/// A share of the joint limits; 50 was meant as 50 %.
std::optional<double> share_of(const Fields& fields, std::string_view key) {
  const YamlNode* node = fields.find(key);
  if (node == nullptr) return std::nullopt;
  const double share = number_of(*node, fields.named(key), Quantity::number);
  if (!(share > 0 && share <= 1)) {
    throw ReadFault{node->place, text(msg::program_bad_share, fields.named(key), share)};
  }
  return share;
}

std::variant<std::vector<double>, ProgramPose> goal_of(const Fields& fields,
                                                       const NamedThings& named) {
  const YamlNode* joints = fields.find("joints");
  if (joints == nullptr) return pose_of(fields, named);
  for (const char* other : {"pos", "euler", "quat", "matrix", "pose", "frame"}) {
    if (const YamlNode* node = fields.find(other)) {
      throw ReadFault{node->place, text(msg::program_pose_and, fields.named("joints"), other)};
    }
  }
  return joints_of(*joints, fields.named("joints"), named);
}

Instruction::What read_movej(const YamlNode& node, const NamedThings& named) {
  if (node.kind == YamlNode::Kind::scalar) return MoveJ{pose_of(node, "movej", named)};
  const Fields fields(node, "movej", {"joints", MJARM_POSE_KEYS, "speed"});
  return MoveJ{goal_of(fields, named), share_of(fields, "speed")};
}

Instruction::What read_movel(const YamlNode& node, const NamedThings& named) {
  if (node.kind == YamlNode::Kind::scalar) return MoveL{pose_of(node, "movel", named)};
  const Fields fields(node, "movel", {MJARM_POSE_KEYS, "speed", "blend"});
  return MoveL{pose_of(fields, named), speed_of(fields),
               fields.not_negative("blend", Quantity::length)};
}

Instruction::What read_movec(const YamlNode& node, const NamedThings& named) {
  const Fields fields(node, "movec", {"via", "to", "speed", "blend"});
  return MoveC{pose_of(fields.need("via"), fields.named("via"), named),
               pose_of(fields.need("to"), fields.named("to"), named), speed_of(fields),
               fields.not_negative("blend", Quantity::length)};
}

/// @param a, b  keys of the semi-axes.
DrawEllipse ellipse_of(const Fields& fields, const char* word, const char* a, const char* b) {
  DrawEllipse out;
  out.word = word;
  out.center = fields.vector("center", Quantity::length);
  out.normal = fields.vector("normal", Quantity::number);
  out.a = positive_of(fields.need(a), fields.named(a), Quantity::length);
  out.b = positive_of(fields.need(b), fields.named(b), Quantity::length);
  out.R_FT = fields.rotation();
  out.frame = fields.frame();
  out.speed = speed_of(fields);
  return out;
}

Instruction::What read_ellipse(const YamlNode& node, const NamedThings&) {
  const Fields fields(node, "ellipse",
                      {"center", "a", "b", "normal", "euler", "quat", "matrix", "frame", "speed"});
  return ellipse_of(fields, "ellipse", "a", "b");
}

Instruction::What read_circle(const YamlNode& node, const NamedThings& named) {
  const Fields fields(
      node, "circle",
      {"center", "radius", "normal", "via", "to", "euler", "quat", "matrix", "frame", "speed"});
  if (fields.find("via") != nullptr || fields.find("to") != nullptr) {
    const Fields round(node, "circle", {"via", "to", "speed"});
    return MoveC{.via = pose_of(round.need("via"), round.named("via"), named),
                 .to = pose_of(round.need("to"), round.named("to"), named),
                 .speed = speed_of(round),
                 .whole = true};
  }
  return ellipse_of(fields, "circle", "radius", "radius");
}

Instruction::What read_polyline(const YamlNode& node, const NamedThings& named) {
  const Fields fields(node, "polyline",
                      {"points", "euler", "quat", "matrix", "frame", "speed", "blend"});
  const YamlNode& points = fields.need("points");
  if (points.kind != YamlNode::Kind::list || points.items.size() < 2) {
    throw ReadFault{points.place, text(msg::program_expected_points, fields.named("points"))};
  }
  DrawPolyline out;
  std::optional<Eigen::Matrix3d> R;
  for (const YamlNode& point : points.items) {
    if (point.kind == YamlNode::Kind::list) {
      if (!R) R = fields.rotation();
      out.points.push_back(
          {{vector_of(point, fields.named("points"), Quantity::length), *R}, fields.frame()});
    } else {
      out.points.push_back(pose_of(point, fields.named("points"), named));
    }
  }
  out.speed = speed_of(fields);
  out.blend = fields.not_negative("blend", Quantity::length);
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

Instruction::What read_text(const YamlNode& node, const NamedThings&) {
  const Fields fields(node, "text",
                      {"text", "pos", "right", "up", "height", "lift", "euler", "quat", "matrix",
                       "frame", "speed"});
  DrawText out;
  out.text = text_of(fields.need("text"), fields.named("text"));
  out.plane.X_FT = {fields.vector("pos", Quantity::length), plane_of(fields)};
  out.plane.frame = fields.frame();
  out.R_FT = fields.rotation();
  out.height = fields.positive("height", Quantity::length).value_or(out.height);
  out.lift = fields.positive("lift", Quantity::length).value_or(out.lift);
  out.speed = speed_of(fields);
  return out;
}

Instruction::What read_wait(const YamlNode& node, const NamedThings&) {
  const double seconds = number_of(node, "wait", Quantity::time);
  if (!(seconds >= 0 && seconds <= kMaxSeconds)) {
    throw ReadFault{node.place, text(msg::program_out_of_range, "wait", kMaxSeconds, seconds)};
  }
  return Wait{seconds};
}

Instruction::What read_set(const YamlNode& node, const NamedThings&) {
  return set_of(Fields(node, "set", {"tool", "frame", "speed", "joint_speed", "zone"}));
}

Instruction::What read_plan(const YamlNode& node, const NamedThings& named) {
  if (node.kind == YamlNode::Kind::scalar) return PlanMove{pose_of(node, "plan", named)};
  return PlanMove{goal_of(Fields(node, "plan", {"joints", MJARM_POSE_KEYS}), named)};
}

Instruction::What read_grip(const YamlNode& node, const NamedThings&) {
  return Grip{word_of(node, "grip", {"open", "close"}) == "close"};
}

Instruction::What read_repeat(const YamlNode& node, const NamedThings& named) {
  const Fields fields(node, "repeat", {"times", "program"});
  const YamlNode& times = fields.need("times");
  const double count = number_of(times, fields.named("times"), Quantity::number);
  if (!(count >= 0 && count <= kMaxRepeats) || std::floor(count) != count) {
    throw ReadFault{times.place, text(msg::program_bad_count, fields.named("times"), kMaxRepeats)};
  }
  return Repeat{static_cast<int>(count),
                instructions_of(fields.need("program"), fields.named("program"), named)};
}

struct Word {
  const char* word;
  Instruction::What (*read)(const YamlNode& node, const NamedThings& named);
};
constexpr std::array<Word, 12> kWords{{{"movej", read_movej},
                                       {"movel", read_movel},
                                       {"movec", read_movec},
                                       {"ellipse", read_ellipse},
                                       {"circle", read_circle},
                                       {"polyline", read_polyline},
                                       {"text", read_text},
                                       {"wait", read_wait},
                                       {"set", read_set},
                                       {"repeat", read_repeat},
                                       {"plan", read_plan},
                                       {"grip", read_grip}}};

}  // namespace

Set set_of(const Fields& fields) {
  Set out;
  if (const YamlNode* tool = fields.find("tool")) out.tool = text_of(*tool, fields.named("tool"));
  if (fields.find("frame") != nullptr) out.frame = fields.frame();
  out.speed = speed_of(fields);
  out.share = share_of(fields, "joint_speed");
  out.zone = fields.not_negative("zone", Quantity::length);
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
  for (const YamlNode& item : node.items) out.push_back(instruction_of(item, named));
  return out;
}

}  // namespace mjarm::program::detail
