#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/mjarm/model_report.hpp"
#include "mjarm/core/messages.hpp"

namespace mjarm::app {
namespace {

using Json = nlohmann::ordered_json;

std::string or_unnamed(const std::string& name) { return name.empty() ? "-" : name; }

std::string body_line(const BodyEntry& body) {
  std::string line(static_cast<std::size_t>(2 * body.depth), ' ');
  line += or_unnamed(body.name);
  if (body.mass > 0) line += fmt::format("  {:.4g} kg", body.mass);
  if (body.geoms > 0) line += "  " + text(Msg::app_tree_geoms, body.geoms, body.colliding);
  for (const JointEntry& joint : body.joints) {
    line += fmt::format("  {} {}", joint.type, or_unnamed(joint.name));
    if (joint.limited) line += fmt::format(" [{:.4g}, {:.4g}]", joint.lower, joint.upper);
  }
  for (const std::string& site : body.sites) line += "  site " + or_unnamed(site);
  return line + "\n";
}

Json body_json(const BodyEntry& body) {
  Json json = {{"name", body.name},
               {"mass", body.mass},
               {"geoms", body.geoms},
               {"colliding", body.colliding},
               {"sites", body.sites}};
  Json& joints = json["joints"] = Json::array();
  for (const JointEntry& joint : body.joints) {
    Json entry = {{"name", joint.name}, {"type", joint.type}};
    entry["range"] = joint.limited ? Json({joint.lower, joint.upper}) : Json(nullptr);
    joints.push_back(entry);
  }
  json["children"] = Json::array();
  return json;
}

}  // namespace

std::string tree_text(const ModelInventory& contents) {
  // Parents come before their children, but a branch need not be contiguous: walk it.
  std::vector<std::vector<std::size_t>> children(contents.bodies.size());
  for (std::size_t i = 1; i < contents.bodies.size(); ++i) {
    children[static_cast<std::size_t>(contents.bodies[i].parent)].push_back(i);
  }
  std::string result;
  std::vector<std::size_t> open = {0};
  while (!open.empty()) {
    const std::size_t body = open.back();
    open.pop_back();
    result += body_line(contents.bodies[body]);
    open.insert(open.end(), children[body].rbegin(), children[body].rend());
  }
  return result;
}

std::string tree_json(const ModelInventory& contents) {
  std::vector<Json> nodes;
  for (const BodyEntry& body : contents.bodies) nodes.push_back(body_json(body));
  // From the last to the first: every body is complete before it goes into its parent.
  for (std::size_t i = nodes.size() - 1; i > 0; --i) {
    Json& siblings = nodes[static_cast<std::size_t>(contents.bodies[i].parent)]["children"];
    siblings.insert(siblings.begin(), std::move(nodes[i]));
  }
  return nodes.front().dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace mjarm::app
