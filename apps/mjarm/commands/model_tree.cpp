#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "apps/mjarm/commands/model_report.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/json_writer.hpp"

namespace mjarm::app {
namespace {

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

JsonDoc body_json(const BodyInfo& body, std::vector<JsonDoc> children) {
  std::vector<JsonDoc> joints;
  for (const JointInfo& joint : body.joints) {
    joints.push_back(
        {{"name", joint.name},
         {"type", joint.type},
         {"range", joint.limited ? JsonDoc{joint.lower, joint.upper} : JsonDoc(nullptr)}});
  }
  return {{"name", body.name},
          {"mass", body.mass},
          {"geoms", body.geoms.size()},
          {"colliding", count_colliding(body)},
          {"sites", body.sites},
          {"joints", std::move(joints)},
          {"children", std::move(children)}};
}

}  // namespace

std::string tree_text(const ModelInfo& contents) {
  std::string result;
  for (const BodyInfo& body : contents.bodies) result += body_line(body);
  return result;
}

std::string tree_json(const ModelInfo& contents) {
  std::vector<std::vector<JsonDoc>> children(contents.bodies.size());
  // From the last to the first: every body is complete before it goes into its parent.
  for (std::size_t i = children.size() - 1; i > 0; --i) {
    const BodyInfo& body = contents.bodies[i];
    std::vector<JsonDoc>& siblings = children[static_cast<std::size_t>(body.parent)];
    siblings.insert(siblings.begin(), body_json(body, std::move(children[i])));
  }
  return body_json(contents.bodies.front(), std::move(children.front())).document();
}

}  // namespace mjarm::app
