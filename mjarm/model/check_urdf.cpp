#include <cmath>
#include <map>

#include "mjarm/core/messages/check.hpp"
#include "mjarm/core/messages/model.hpp"
#include "mjarm/model/check_internal.hpp"

namespace mjarm {
using tinyxml2::XMLElement;
namespace {

/// Links that a moving joint moves directly, and links fixed to each other.
struct UrdfTree {
  std::map<std::string, const SourceNode*> links;
  std::map<std::string, std::string> parent;  ///< link -> link above
  std::map<std::string, bool> fixed;          ///< link -> its joint is fixed

  explicit UrdfTree(const Description& description) {
    for (const SourceNode& node : description.nodes()) {
      if (node.section != node.kind() || !node.around.empty()) continue;
      if (node.kind() == "link") links[std::string(node.attribute("name"))] = &node;
      if (node.kind() != "joint") continue;
      const XMLElement* above = node.element->FirstChildElement("parent");
      const XMLElement* below = node.element->FirstChildElement("child");
      if (above == nullptr || below == nullptr) continue;
      const char* from = above->Attribute("link");
      const char* to = below->Attribute("link");
      if (from == nullptr || to == nullptr) continue;
      parent[to] = from;
      fixed[to] = node.attribute("type") == "fixed";
    }
  }

  /// The link that moves `name`: itself or the one it is fixed to; empty where nothing moves it.
  [[nodiscard]] std::string mover(std::string name) const {
    for (std::size_t steps = 0; steps <= parent.size(); ++steps) {
      const auto at = parent.find(name);
      if (at == parent.end()) return "";
      if (!fixed.at(name)) return name;
      name = at->second;
    }
    return "";
  }
};

double number_of(const XMLElement* element, const char* attribute) {
  return element != nullptr ? element->DoubleAttribute(attribute) : 0;
}

Place place_of(const CheckContext& context, const SourceNode& node, const XMLElement* element) {
  Place place = context.description.place(node);
  if (element == nullptr) return place;
  place.line = element->GetLineNum();
  place.element = text(msg::model_element_of, element->Name(), std::string(node.attribute("name")));
  return place;
}

/// @param mover  the link that moves this one, itself or one before it; empty where nothing does.
void check_link(const CheckContext& context, const SourceNode& link, const std::string& mover,
                bool mover_has_mass) {
  const bool moves = !mover.empty();
  const XMLElement* inertial = link.element->FirstChildElement("inertial");
  const bool seen = link.element->FirstChildElement("visual") != nullptr;
  const bool touches = link.element->FirstChildElement("collision") != nullptr;
  if (seen && !touches) {
    context.add(CheckCode::collision_missing, Grade::note, context.description.place(link),
                text(msg::check_collision_missing));
  }
  if (inertial == nullptr) {
    if (moves && (!mover_has_mass || seen || touches)) {
      context.add(CheckCode::inertial_missing, Grade::warning, context.description.place(link),
                  text(msg::check_inertial_missing));
    }
    return;
  }
  const XMLElement* mass = inertial->FirstChildElement("mass");
  const double kilograms = number_of(mass, "value");
  const bool is_mover = moves && !mover_has_mass;
  if (is_mover && !(kilograms > 0)) {
    context.add(CheckCode::mass_zero, Grade::error,
                place_of(context, link, mass != nullptr ? mass : inertial),
                text(msg::check_mass_zero, kilograms));
  }
  const XMLElement* inertia = inertial->FirstChildElement("inertia");
  if (inertia == nullptr || !moves || !(kilograms > 0)) return;
  const auto entry = [&](const char* name) { return number_of(inertia, name); };
  Eigen::Matrix3d I;
  I << entry("ixx"), entry("ixy"), entry("ixz"), entry("ixy"), entry("iyy"), entry("iyz"),
      entry("ixz"), entry("iyz"), entry("izz");
  // A sensor fixed to a link may well be a mere point of mass.
  const bool is_point = mover != link.attribute("name") && I.norm() < 1e-9;
  if (!is_point) check_moments(context, place_of(context, link, inertia), principal_moments(I));
}

}  // namespace

void check_urdf_links(const CheckContext& context) {
  const UrdfTree tree(context.description);
  std::map<std::string, double> mass;  // of all that moves with a link
  for (const auto& [name, link] : tree.links) {
    const XMLElement* inertial = link->element->FirstChildElement("inertial");
    if (inertial == nullptr) continue;
    mass[tree.mover(name)] += number_of(inertial->FirstChildElement("mass"), "value");
  }
  for (const SourceNode& node : context.description.nodes()) {
    if (node.kind() != "link" || node.section != "link" || !node.around.empty()) continue;
    const std::string mover = tree.mover(std::string(node.attribute("name")));
    check_link(context, node, mover, mover.empty() || mass[mover] > 0);
  }
}

namespace {

void check_limit(const CheckContext& context, const SourceNode& joint) {
  const XMLElement* limit = joint.element->FirstChildElement("limit");
  const Place place = place_of(context, joint, limit);
  const std::string_view type = joint.attribute("type");
  if (type == "continuous") {
    context.add(CheckCode::limits_missing, Grade::note, place, text(msg::check_limits_continuous));
  } else if (number_of(limit, "lower") == number_of(limit, "upper")) {
    context.add(CheckCode::limits_empty, Grade::error, place,
                text(msg::check_limits_empty, number_of(limit, "lower")));
  }
  if (!(number_of(limit, "velocity") > 0)) {
    context.add(CheckCode::velocity_limit_missing, Grade::warning, place,
                text(msg::check_velocity_missing));
  }
  if (!(number_of(limit, "effort") > 0)) {
    context.add(CheckCode::effort_limit_missing, Grade::warning, place,
                text(msg::check_effort_missing));
  }
}

}  // namespace

void check_urdf_joints(const CheckContext& context) {
  for (const SourceNode& node : context.description.nodes()) {
    if (node.kind() != "joint" || node.section != "joint" || !node.around.empty()) continue;
    const std::string_view type = node.attribute("type");
    if (type != "revolute" && type != "continuous" && type != "prismatic") continue;
    check_limit(context, node);
    const XMLElement* axis = node.element->FirstChildElement("axis");
    const char* words = axis != nullptr ? axis->Attribute("xyz") : nullptr;
    const std::vector<double> xyz = numbers_in(words != nullptr ? words : "");
    if (xyz.size() != 3) {
      context.add(CheckCode::axis_missing, Grade::warning, place_of(context, node, axis),
                  text(msg::check_axis_missing));
    } else if (const double length = Eigen::Vector3d(xyz.data()).norm();
               std::abs(length - 1) > 0.01) {
      context.add(CheckCode::axis_not_unit, Grade::warning, place_of(context, node, axis),
                  text(msg::check_axis_not_unit, length));
    }
    if (const XMLElement* mimic = node.element->FirstChildElement("mimic")) {
      const char* leader = mimic->Attribute("joint");
      context.add(CheckCode::mimic, Grade::note, place_of(context, node, mimic),
                  text(msg::check_mimic, leader != nullptr ? leader : ""));
    }
  }
}

}  // namespace mjarm
