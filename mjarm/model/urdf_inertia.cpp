#include <mujoco/mujoco.h>

#include <map>

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/model.hpp"
#include "mjarm/model/urdf_internal.hpp"

namespace mjarm {
namespace fs = std::filesystem;
using tinyxml2::XMLElement;
namespace {

/// Mass and inertia of links that must have some to move at all, where the file gives none.
constexpr const char* kTinyMass = "1e-6";
constexpr const char* kTinyInertia = "1e-9";

bool has_inertia(const XMLElement& link) {
  const XMLElement* inertial = link.FirstChildElement("inertial");
  if (inertial == nullptr) return false;
  const XMLElement* mass = inertial->FirstChildElement("mass");
  const XMLElement* inertia = inertial->FirstChildElement("inertia");
  return mass != nullptr && mass->DoubleAttribute("value") > mjMINVAL && inertia != nullptr &&
         inertia->DoubleAttribute("ixx") > mjMINVAL && inertia->DoubleAttribute("iyy") > mjMINVAL &&
         inertia->DoubleAttribute("izz") > mjMINVAL;
}

void set_tiny_inertia(XMLElement& link) {
  XMLElement* inertial = link.FirstChildElement("inertial");
  if (inertial == nullptr) inertial = link.InsertNewChildElement("inertial");
  XMLElement* mass = inertial->FirstChildElement("mass");
  if (mass == nullptr) mass = inertial->InsertNewChildElement("mass");
  if (!(mass->DoubleAttribute("value") > mjMINVAL)) mass->SetAttribute("value", kTinyMass);
  if (XMLElement* old = inertial->FirstChildElement("inertia")) inertial->DeleteChild(old);
  XMLElement* inertia = inertial->InsertNewChildElement("inertia");
  for (const char* entry : {"ixx", "iyy", "izz"}) inertia->SetAttribute(entry, kTinyInertia);
  for (const char* entry : {"ixy", "ixz", "iyz"}) inertia->SetAttribute(entry, "0");
}

}  // namespace

void mend_inertia(const fs::path& file, XMLElement& robot, std::vector<std::string>& warnings) {
  std::string mended;
  for (XMLElement* link : children(robot, "link")) {
    XMLElement* inertial = link->FirstChildElement("inertial");
    XMLElement* given = inertial != nullptr ? inertial->FirstChildElement("inertia") : nullptr;
    if (given == nullptr || !has_inertia(*link)) continue;
    const auto entry = [&](const char* name) { return given->DoubleAttribute(name); };
    Eigen::Matrix3d I;
    I << entry("ixx"), entry("ixy"), entry("ixz"),  //
        entry("ixy"), entry("iyy"), entry("iyz"),   //
        entry("ixz"), entry("iyz"), entry("izz");
    if (symmetric_eigen(I).values[0] > 0) continue;
    for (const char* name : {"ixy", "ixz", "iyz"}) given->SetAttribute(name, "0");
    mended += (mended.empty() ? "" : text(msg::core_comma)) + std::string(link->Attribute("name"));
  }
  if (!mended.empty()) {
    warnings.push_back(text(msg::model_mended_inertia, file.string(), mended));
  }
}

void give_mass(const fs::path& file, XMLElement& robot, std::vector<std::string>& warnings) {
  std::map<std::string, XMLElement*> links;
  for (XMLElement* link : children(robot, "link")) links[link->Attribute("name")] = link;
  std::multimap<std::string, std::string> fixed_to;  // parent link -> child link
  const std::vector<XMLElement*> joints = children(robot, "joint");
  for (const XMLElement* joint : joints) {
    if (joint->Attribute("type", "fixed") == nullptr) continue;
    fixed_to.emplace(joint->FirstChildElement("parent")->Attribute("link"),
                     joint->FirstChildElement("child")->Attribute("link"));
  }
  std::string traces;
  std::string guesses;
  for (const XMLElement* joint : joints) {
    if (joint->Attribute("type", "fixed") != nullptr) continue;
    const std::string moved = joint->FirstChildElement("child")->Attribute("link");
    bool heavy = false;
    std::vector<std::string> rigid = {moved};
    for (std::size_t i = 0; i < rigid.size(); ++i) {
      const XMLElement& link = *links.at(rigid[i]);
      const bool guessed = link.FirstChildElement("inertial") == nullptr &&
                           link.FirstChildElement("collision") != nullptr;
      if (guessed) guesses += (guesses.empty() ? "" : text(msg::core_comma)) + rigid[i];
      heavy = heavy || guessed || has_inertia(link);
      const auto [begin, end] = fixed_to.equal_range(rigid[i]);
      for (auto child = begin; child != end; ++child) rigid.push_back(child->second);
    }
    if (heavy) continue;
    set_tiny_inertia(*links.at(moved));
    traces += (traces.empty() ? "" : text(msg::core_comma)) + moved;
  }
  const std::string name = file.string();
  if (!traces.empty()) warnings.push_back(text(msg::model_no_inertia, name, traces, kTinyMass));
  if (!guesses.empty()) warnings.push_back(text(msg::model_guessed_inertia, name, guesses));
}

}  // namespace mjarm
