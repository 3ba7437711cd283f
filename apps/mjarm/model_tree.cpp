#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/mjarm/model_report.hpp"
#include "mjarm/core/messages/app.hpp"

namespace mjarm::app {
namespace {

using Json = nlohmann::ordered_json;

int count_colliding(const BodyInfo& body) {
  return static_cast<int>(std::count_if(body.geoms.begin(), body.geoms.end(),
                                        [](const GeomInfo& geom) { return geom.collides; }));
}

std::string body_line(const BodyInfo& body) {
  std::string line(static_cast<std::size_t>(2 * body.depth), ' ');
  line += body.name;
  if (body.mass > 0) line += fmt::format("  {:.4g} kg", body.mass);
  if (!body.geoms.empty()) {
    line += "  " + text(msg::app_tree_geoms, body.geoms.size(), count_colliding(body));
  }
  for (const JointInfo& joint : body.joints) {
    line += fmt::format("  {} {}", joint.type, joint.name);
    if (joint.limited) line += fmt::format(" [{:.4g}, {:.4g}]", joint.lower, joint.upper);
  }
  for (const std::string& site : body.sites) line += "  site " + site;
  return line + "\n";
}

Json body_json(const BodyInfo& body) {
  Json json = {{"name", body.name},
               {"mass", body.mass},
               {"geoms", body.geoms.size()},
               {"colliding", count_colliding(body)},
               {"sites", body.sites}};
  Json& joints = json["joints"] = Json::array();
  for (const JointInfo& joint : body.joints) {
    Json entry = {{"name", joint.name}, {"type", joint.type}};
    entry["range"] = joint.limited ? Json({joint.lower, joint.upper}) : Json(nullptr);
    joints.push_back(entry);
  }
  json["children"] = Json::array();
  return json;
}

}  // namespace

std::string tree_text(const ModelInfo& contents) {
  std::string result;
  for (const BodyInfo& body : contents.bodies) result += body_line(body);
  return result;
}

std::string tree_json(const ModelInfo& contents) {
  std::vector<Json> nodes;
  for (const BodyInfo& body : contents.bodies) nodes.push_back(body_json(body));
  // From the last to the first: every body is complete before it goes into its parent.
  for (std::size_t i = nodes.size() - 1; i > 0; --i) {
    Json& siblings = nodes[static_cast<std::size_t>(contents.bodies[i].parent)]["children"];
    siblings.insert(siblings.begin(), std::move(nodes[i]));
  }
  return nodes.front().dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace mjarm::app
