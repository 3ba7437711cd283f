#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include "mjarm/core/messages/guard.hpp"
#include "mjarm/core/messages/model.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/model/urdf_internal.hpp"

namespace mjarm {
namespace fs = std::filesystem;
using tinyxml2::XMLElement;

std::vector<XMLElement*> children(XMLElement& parent, const char* name) {
  std::vector<XMLElement*> found;
  for (XMLElement* e = parent.FirstChildElement(name); e; e = e->NextSiblingElement(name)) {
    found.push_back(e);
  }
  return found;
}

std::vector<const XMLElement*> children(const XMLElement& parent, const char* name) {
  std::vector<const XMLElement*> found;
  for (const XMLElement* e = parent.FirstChildElement(name); e; e = e->NextSiblingElement(name)) {
    found.push_back(e);
  }
  return found;
}

std::vector<double> parse_numbers(std::string_view words, std::size_t count) {
  std::vector<double> numbers;
  const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
  const char* at = words.data();
  const char* const end = at + words.size();
  while (true) {
    while (at != end && is_space(*at)) ++at;
    if (at == end) break;
    if (*at == '+') ++at;
    double value = 0;
    const auto [next, failure] = std::from_chars(at, end, value);
    if (failure != std::errc() || !std::isfinite(value)) return {};
    if (next != end && !is_space(*next)) return {};
    numbers.push_back(value);
    at = next;
  }
  if (numbers.size() != count) numbers.clear();
  return numbers;
}

Error urdf_error(const fs::path& file, const XMLElement& element, std::string_view what) {
  const auto brief = [](std::string_view name) {
    constexpr std::size_t kLongest = 80;
    return std::string(name.substr(0, kLongest)) + (name.size() > kLongest ? "..." : "");
  };
  const std::string kind = brief(element.Name());
  std::string label = "<" + kind + ">";
  if (const char* name = element.Attribute("name")) {
    label = "<" + kind + " \"" + brief(name) + "\">";
  } else {
    // An element without a name of its own is told by the link or joint around it.
    for (const tinyxml2::XMLNode* at = element.Parent(); at != nullptr; at = at->Parent()) {
      const XMLElement* around = at->ToElement();
      const char* name_around = around != nullptr ? around->Attribute("name") : nullptr;
      if (name_around == nullptr) continue;
      label = text(msg::model_element_of, kind, brief(name_around));
      break;
    }
  }
  return {Errc::bad_input,
          text(msg::model_element_refused,
               file.string() + ":" + std::to_string(element.GetLineNum()), label, what)};
}

namespace {

/// The faults of one URDF file, found one after another; stops at the first.
class Checker {
 public:
  Checker(const fs::path& file, const XMLElement& robot) : file_(file), robot_(robot) {}

  Result<void> run() {
    if (auto done = validate_urdf_words(file_, robot_); !done) return done;
    if (auto done = links(); !done) return done;
    for (const XMLElement* joint : children(robot_, "joint")) {
      if (auto done = this->joint(*joint); !done) return done;
    }
    return tree();
  }

 private:
  [[nodiscard]] tl::unexpected<Error> fault(const XMLElement& element,
                                            std::string_view what) const {
    return fail(urdf_error(file_, element, what));
  }

  /// A name that every link and joint must have.
  Result<std::string> name_of(const XMLElement& element) const {
    const char* name = element.Attribute("name");
    if (name == nullptr || *name == '\0') {
      return fault(element, text(msg::model_attribute_missing, "name"));
    }
    return std::string(name);
  }

  /// The attribute, if there, must hold `count` finite numbers.
  Result<std::vector<double>> numbers(const XMLElement* element, const char* attribute,
                                      std::size_t count) const {
    const char* words = element != nullptr ? element->Attribute(attribute) : nullptr;
    if (words == nullptr) return std::vector<double>();
    std::vector<double> values = parse_numbers(words, count);
    if (values.empty()) {
      return fault(*element, text(msg::model_bad_numbers, attribute, words, count));
    }
    return values;
  }

  Result<void> origin(const XMLElement& parent) const {
    const XMLElement* origin = parent.FirstChildElement("origin");
    for (const char* attribute : {"xyz", "rpy"}) {
      if (auto values = numbers(origin, attribute, 3); !values) return fail(values.error());
    }
    return {};
  }

  Result<void> links() {
    for (const XMLElement* link : children(robot_, "link")) {
      const Result<std::string> name = name_of(*link);
      if (!name) return fail(name.error());
      if (!links_.emplace(*name, link).second) {
        return fault(*link, text(msg::model_repeated_name, *name));
      }
      link_names_.push_back(*name);
      if (auto done = inertial(*link); !done) return done;
      for (const char* kind : {"visual", "collision"}) {
        for (const XMLElement* shape : children(*link, kind)) {
          if (auto done = origin(*shape); !done) return done;
          if (shape->FirstChildElement("geometry") == nullptr) {
            return fault(*shape, text(msg::model_child_missing, "geometry"));
          }
        }
      }
    }
    if (links_.empty()) return fault(robot_, text(msg::model_child_missing, "link"));
    return {};
  }

  Result<void> inertial(const XMLElement& link) const {
    const XMLElement* inertial = link.FirstChildElement("inertial");
    if (inertial == nullptr) return {};
    if (auto done = origin(*inertial); !done) return done;
    const XMLElement* mass = inertial->FirstChildElement("mass");
    if (mass == nullptr) return fault(*inertial, text(msg::model_child_missing, "mass"));
    const auto kilograms = numbers(mass, "value", 1);
    if (!kilograms) return fail(kilograms.error());
    if (kilograms->empty()) return fault(*mass, text(msg::model_attribute_missing, "value"));
    if (kilograms->front() < 0) return fault(*mass, text(msg::model_negative, "value"));
    const XMLElement* inertia = inertial->FirstChildElement("inertia");
    for (const char* entry : {"ixx", "iyy", "izz", "ixy", "ixz", "iyz"}) {
      if (auto values = numbers(inertia, entry, 1); !values) return fail(values.error());
    }
    return {};
  }

  Result<void> joint(const XMLElement& joint) {
    static const std::vector<std::string> kTypes = {"revolute", "continuous", "prismatic", "fixed",
                                                    "floating", "planar",     "spherical"};
    const Result<std::string> name = name_of(joint);
    if (!name) return fail(name.error());
    if (!joint_names_.insert(*name).second) {
      return fault(joint, text(msg::model_repeated_name, *name));
    }
    const char* type = joint.Attribute("type");
    if (type == nullptr) return fault(joint, text(msg::model_attribute_missing, "type"));
    if (std::find(kTypes.begin(), kTypes.end(), type) == kTypes.end()) {
      return fault(joint, text(msg::model_unknown_joint_type, type, did_you_mean(type, kTypes)));
    }
    if (auto done = origin(joint); !done) return done;
    if (auto done = ends(joint); !done) return done;
    const std::string_view kind = type;
    // Joints without an axis of their own often have one of zeros.
    if (kind == "fixed" || kind == "floating" || kind == "spherical") return {};
    const XMLElement* axis = joint.FirstChildElement("axis");
    const auto direction = numbers(axis, "xyz", 3);
    if (!direction) return fail(direction.error());
    // A fixed joint needs no axis, and exporters write one of zeros.
    const bool turns = std::string_view(type) != "fixed" && std::string_view(type) != "floating";
    if (turns && direction->size() == 3 &&
        std::hypot((*direction)[0], (*direction)[1], (*direction)[2]) < 1e-9) {
      return fault(*axis, text(msg::model_zero_axis));
    }
    return limit(joint, kind);
  }

  /// Parent and child of a joint.
  Result<void> ends(const XMLElement& joint) {
    std::array<std::string, 2> names;
    for (int i = 0; i < 2; ++i) {
      const char* kind = i == 0 ? "parent" : "child";
      const XMLElement* element = joint.FirstChildElement(kind);
      if (element == nullptr) return fault(joint, text(msg::model_child_missing, kind));
      const char* link = element->Attribute("link");
      if (link == nullptr) return fault(*element, text(msg::model_attribute_missing, "link"));
      if (links_.count(link) == 0) {
        return fault(*element,
                     text(msg::model_unknown_link, link, did_you_mean(link, link_names_)));
      }
      names[i] = link;
    }
    if (!parent_of_.emplace(names[1], names[0]).second) {
      return fault(joint, text(msg::model_two_parents, names[1]));
    }
    return {};
  }

  Result<void> limit(const XMLElement& joint, std::string_view type) const {
    const XMLElement* limit = joint.FirstChildElement("limit");
    if (limit == nullptr) {
      if (type != "revolute" && type != "prismatic") return {};
      return fault(joint, text(msg::model_child_missing, "limit"));
    }
    std::array<double, 4> value{};
    const std::array<const char*, 4> names = {"lower", "upper", "velocity", "effort"};
    for (int i = 0; i < 4; ++i) {
      const auto number = numbers(limit, names[i], 1);
      if (!number) return fail(number.error());
      if (!number->empty()) value[i] = number->front();
      if (i >= 2 && value[i] < 0) return fault(*limit, text(msg::model_negative, names[i]));
    }
    if ((type == "revolute" || type == "prismatic") && value[0] > value[1]) {
      return fault(*limit, text(msg::model_limits_crossed, value[0], value[1]));
    }
    return {};
  }

  /// One root, and every link hangs on it.
  Result<void> tree() const {
    if (joint_names_.empty() && links_.size() == 1) {
      return fault(robot_, text(msg::guard_no_joints));
    }
    std::vector<std::string> roots;
    for (const std::string& name : link_names_) {
      if (parent_of_.count(name) == 0) roots.push_back(name);
    }
    if (roots.empty()) return fault(robot_, text(msg::model_link_loop, link_names_.front()));
    if (roots.size() > 1) {
      return fault(*links_.at(roots[1]), text(msg::model_two_roots, roots[0], roots[1]));
    }
    std::map<std::string, std::size_t> depth = {{roots.front(), 0}};
    for (const std::string& name : link_names_) {
      std::vector<std::string> way;
      std::string at = name;
      for (; depth.count(at) == 0; at = parent_of_.at(at)) {
        way.push_back(at);
        if (way.size() > link_names_.size()) {
          return fault(*links_.at(name), text(msg::model_link_loop, name));
        }
      }
      for (std::size_t above = depth.at(at); !way.empty(); way.pop_back()) {
        depth[way.back()] = ++above;
        if (above > kDeepest) return fault(*links_.at(way.back()), text(msg::guard_deep, kDeepest));
      }
    }
    return {};
  }

  static constexpr std::size_t kDeepest = 1000;  ///< joints between a link and the root
  const fs::path& file_;
  const XMLElement& robot_;
  std::map<std::string, const XMLElement*> links_;
  std::vector<std::string> link_names_;
  std::set<std::string> joint_names_;
  std::map<std::string, std::string> parent_of_;  ///< child link -> parent link
};

}  // namespace

Result<void> validate_urdf(const fs::path& file, const XMLElement& robot) {
  return Checker(file, robot).run();
}

}  // namespace mjarm
