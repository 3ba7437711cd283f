#include "apps/mjarm/commands/model_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "apps/mjarm/cli/table.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/text_width.hpp"

namespace mjarm::app {
namespace {

std::string join(const std::vector<std::string>& words, const std::string& between) {
  std::string result;
  for (const std::string& word : words) {
    if (word.empty()) continue;
    if (!result.empty()) result += between;
    result += word;
  }
  return result;
}

std::string or_none(const std::string& words) {
  return words.empty() ? text(msg::app_info_none) : words;
}

/// Named frames that move with the last joint of the arm and with no joint after it.
std::vector<std::string> possible_tips(const ModelInfo& contents, const std::string& last) {
  std::set<std::string> fixed;
  std::vector<bool> is_fixed(contents.bodies.size(), false);
  for (std::size_t i = 1; i < contents.bodies.size(); ++i) {
    const BodyInfo& body = contents.bodies[i];
    const bool carries = std::any_of(body.joints.begin(), body.joints.end(),
                                     [&](const JointInfo& joint) { return joint.name == last; });
    is_fixed[i] =
        carries || (body.joints.empty() && is_fixed[static_cast<std::size_t>(body.parent)]);
    if (is_fixed[i]) fixed.insert(body.name);
  }
  std::vector<std::string> tips;
  for (const FrameInfo& frame : contents.frames) {
    if (fixed.count(frame.body) > 0) tips.push_back(frame.name);
  }
  return tips;
}

/// "3.142", with a mark where the file has no such limit.
std::string limit(double value, LimitSource source) {
  const char* mark = source == LimitSource::file ? "" : source == LimitSource::table ? "+" : "*";
  return fmt::format("{:.5g}{}", value, mark);
}

std::string joint_table(const ModelReport& report) {
  const Arm& arm = *report.arm;
  std::vector<std::vector<std::string>> rows = {
      {text(msg::app_info_joint), text(msg::app_info_type), text(msg::app_info_position),
       text(msg::app_info_velocity), text(msg::app_info_acceleration), text(msg::app_info_jerk),
       text(msg::app_info_torque), text(msg::app_info_actuator)}};
  for (int i = 0; i < arm.dof(); ++i) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
    const JointLimits& limits = arm.limits;
    const LimitSources& source = limits.sources[static_cast<std::size_t>(i)];
    rows.push_back({joint.name, joint.type == JointType::hinge ? "hinge" : "slide",
                    fmt::format("{:.5g} .. {:.5g}", limits.lower[i], limits.upper[i]),
                    limit(limits.velocity[i], source.velocity),
                    limit(limits.acceleration[i], source.acceleration),
                    limit(limits.jerk[i], source.jerk), limit(limits.torque[i], source.torque),
                    joint.actuator ? joint.actuator->name : text(msg::app_info_none)});
  }
  return aligned(rows) + "  " + text(msg::app_info_units) + "\n";
}

std::string arm_text(const ModelReport& report) {
  const auto line = [](Msg what, const std::string& value) {
    return padded(text(what), 18) + value + "\n";
  };
  if (!report.arm) return line(msg::app_info_arm, text(msg::app_info_no_arm, report.no_arm));
  const Arm& arm = *report.arm;
  std::vector<std::string> home;
  for (const double value : arm.home) home.push_back(fmt::format("{:.5g}", value));
  std::string result = line(msg::app_info_arm, text(msg::app_info_arm_joints, arm.dof()));
  result += joint_table(report);
  result += line(msg::app_info_tip, arm.tip);
  result += line(msg::app_info_tips, join(report.tips, text(msg::core_comma)));
  result += line(msg::app_info_home, join(home, ", "));
  if (!arm.gripper) return result + line(msg::app_info_gripper, text(msg::app_info_none));
  std::vector<std::string> drives;
  for (const GripperDrive& drive : arm.gripper->drives) {
    drives.push_back(text(msg::app_info_drive, drive.actuator,
                          fmt::format("{:.5g}", drive.ctrl_open),
                          fmt::format("{:.5g}", drive.ctrl_closed)));
  }
  return result + line(msg::app_info_gripper,
                       text(msg::app_info_gripper_line, join(drives, text(msg::core_semicolon)),
                            join(arm.gripper->joints, text(msg::core_comma))));
}

JsonDoc joint_json(const Arm& arm, int i) {
  const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
  const LimitSources& source = arm.limits.sources[static_cast<std::size_t>(i)];
  JsonDoc sources = {{"velocity", name(source.velocity)},
                     {"acceleration", name(source.acceleration)},
                     {"jerk", name(source.jerk)},
                     {"torque", name(source.torque)}};
  return {{"name", joint.name},
          {"type", joint.type == JointType::hinge ? "hinge" : "slide"},
          {"position", {arm.limits.lower[i], arm.limits.upper[i]}},
          {"velocity", arm.limits.velocity[i]},
          {"acceleration", arm.limits.acceleration[i]},
          {"jerk", arm.limits.jerk[i]},
          {"torque", arm.limits.torque[i]},
          {"sources", std::move(sources)},
          {"actuator", joint.actuator ? JsonDoc(joint.actuator->name) : JsonDoc(nullptr)}};
}

JsonDoc drive_json(const GripperDrive& drive) {
  return {{"actuator", drive.actuator},
          {"ctrl_open", drive.ctrl_open},
          {"ctrl_closed", drive.ctrl_closed}};
}

JsonDoc arm_json(const ModelReport& report) {
  const Arm& arm = *report.arm;
  std::vector<JsonDoc> joints;
  for (int i = 0; i < arm.dof(); ++i) joints.push_back(joint_json(arm, i));
  JsonDoc gripper;
  if (arm.gripper) {
    const std::vector<GripperDrive>& drives = arm.gripper->drives;
    gripper = drive_json(drives.front());
    gripper.set("joints", arm.gripper->joints);
    std::vector<JsonDoc> others;
    for (std::size_t i = 1; i < drives.size(); ++i) others.push_back(drive_json(drives[i]));
    if (!others.empty()) gripper.set("others", std::move(others));
  }
  return {{"tip", arm.tip},
          {"tips", report.tips},
          {"home", arm.home},
          {"joints", std::move(joints)},
          {"gripper", std::move(gripper)}};
}

JsonDoc range(bool limited, double lower, double upper) {
  return limited ? JsonDoc{lower, upper} : JsonDoc(nullptr);
}

JsonDoc actuator_json(const ActuatorInfo& actuator) {
  return {{"name", actuator.name},
          {"drives", actuator.drives},
          {"target", actuator.target},
          {"ctrl", range(actuator.ctrl_limited, actuator.ctrl_lower, actuator.ctrl_upper)},
          {"force", range(actuator.force_limited, actuator.force_lower, actuator.force_upper)}};
}

/// How many there are of everything, in the order of the output.
struct Counts {
  std::size_t bodies, joints = 0, actuators, geoms = 0, sites = 0, sensors, cameras;
  int meshes;
};

Counts count(const ModelInfo& contents) {
  Counts counts{.bodies = contents.bodies.size() - 1,
                .actuators = contents.actuators.size(),
                .sensors = contents.sensors.size(),
                .cameras = contents.cameras.size(),
                .meshes = contents.meshes};
  for (const BodyInfo& body : contents.bodies) {
    counts.joints += body.joints.size();
    counts.geoms += body.geoms.size();
    counts.sites += body.sites.size();
  }
  return counts;
}

std::vector<std::string> keyframe_names(const ModelInfo& contents) {
  std::vector<std::string> names;
  for (const KeyframeInfo& keyframe : contents.keyframes) names.push_back(keyframe.name);
  return names;
}

}  // namespace

ModelReport model_report(const Model& model, const Result<Arm>& arm) {
  ModelReport report;
  report.file = model.file().string();
  report.format = model.format() == ModelFormat::urdf ? "URDF" : "MJCF";
  report.contents = describe(model);
  if (!arm) {
    report.no_arm = arm.error().what;
    return report;
  }
  report.arm = *arm;
  report.tips = possible_tips(report.contents, arm->joints.back().name);
  return report;
}

std::string to_text(const ModelReport& report) {
  const auto line = [](Msg what, const std::string& value) {
    return padded(text(what), 18) + value + "\n";
  };
  const ModelInfo& all = report.contents;
  const Counts counts = count(all);
  return line(msg::app_info_model, fmt::format("{} ({})", all.name, report.format)) +
         line(msg::app_info_file, report.file) +
         line(msg::app_info_timestep, fmt::format("{:g} s", all.timestep)) +
         line(msg::app_info_contents,
              text(msg::app_info_counts, counts.bodies, counts.joints, counts.actuators,
                   counts.geoms, counts.sites, counts.sensors, counts.cameras, counts.meshes)) +
         line(msg::app_info_mass, fmt::format("{:.5g} kg", all.mass)) +
         line(msg::app_info_keyframes, or_none(join(keyframe_names(all), text(msg::core_comma)))) +
         arm_text(report);
}

std::string to_json(const ModelReport& report) {
  const ModelInfo& all = report.contents;
  const Counts counts = count(all);
  std::vector<JsonDoc> actuators;
  for (const ActuatorInfo& actuator : all.actuators) actuators.push_back(actuator_json(actuator));
  JsonDoc json{{"name", all.name},
               {"file", report.file},
               {"format", report.format},
               {"timestep", all.timestep},
               {"mass", all.mass},
               {"counts",
                {{"bodies", counts.bodies},
                 {"joints", counts.joints},
                 {"actuators", counts.actuators},
                 {"geoms", counts.geoms},
                 {"sites", counts.sites},
                 {"sensors", counts.sensors},
                 {"cameras", counts.cameras},
                 {"meshes", counts.meshes}}},
               {"keyframes", keyframe_names(all)},
               {"actuators", std::move(actuators)},
               {"arm", report.arm ? arm_json(report) : JsonDoc(nullptr)}};
  if (!report.arm) json.set("no_arm", report.no_arm);
  return json.document();
}

}  // namespace mjarm::app
