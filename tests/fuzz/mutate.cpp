// Changes descriptions as XML, so that most of what comes out gets past the parser.
#include <tinyxml2.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

using tinyxml2::XMLElement;
using Random = std::minstd_rand;

constexpr std::array<const char*, 40> kValues = {
    "0",          "1",     "-1",    "2",       "0.5",   "-0.5",     "1e-9",        "1e-300",
    "1e9",        "1e10",  "1e19",  "100",     "1000",  "65536",    "2147483647",  "-2147483648",
    "4294967296", "1 0 0", "0 0 0", "0 0 0 0", "1 1 1", "-1 -1 -1", "1 2 3 4 5 6", "1 0 0 0",
    "true",       "false", "auto",  "world",   "mesh",  "plane",    "hfield",      "sphere",
    "capsule",    "ball",  "free",  "slide",   "hinge", "cube",     "2d",          ""};
constexpr std::array<const char*, 44> kElements = {
    "body",     "geom",        "joint",     "freejoint", "site",     "camera",  "light",
    "inertial", "frame",       "replicate", "attach",    "flexcomp", "plugin",  "asset",
    "mesh",     "hfield",      "texture",   "material",  "skin",     "model",   "actuator",
    "motor",    "position",    "velocity",  "muscle",    "dcmotor",  "general", "sensor",
    "framepos", "rangefinder", "contact",   "pair",      "exclude",  "tendon",  "spatial",
    "fixed",    "equality",    "connect",   "weld",      "keyframe", "key",     "default",
    "option",   "include"};
constexpr std::array<const char*, 48> kAttributes = {
    "name",      "class", "type",   "pos",      "quat",    "euler",     "size",    "mass",
    "density",   "axis",  "range",  "limited",  "damping", "stiffness", "ref",     "springref",
    "fromto",    "mesh",  "file",   "material", "count",   "offset",    "sep",     "nrow",
    "ncol",      "width", "height", "builtin",  "vertex",  "face",      "scale",   "joint",
    "site",      "body1", "body2",  "geom1",    "geom2",   "objtype",   "objname", "gear",
    "ctrlrange", "kp",    "qpos",   "timestep", "dim",     "spacing",   "nsample", "user"};

template <std::size_t N>
const char* one_of(const std::array<const char*, N>& words, Random& random) {
  return words[random() % N];
}

void collect(XMLElement* element, std::vector<XMLElement*>& all) {
  for (; element != nullptr; element = element->NextSiblingElement()) {
    all.push_back(element);
    collect(element->FirstChildElement(), all);
  }
}

const tinyxml2::XMLAttribute* some_attribute(const XMLElement& element, Random& random) {
  std::vector<const tinyxml2::XMLAttribute*> all;
  for (const auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) all.push_back(a);
  return all.empty() ? nullptr : all[random() % all.size()];
}

/// One of its words made another one.
std::string changed(std::string words, Random& random) {
  const std::size_t at = words.empty() ? 0 : random() % words.size();
  const std::size_t end = std::min(words.find(' ', at), words.size());
  return words.replace(at, end - at, one_of(kValues, random));
}

void change(tinyxml2::XMLDocument& document, const std::vector<XMLElement*>& all, Random& random) {
  XMLElement& element = *all[random() % all.size()];
  XMLElement& other = *all[random() % all.size()];
  const auto* attribute = some_attribute(element, random);
  const auto* source = some_attribute(other, random);
  switch (random() % 9) {
    case 0:
      if (attribute == nullptr) break;
      element.SetAttribute(attribute->Name(), changed(attribute->Value(), random).c_str());
      break;
    case 1:
      element.SetAttribute(one_of(kAttributes, random), one_of(kValues, random));
      break;
    case 2:
      if (attribute != nullptr) element.DeleteAttribute(std::string(attribute->Name()).c_str());
      break;
    case 3:
      // A copy, for it may be the attribute itself that is set.
      if (source == nullptr) break;
      element.SetAttribute(std::string(source->Name()).c_str(),
                           std::string(source->Value()).c_str());
      break;
    case 4:
      if (attribute == nullptr || source == nullptr) break;
      element.SetAttribute(attribute->Name(), std::string(source->Value()).c_str());
      break;
    case 5:
      element.InsertEndChild(other.DeepClone(&document));
      break;
    case 6:
      if (&element != document.RootElement()) element.Parent()->DeleteChild(&element);
      break;
    case 7:
      element.InsertNewChildElement(one_of(kElements, random));
      break;
    default:
      element.SetName(one_of(kElements, random));
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  Random random(seed + 1);
  tinyxml2::XMLDocument document;
  const bool as_bytes = size == 0 || data[0] != '<' || random() % 5 == 0;
  if (as_bytes || document.Parse(reinterpret_cast<const char*>(data), size) != 0 ||
      document.RootElement() == nullptr) {
    return LLVMFuzzerMutate(data, size, max_size);
  }
  for (std::size_t times = 1 + random() % 4; times > 0; --times) {
    std::vector<XMLElement*> all;
    collect(document.RootElement(), all);
    change(document, all, random);
  }
  tinyxml2::XMLPrinter printer(nullptr, true);
  document.Print(&printer);
  const auto length = static_cast<std::size_t>(printer.CStrSize() - 1);
  if (length > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::memcpy(data, printer.CStr(), length);
  return length;
}
