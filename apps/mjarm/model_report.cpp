#include "apps/mjarm/model_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "mjarm/core/messages.hpp"
#include "mjarm/core/text_width.hpp"

namespace mjarm::app {
namespace {

using Json = nlohmann::ordered_json;
using Row = std::vector<std::string>;

std::string join(const std::vector<std::string>& words, const char* between = ", ") {
  std::string result;
  for (const std::string& word : words) {
    if (word.empty()) continue;
    if (!result.empty()) result += between;
    result += word;
  }
  return result;
}

std::string or_none(const std::string& words) {
  return words.empty() ? text(Msg::app_info_none) : words;
}

LimitSource limit_source(const Model& model, const ModelInventory& contents,
                         const std::string& joint) {
  LimitSource source;
  source.velocity = model.urdf_velocity_limit(joint) > 0;
  source.torque = model.urdf_effort_limit(joint) > 0;
  for (const BodyEntry& body : contents.bodies) {
    for (const JointEntry& entry : body.joints) {
      if (entry.name != joint) continue;
      source.position = entry.limited;
      source.torque |= entry.force_limited;
    }
  }
  return source;
}

/// Named frames that move with the last joint of the arm and with no joint after it.
std::vector<std::string> possible_tips(const ModelInventory& contents, const std::string& last) {
  std::vector<bool> fixed(contents.bodies.size(), false);
  std::vector<std::string> bodies, sites;
  for (std::size_t i = 0; i < contents.bodies.size(); ++i) {
    const BodyEntry& body = contents.bodies[i];
    const bool carries = std::any_of(body.joints.begin(), body.joints.end(),
                                     [&](const JointEntry& joint) { return joint.name == last; });
    const bool hangs = body.joints.empty() && i > 0 && fixed[static_cast<std::size_t>(body.parent)];
    fixed[i] = carries || hangs;
    if (!fixed[i]) continue;
    bodies.push_back(body.name);
    sites.insert(sites.end(), body.sites.begin(), body.sites.end());
  }
  sites.insert(sites.end(), bodies.begin(), bodies.end());
  std::erase(sites, "");
  return sites;
}

/// "3.142", with a star where the file has no such limit.
std::string limit(double value, bool from_file) {
  return fmt::format("{:.5g}{}", value, from_file ? "" : "*");
}

/// Rows with their columns aligned.
std::string table(const std::vector<Row>& rows) {
  std::vector<int> widths(rows.front().size(), 0);
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], text_width(row[i]));
    }
  }
  std::string result;
  for (const Row& row : rows) {
    std::string line = " ";
    for (std::size_t i = 0; i < row.size(); ++i) line += " " + padded(row[i], widths[i] + 1);
    line.erase(line.find_last_not_of(' ') + 1);
    result += line + "\n";
  }
  return result;
}

std::string joint_table(const ModelReport& report) {
  const Arm& arm = *report.arm;
  std::vector<Row> rows = {{text(Msg::app_info_joint), text(Msg::app_info_type),
                            text(Msg::app_info_position), text(Msg::app_info_velocity),
                            text(Msg::app_info_acceleration), text(Msg::app_info_jerk),
                            text(Msg::app_info_torque), text(Msg::app_info_actuator)}};
  for (int i = 0; i < arm.dof(); ++i) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
    const LimitSource& source = report.sources[static_cast<std::size_t>(i)];
    const JointLimits& limits = arm.limits;
    rows.push_back(
        {joint.name, joint.type == JointType::hinge ? "hinge" : "slide",
         fmt::format("{:.5g} .. {}", limits.lower[i], limit(limits.upper[i], source.position)),
         limit(limits.velocity[i], source.velocity), limit(limits.acceleration[i], false),
         limit(limits.jerk[i], false), limit(limits.torque[i], source.torque),
         joint.actuator ? joint.actuator->name : text(Msg::app_info_none)});
  }
  return table(rows) + "  " + text(Msg::app_info_units) + "\n";
}

std::string arm_text(const ModelReport& report) {
  const auto line = [](Msg what, const std::string& value) {
    return padded(text(what), 18) + value + "\n";
  };
  if (!report.arm) return line(Msg::app_info_arm, text(Msg::app_info_no_arm, report.no_arm));
  const Arm& arm = *report.arm;
  std::vector<std::string> home;
  for (const double value : arm.home) home.push_back(fmt::format("{:.5g}", value));
  std::string result = line(Msg::app_info_arm, text(Msg::app_info_arm_joints, arm.dof()));
  result += joint_table(report);
  result += line(Msg::app_info_tip, arm.tip);
  result += line(Msg::app_info_tips, join(report.tips));
  result += line(Msg::app_info_home, join(home));
  if (!arm.gripper) return result + line(Msg::app_info_gripper, text(Msg::app_info_none));
  const Gripper& gripper = *arm.gripper;
  return result + line(Msg::app_info_gripper,
                       text(Msg::app_info_gripper_line, gripper.actuator,
                            fmt::format("{:.5g}", gripper.ctrl_open),
                            fmt::format("{:.5g}", gripper.ctrl_closed), join(gripper.joints)));
}

Json list(const JointVec& values) {
  return Json(std::vector<double>(values.begin(), values.end()));
}

Json joint_json(const Arm& arm, const LimitSource& source, int i) {
  const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
  Json from_file = Json::array();
  if (source.position) from_file.push_back("position");
  if (source.velocity) from_file.push_back("velocity");
  if (source.torque) from_file.push_back("torque");
  return {{"name", joint.name},
          {"type", joint.type == JointType::hinge ? "hinge" : "slide"},
          {"position", {arm.limits.lower[i], arm.limits.upper[i]}},
          {"velocity", arm.limits.velocity[i]},
          {"acceleration", arm.limits.acceleration[i]},
          {"jerk", arm.limits.jerk[i]},
          {"torque", arm.limits.torque[i]},
          {"from_file", from_file},
          {"actuator", joint.actuator ? Json(joint.actuator->name) : Json(nullptr)}};
}

Json arm_json(const ModelReport& report) {
  const Arm& arm = *report.arm;
  Json result = {{"tip", arm.tip}, {"tips", report.tips}, {"home", list(arm.home)}};
  Json& joints = result["joints"] = Json::array();
  for (int i = 0; i < arm.dof(); ++i) {
    joints.push_back(joint_json(arm, report.sources[static_cast<std::size_t>(i)], i));
  }
  result["gripper"] = nullptr;
  if (arm.gripper) {
    result["gripper"] = {{"actuator", arm.gripper->actuator},
                         {"ctrl_open", arm.gripper->ctrl_open},
                         {"ctrl_closed", arm.gripper->ctrl_closed},
                         {"joints", arm.gripper->joints}};
  }
  return result;
}

Json actuator_json(const ActuatorEntry& actuator) {
  return {{"name", actuator.name},
          {"target", actuator.target},
          {"ctrl", {actuator.ctrl_lower, actuator.ctrl_upper}},
          {"force", {actuator.force_lower, actuator.force_upper}}};
}

/// Names come from files and may hold any bytes; numbers without a bound become null.
std::string document(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

ModelReport model_report(const Model& model, const Result<Arm>& arm) {
  ModelReport report;
  report.file = model.file().string();
  report.name = model.name();
  report.format = model.format() == ModelFormat::urdf ? "URDF" : "MJCF";
  report.timestep = model.timestep();
  report.contents = inventory(model);
  if (!arm) {
    report.no_arm = arm.error().what;
    return report;
  }
  report.arm = *arm;
  for (const ArmJoint& joint : arm->joints) {
    report.sources.push_back(limit_source(model, report.contents, joint.name));
  }
  report.tips = possible_tips(report.contents, arm->joints.back().name);
  return report;
}

std::string to_text(const ModelReport& report) {
  const auto line = [](Msg what, const std::string& value) {
    return padded(text(what), 18) + value + "\n";
  };
  const ModelInventory& all = report.contents;
  return line(Msg::app_info_model, fmt::format("{} ({})", report.name, report.format)) +
         line(Msg::app_info_file, report.file) +
         line(Msg::app_info_timestep, fmt::format("{:g} s", report.timestep)) +
         line(Msg::app_info_contents,
              text(Msg::app_info_counts, all.bodies.size() - 1, all.joints, all.actuators.size(),
                   all.geoms, all.sites, all.sensors, all.tendons, all.meshes)) +
         line(Msg::app_info_mass, fmt::format("{:.5g} kg", all.mass)) +
         line(Msg::app_info_keyframes, or_none(join(all.keyframes))) + arm_text(report);
}

std::string to_json(const ModelReport& report) {
  const ModelInventory& all = report.contents;
  Json json = {{"name", report.name},
               {"file", report.file},
               {"format", report.format},
               {"timestep", report.timestep},
               {"mass", all.mass}};
  json["counts"] = {{"bodies", all.bodies.size() - 1},
                    {"joints", all.joints},
                    {"actuators", all.actuators.size()},
                    {"geoms", all.geoms},
                    {"sites", all.sites},
                    {"sensors", all.sensors},
                    {"tendons", all.tendons},
                    {"meshes", all.meshes},
                    {"equalities", all.equalities}};
  json["keyframes"] = all.keyframes;
  Json& actuators = json["actuators"] = Json::array();
  for (const ActuatorEntry& actuator : all.actuators) actuators.push_back(actuator_json(actuator));
  json["arm"] = report.arm ? arm_json(report) : Json(nullptr);
  if (!report.arm) json["no_arm"] = report.no_arm;
  return document(json);
}

}  // namespace mjarm::app
