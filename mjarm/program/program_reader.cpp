#include "mjarm/program/program_reader.hpp"

#include <utility>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/program.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/program/fields_internal.hpp"

namespace mjarm::program {
namespace {

using detail::Fields;
using detail::NamedThings;
using detail::ReadFault;

const YamlNode& map_at(const Fields& fields, std::string_view key) {
  const YamlNode& node = fields.need(key);
  if (node.kind != YamlNode::Kind::map) {
    throw ReadFault{node.place, text(msg::program_expected_fields, key)};
  }
  return node;
}

std::map<std::string, ProgramPose> read_frames(const Fields& fields) {
  std::map<std::string, ProgramPose> frames;
  if (fields.find("frames") == nullptr) return frames;
  for (const auto& [name, node] : map_at(fields, "frames").members) {
    const Fields frame(node, "frames: " + name.text, {"pos", "euler", "quat", "matrix", "frame"});
    if (name.text == "world") throw ReadFault{name.place, text(msg::program_world_is_taken)};
    ProgramPose pose{{frame.vector("pos", Quantity::length), frame.rotation()}, frame.frame()};
    if (pose.frame.name.empty()) pose.frame = {"world", name.place};
    frames.emplace(name.text, std::move(pose));
  }
  return frames;
}

NamedThings read_names(const Fields& fields) {
  NamedThings named;
  named.postures["home"] = {};
  if (fields.find("poses") != nullptr) {
    for (const auto& [name, node] : map_at(fields, "poses").members) {
      named.poses.emplace(name.text, detail::pose_of(node, "poses: " + name.text, named));
    }
  }
  if (fields.find("postures") != nullptr) {
    for (const auto& [name, node] : map_at(fields, "postures").members) {
      named.postures[name.text] = detail::joints_of(node, "postures: " + name.text, named);
    }
  }
  return named;
}

std::string optional_text(const Fields& fields, std::string_view key, FilePlace& place) {
  const YamlNode* node = fields.find(key);
  if (node == nullptr) return {};
  place = node->place;
  return detail::text_of(*node, key);
}

Program read(const YamlNode& root) {
  const Fields fields(root, "program",
                      {"robot", "scene", "tool", "start", "frame", "frames", "poses", "postures",
                       "speed", "joint_speed", "zone", "control", "program"});
  Program out;
  const YamlNode& robot = fields.need("robot");
  out.robot = detail::text_of(robot, "robot");
  out.robot_place = robot.place;
  out.scene = optional_text(fields, "scene", out.scene_place);
  out.tool = optional_text(fields, "tool", out.tool_place);
  if (const YamlNode* control = fields.find("control")) {
    const Result<ControlMode> mode = control_mode(detail::text_of(*control, "control"));
    if (!mode) throw ReadFault{control->place, mode.error().what};
    out.control = *mode;
  }
  out.frames = read_frames(fields);
  out.settings = detail::set_of(fields);
  out.settings.tool.reset();
  const NamedThings named = read_names(fields);
  if (const YamlNode* start = fields.find("start")) {
    out.start = detail::joints_of(*start, "start", named);
    out.start_place = start->place;
  }
  out.instructions = detail::instructions_of(fields.need("program"), "program", named);
  return out;
}

}  // namespace

Result<Program> parse_program(const std::string& content, const std::string& name) {
  const Result<YamlNode> root = read_yaml(content, name);
  if (!root) return fail(root.error());
  if (root->place.line == 0) {
    return fail(Errc::bad_input, at_place(name, {1, 1}, text(msg::program_empty)));
  }
  try {
    return read(*root);
  } catch (const ReadFault& fault) {
    return fail(Errc::bad_input, at_place(name, fault.place, fault.what));
  }
}

Result<Program> read_program(const std::filesystem::path& file) {
  constexpr std::size_t kMaxBytes = std::size_t{16} << 20;
  const Result<std::string> content = read_file(file, kMaxBytes);
  if (!content) return fail(content.error());
  Result<Program> program = parse_program(*content, file.string());
  if (program) program->name = file.stem().string();
  return program;
}

}  // namespace mjarm::program
