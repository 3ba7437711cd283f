#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "mjarm/core/messages/guard.hpp"
#include "mjarm/core/utf8.hpp"
#include "mjarm/model/preflight_internal.hpp"
#include "mjarm/model/urdf_internal.hpp"

namespace mjarm {
namespace {

constexpr std::size_t kLongestName = 1000;  ///< [bytes]
/// Above this MuJoCo calls a state diverged (mjMAXVAL); lengths, masses and angles stay below.
constexpr double kLargestGeometry = 1e10;
/// Limits that mean "none" are written as 1e10 to 1e20; what is larger overflows when squared
/// twice.
constexpr double kLargest = 1e20;

/// Attributes that hold names, words or paths, where `nan` and `inf` are words as any other.
constexpr std::array<std::string_view, 57> kWords = {
    "actuator", "angle",    "biastype",   "body",          "body1",        "body2",      "bone",
    "builtin",  "camera",   "childclass", "class",         "content_type", "cranksite",  "data",
    "datatype", "dyntype",  "element",    "eulerseq",      "file",         "filename",   "flex",
    "frame",    "gaintype", "geom",       "geom1",         "geom2",        "hfield",     "instance",
    "joint",    "joint1",   "joint2",     "jointinparent", "key",          "link",       "material",
    "mesh",     "model",    "name",       "node",          "objname",      "objtype",    "output",
    "plugin",   "prefix",   "reduce",     "refname",       "refsite",      "reftype",    "role",
    "sep",      "sidesite", "site",       "site1",         "site2",        "slidersite", "tendon",
    "texture"};
static_assert(std::is_sorted(kWords.begin(), kWords.end()));

constexpr std::array<std::string_view, 20> kGeometry = {
    "anchor", "axis", "density", "diaginertia", "euler",  "fromto", "fullinertia",
    "length", "mass", "offset",  "pos",         "quat",   "radius", "rpy",
    "scale",  "size", "spacing", "vertex",      "xyaxes", "xyz"};
static_assert(std::is_sorted(kGeometry.begin(), kGeometry.end()));

template <std::size_t N>
bool is_one_of(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::binary_search(words.begin(), words.end(), word);
}

/// The first number in `words` that nobody can compute with.
std::optional<std::string> number_fault(std::string_view attribute, std::string_view words) {
  const double max = is_one_of(kGeometry, attribute) ? kLargestGeometry : kLargest;
  constexpr std::string_view kSpace = " \t\r\n";
  while (true) {
    words.remove_prefix(std::min(words.find_first_not_of(kSpace), words.size()));
    if (words.empty()) return std::nullopt;
    const std::string_view word = words.substr(0, words.find_first_of(kSpace));
    words.remove_prefix(word.size());
    const std::string_view digits = word.substr(word.front() == '+' ? 1 : 0);
    double value = 0;
    const auto [end, failure] =
        std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (failure == std::errc::invalid_argument || end != digits.data() + digits.size()) continue;
    // Too small for a double is no harm, too large is.
    const bool out_of_range = failure == std::errc::result_out_of_range &&
                              digits.find("e-") == std::string_view::npos &&
                              digits.find("E-") == std::string_view::npos;
    if (failure == std::errc() && !std::isfinite(value)) {
      // A range may be open; where it may not, MuJoCo or the check of the compiled model tells.
      if (std::isinf(value) && attribute.ends_with("range")) continue;
      return text(msg::guard_not_finite, attribute, word);
    }
    if (out_of_range || std::abs(value) > max) {
      return text(msg::guard_absurd, attribute, word.substr(0, 40), max);
    }
  }
}

std::optional<std::string> name_fault(std::string_view attribute, std::string_view words) {
  if (words.size() > kLongestName) {
    return text(msg::guard_long_name, attribute, words.size(), kLongestName);
  }
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (std::any_of(words.begin(), words.end(), is_control)) {
    return text(msg::guard_control_character, attribute);
  }
  return std::nullopt;
}

std::optional<std::string> attribute_fault(const tinyxml2::XMLAttribute& attribute) {
  const std::string_view name = attribute.Name();
  const std::string_view value = attribute.Value();
  if (!is_utf8(name) || !is_utf8(value)) return text(msg::guard_not_utf8, name);
  const bool is_name = name == "name" || name == "class" || name == "model" || name == "prefix" ||
                       name.starts_with("file");
  if (is_name) return name_fault(name, value);
  if (is_one_of(kWords, name)) return std::nullopt;
  return number_fault(name, value);
}

}  // namespace

Result<void> check_attributes(const XmlSources& sources) {
  for (const SourceElement& source : sources.elements()) {
    const tinyxml2::XMLElement& element = *source.element;
    const auto refuse = [&](std::string_view what) {
      return fail(urdf_error(*source.file, element, what));
    };
    if (!is_utf8(element.Name())) return refuse(text(msg::guard_not_utf8, element.Name()));
    for (const auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
      if (std::optional<std::string> fault = attribute_fault(*a)) return refuse(*fault);
    }
  }
  return {};
}

}  // namespace mjarm
