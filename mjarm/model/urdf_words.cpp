#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/messages/guard.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/model/urdf_internal.hpp"

namespace mjarm {
namespace fs = std::filesystem;
using tinyxml2::XMLElement;
namespace {

/// What the URDF specification knows inside of one kind of element (parted by blanks).
struct Words {
  std::string_view element;
  std::string_view children;
  std::string_view attributes;
};
constexpr std::array<Words, 26> kUrdf = {
    {{"robot", "link joint material transmission gazebo mujoco", "name version"},
     {"link", "inertial visual collision", "name"},
     {"inertial", "origin mass inertia", ""},
     {"origin", "", "xyz rpy"},
     {"mass", "", "value"},
     {"inertia", "", "ixx ixy ixz iyy iyz izz"},
     {"visual", "origin geometry material", "name"},
     {"collision", "origin geometry", "name"},
     {"geometry", "box cylinder sphere capsule mesh", ""},
     {"box", "", "size"},
     {"cylinder", "", "radius length"},
     {"sphere", "", "radius"},
     {"capsule", "", "radius length"},
     {"mesh", "", "filename scale"},
     {"material", "color texture", "name"},
     {"color", "", "rgba"},
     {"texture", "", "filename"},
     {"joint", "origin parent child axis limit dynamics mimic calibration safety_controller",
      "name type"},
     {"parent", "", "link"},
     {"child", "", "link"},
     {"axis", "", "xyz"},
     {"limit", "", "lower upper velocity effort"},
     {"dynamics", "", "damping friction"},
     {"mimic", "", "joint multiplier offset"},
     {"calibration", "", "rising falling reference_position"},
     {"safety_controller", "", "soft_lower_limit soft_upper_limit k_position k_velocity"}}};

std::vector<std::string> split(std::string_view words) {
  std::vector<std::string> list;
  while (!words.empty()) {
    const std::size_t end = std::min(words.find(' '), words.size());
    list.emplace_back(words.substr(0, end));
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return list;
}

/// True for words of other vocabularies: `xmlns:xacro`, `drake:joint`.
bool has_namespace(std::string_view word) { return word.find(':') != std::string_view::npos; }

/// ` (did you mean ...?)` where `word` is a slip of the pen for one of `known`; empty where it is
/// one of them, or a word of somebody's extension, which no reader of URDF minds.
std::string slip(std::string_view word, const std::vector<std::string>& known) {
  const bool is_known = std::find(known.begin(), known.end(), word) != known.end();
  return is_known || has_namespace(word) ? "" : did_you_mean(word, known);
}

Result<void> check_shape(const fs::path& file, const XMLElement& geometry) {
  for (const std::string& shape : split(kUrdf[8].children)) {
    if (geometry.FirstChildElement(shape.c_str()) != nullptr) return {};
  }
  return fail(urdf_error(file, geometry, text(msg::guard_no_shape)));
}

Result<void> check_element(const fs::path& file, const XMLElement& element, const Words& words) {
  const std::vector<std::string> attributes = split(words.attributes);
  for (const auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    if (const std::string hint = slip(a->Name(), attributes); !hint.empty()) {
      return fail(urdf_error(file, element, text(msg::guard_unknown_attribute, a->Name(), hint)));
    }
  }
  const std::vector<std::string> known = split(words.children);
  for (const XMLElement* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::string_view name = e->Name();
    if (name.starts_with("xacro:")) {
      return fail(urdf_error(file, *e, text(msg::guard_xacro, file.filename().string())));
    }
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      const std::string hint = slip(name, known);
      if (hint.empty()) continue;
      return fail(urdf_error(file, *e, text(msg::guard_unknown_child, name, hint)));
    }
    const auto inner =
        std::find_if(kUrdf.begin(), kUrdf.end(), [&](const Words& w) { return w.element == name; });
    if (inner == kUrdf.end()) continue;
    if (auto done = check_element(file, *e, *inner); !done) return done;
  }
  return words.element == "geometry" ? check_shape(file, element) : Result<void>();
}

}  // namespace

Result<void> validate_urdf_words(const fs::path& file, const XMLElement& robot) {
  return check_element(file, robot, kUrdf.front());
}

}  // namespace mjarm
