#include "apps/mjarm/commands/identify_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "apps/mjarm/cli/table.hpp"
#include "apps/mjarm/messages/identify.hpp"
#include "mjarm/core/json_writer.hpp"

namespace mjarm::app {
namespace {

constexpr std::array<const char*, kInertialSize> kParameterNames{"m",   "mx",  "my",  "mz",  "Ixx",
                                                                 "Iyy", "Izz", "Ixy", "Ixz", "Iyz"};

std::string with_error(const Estimate& estimate) {
  if (!estimate.known) return "-";
  // Two digits of the error say all there is.
  const double digits = std::ceil(1 - std::log10(std::max(estimate.error, 1e-12)));
  const int decimals = static_cast<int>(std::clamp(digits, 0.0, 6.0));
  return fmt::format("{:.{}f} +- {:.{}f}", estimate.value, decimals, estimate.error, decimals);
}

/// "mx wrist_1_joint"
std::string parameter_name(int column, const Arm& arm) {
  const int links = kInertialSize * arm.dof();
  if (column >= links) return "rotor " + arm.joints[static_cast<std::size_t>(column - links)].name;
  return std::string(kParameterNames[static_cast<std::size_t>(column % kInertialSize)]) + " " +
         arm.joints[static_cast<std::size_t>(column / kInertialSize)].name;
}

/// Whether there is more than nothing, for three standard errors.
bool is_told(const PayloadEstimate& payload) {
  constexpr double kErrors = 3;
  return payload.mass.known && payload.mass.value > kErrors * payload.mass.error;
}

std::string payload_text(const PayloadEstimate& payload, const Arm& arm) {
  if (!is_told(payload)) {
    return text(msg::identify_no_payload, with_error(payload.mass)) + "\n";
  }
  std::vector<std::vector<std::string>> rows{
      {text(msg::identify_mass), with_error(payload.mass), "kg"}};
  for (std::size_t i = 0; i < 3; ++i) {
    rows.push_back({text(msg::identify_center, std::string_view("xyz").substr(i, 1)),
                    with_error(payload.center[i]), "m"});
  }
  const Payload found = payload.payload();
  const std::string words = fmt::format("{:.4f},{:.4f},{:.4f},{:.4f}", found.mass, found.center.x(),
                                        found.center.y(), found.center.z());
  return text(msg::identify_payload, arm.tip) + "\n" + aligned(rows) +
         text(msg::identify_use, words) + "\n";
}

std::string joints_text(const Identification& found, const Arm& arm) {
  std::vector<std::vector<std::string>> rows{
      {"", text(msg::identify_head_friction), text(msg::identify_head_viscous),
       text(msg::identify_head_offset), text(msg::identify_head_inertia),
       text(msg::identify_head_rms)}};
  for (std::size_t j = 0; j < found.joints.size(); ++j) {
    const JointEstimate& one = found.joints[j];
    rows.push_back({arm.joints[j].name, with_error(one.friction), with_error(one.viscous),
                    with_error(one.offset), with_error(one.inertia),
                    fmt::format("{:.4f}", one.rms)});
  }
  return text(msg::identify_joints) + "\n" + aligned(rows);
}

std::string links_text(const Identification& found, const Arm& arm) {
  std::vector<std::vector<std::string>> rows{
      {"", text(msg::identify_head_estimate), text(msg::identify_head_model)}};
  for (std::size_t i = 0; i < found.links.size(); ++i) {
    rows.push_back({parameter_name(found.base.kept[i], arm), with_error(found.links[i]),
                    fmt::format("{:.4f}", found.model_links[static_cast<Eigen::Index>(i)])});
  }
  return text(msg::identify_links) + "\n" + aligned(rows);
}

JsonDoc json_of(const Estimate& estimate) {
  if (!estimate.known) return nullptr;
  return JsonDoc{{"value", estimate.value}, {"error", estimate.error}};
}

JsonDoc link_json(const Identification& found, std::size_t i, const Arm& arm) {
  const auto row = static_cast<Eigen::Index>(i);
  std::vector<JsonDoc> merged;
  for (std::size_t k = 0; k < found.base.merged.size(); ++k) {
    const double weight = found.base.weight(row, static_cast<Eigen::Index>(k));
    if (weight == 0) continue;
    merged.push_back(
        JsonDoc{{"name", parameter_name(found.base.merged[k], arm)}, {"weight", weight}});
  }
  return JsonDoc{{"name", parameter_name(found.base.kept[i], arm)},
                 {"estimate", json_of(found.links[i])},
                 {"model", found.model_links[row]},
                 {"with", std::move(merged)}};
}

}  // namespace

std::string identification_text(const Identification& found, const Arm& arm) {
  std::string out;
  if (found.payload) out += payload_text(*found.payload, arm);
  out += joints_text(found, arm);
  if (!found.links.empty()) out += links_text(found, arm);
  // A row of our own log has the torque that led to it.
  if (found.delay > 0) out += text(msg::identify_delay, 1e3 * found.delay) + "\n";
  return out + text(msg::identify_rows, found.rows) + "\n";
}

std::string identification_json(const Identification& found, const Arm& arm) {
  JsonDoc doc{{"delay", found.delay}, {"equations", found.rows}};
  if (found.payload) {
    const PayloadEstimate& payload = *found.payload;
    doc.set("payload", JsonDoc{{"told", is_told(payload)},
                               {"frame", arm.tip},
                               {"mass", json_of(payload.mass)},
                               {"com", std::vector<JsonDoc>{json_of(payload.center[0]),
                                                            json_of(payload.center[1]),
                                                            json_of(payload.center[2])}}});
  }
  std::vector<JsonDoc> joints, links;
  for (std::size_t j = 0; j < found.joints.size(); ++j) {
    const JointEstimate& one = found.joints[j];
    joints.push_back(JsonDoc{{"name", arm.joints[j].name},
                             {"friction", json_of(one.friction)},
                             {"viscous", json_of(one.viscous)},
                             {"offset", json_of(one.offset)},
                             {"inertia", json_of(one.inertia)},
                             {"rms", one.rms}});
  }
  for (std::size_t i = 0; i < found.links.size(); ++i) links.push_back(link_json(found, i, arm));
  doc.set("joints", std::move(joints));
  if (!links.empty()) doc.set("links", std::move(links));
  return doc.document();
}

}  // namespace mjarm::app
