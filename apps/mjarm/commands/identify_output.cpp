#include "apps/mjarm/commands/identify_output.hpp"

#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "apps/mjarm/cli/table.hpp"
#include "apps/mjarm/messages/identify.hpp"
#include "mjarm/core/json_writer.hpp"

namespace mjarm::app {
namespace {

std::string payload_text(const PayloadEstimate& payload, const Arm& arm) {
  if (!payload.is_told()) {
    return text(msg::identify_no_payload, describe(payload.mass)) + "\n";
  }
  std::vector<std::vector<std::string>> rows{
      {text(msg::identify_mass), describe(payload.mass), "kg"}};
  for (std::size_t i = 0; i < 3; ++i) {
    rows.push_back({text(msg::identify_center, std::string_view("xyz").substr(i, 1)),
                    describe(payload.center[i]), "m"});
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
    rows.push_back({arm.joints[j].name, describe(one.friction), describe(one.viscous),
                    describe(one.offset), describe(one.inertia), fmt::format("{:.4f}", one.rms)});
  }
  return text(msg::identify_joints) + "\n" + aligned(rows);
}

std::string links_text(const Identification& found, const Arm& arm) {
  std::vector<std::vector<std::string>> rows{
      {"", text(msg::identify_head_estimate), text(msg::identify_head_model)}};
  for (std::size_t i = 0; i < found.links.size(); ++i) {
    rows.push_back({parameter_name(found.base.kept[i], arm), describe(found.links[i]),
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
    doc.set("payload", JsonDoc{{"told", payload.is_told()},
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
