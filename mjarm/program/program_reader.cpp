#include "mjarm/program/program_reader.hpp"

#include <algorithm>
#include <utility>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/program.hpp"
#include "mjarm/program/fields_internal.hpp"

namespace mjarm::program {
namespace {

using detail::Fields;
using detail::NamedThings;
using detail::ReadFault;

using detail::or_noted;
using detail::ReadFaults;

/// Calls `read(name, node)` for each member of the map `key`, where there is one.
template <class Read>
void each_of(const Fields& fields, std::string_view key, const Read& read) {
  const YamlNode* node = fields.find(key);
  if (node == nullptr) return;
  if (node->kind != YamlNode::Kind::map) {
    detail::note(fields.faults(), {node->place, text(msg::program_expected_fields, key)});
    return;
  }
  for (const auto& [name, value] : node->members) read(name, value);
}

std::map<std::string, ProgramPose> read_frames(const Fields& fields) {
  std::map<std::string, ProgramPose> frames;
  ReadFaults& faults = fields.faults();
  each_of(fields, "frames", [&](const YamlNode& name, const YamlNode& node) {
    // A frame that cannot be read is known all the same to those who name it.
    frames[name.text] = or_noted(faults, ProgramPose{}, [&]() -> ProgramPose {
      if (name.text == "world") throw ReadFault{name.place, text(msg::program_world_is_taken)};
      const Fields frame(node, text(msg::core_at_place, "frames", name.text),
                         {"pos", "euler", "quat", "matrix", "frame"}, faults);
      const Eigen::Vector3d p = frame.vector("pos", Quantity::length);
      return {{p, frame.rotation()}, frame.frame()};
    });
    FrameName& in = frames[name.text].frame;
    if (in.name.empty()) in = {"world", name.place};
  });
  return frames;
}

NamedThings read_names(const Fields& fields) {
  NamedThings named{.faults = fields.faults()};
  named.postures["home"] = {};
  each_of(fields, "poses", [&](const YamlNode& name, const YamlNode& node) {
    ProgramPose pose = or_noted(named.faults, ProgramPose{}, [&] {
      return detail::pose_of(node, text(msg::core_at_place, "poses", name.text), named);
    });
    named.poses.emplace(name.text, std::move(pose));
  });
  each_of(fields, "postures", [&](const YamlNode& name, const YamlNode& node) {
    named.postures[name.text] = or_noted(named.faults, JointValues{}, [&] {
      return detail::joints_of(node, text(msg::core_at_place, "postures", name.text), named);
    });
  });
  return named;
}

std::string text_at(const Fields& fields, std::string_view key, FilePlace& place) {
  const YamlNode* node = fields.find(key);
  if (node == nullptr) return {};
  place = node->place;
  return or_noted(fields.faults(), std::string(), [&] { return detail::text_of(*node, key); });
}

void read_robot(const Fields& fields, Program& out) {
  out.robot = text_at(fields, "robot", out.robot_place);
  out.scene = text_at(fields, "scene", out.scene_place);
  out.tool = text_at(fields, "tool", out.tool_place);
  if (fields.find("scene") == nullptr) {
    or_noted(fields.faults(), 0, [&] { return fields.need("robot").place.line; });
  }
  if (const YamlNode* contact = fields.find("contact")) {
    out.contact = or_noted(fields.faults(), out.contact, [&]() -> std::optional<ContactReaction> {
      const Result<ContactReaction> reaction =
          contact_reaction(detail::text_of(*contact, "contact"));
      if (!reaction) throw ReadFault{contact->place, reaction.error().what};
      return *reaction;
    });
  }
  const YamlNode* control = fields.find("control");
  if (control == nullptr) return;
  out.control = or_noted(fields.faults(), out.control, [&]() -> std::optional<ControlMode> {
    const Result<ControlMode> mode = control_mode(detail::text_of(*control, "control"));
    if (!mode) throw ReadFault{control->place, mode.error().what};
    return *mode;
  });
}

void read(const YamlNode& root, ProgramText& text) {
  ReadFaults& faults = text.faults;
  Program& out = text.program;
  const Fields fields(
      root, "program",
      {"robot", "scene", "tool", "start", "frame", "frames", "poses", "postures", "speed",
       "joint_speed", "zone", "branch", "payload", "control", "contact", "program"},
      faults);
  read_robot(fields, out);
  out.frames = read_frames(fields);
  out.settings = detail::set_of(fields);
  out.settings.tool.reset();
  const NamedThings named = read_names(fields);
  if (const YamlNode* start = fields.find("start")) {
    out.start =
        or_noted(faults, JointValues{}, [&] { return detail::joints_of(*start, "start", named); });
    out.start_place = start->place;
  }
  out.instructions = detail::instructions_of(fields.need("program"), "program", named);
}

}  // namespace

ProgramText look_through(const std::string& content) {
  ProgramText out;
  const Result<YamlNode, YamlFault> root = read_yaml(content);
  if (!root) {
    out.faults.push_back({root.error().place, root.error().what});
    return out;
  }
  if (root->place.line == 0) {
    out.faults.push_back({{1, 1}, text(msg::program_empty)});
    return out;
  }
  try {
    read(*root, out);
  } catch (const ReadFault& fault) {
    if (!fault.what.empty()) out.faults.push_back(fault);
  } catch (const detail::TooManyFaults&) {
  }
  std::ranges::stable_sort(out.faults, {}, &TextFault::place);
  return out;
}

Result<ProgramText> look_through_file(const std::filesystem::path& file) {
  constexpr std::size_t kMaxBytes = std::size_t{16} << 20;
  const Result<std::string> content = read_file(file, kMaxBytes);
  if (!content) return fail(content.error());
  ProgramText out = look_through(*content);
  out.program.name = file.stem().string();
  return out;
}

namespace {

Result<Program> whole(ProgramText read, const std::string& name) {
  if (read.faults.empty()) return std::move(read.program);
  std::string line = at_place(name, read.faults.front().place, read.faults.front().what);
  if (read.faults.size() > 1) line += text(msg::program_more, read.faults.size() - 1);
  return fail(Errc::bad_input, std::move(line));
}

}  // namespace

Result<Program> parse_program(const std::string& content, const std::string& name) {
  return whole(look_through(content), name);
}

Result<Program> read_program(const std::filesystem::path& file) {
  Result<ProgramText> read = look_through_file(file);
  if (!read) return fail(std::move(read.error()));
  return whole(std::move(*read), file.string());
}

}  // namespace mjarm::program
