#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <string_view>

#include "mjarm/core/messages/guard.hpp"
#include "mjarm/model/numbers_internal.hpp"
#include "mjarm/model/preflight_internal.hpp"
#include "mjarm/model/urdf_internal.hpp"

namespace mjarm {
namespace {

using tinyxml2::XMLElement;

constexpr double kMaxElements = 200'000;  ///< that <replicate> may make
constexpr double kLongestStep = 10;       ///< [s]
constexpr double kMaxTexels = 1 << 26;    ///< of all textures
constexpr double kMaxHeights = 1 << 25;   ///< of one height field
constexpr double kMaxNodes = 1'000'000;   ///< of one flexible body

/// Attributes that alone decide how much memory or time something takes, wherever they stand.
struct Amount {
  std::string_view element;  ///< empty = any
  std::string_view attribute;
  double max;
};
constexpr std::array<Amount, 20> kAmounts = {
    {{"size", "nkey", 1e4},          {"size", "nuserdata", 1e6},
     {"size", "njmax", 1e7},         {"size", "nconmax", 1e7},
     {"size", "nstack", 1e8},        {"size", "nuser_body", 1e4},
     {"size", "nuser_jnt", 1e4},     {"size", "nuser_geom", 1e4},
     {"size", "nuser_site", 1e4},    {"size", "nuser_cam", 1e4},
     {"size", "nuser_tendon", 1e4},  {"size", "nuser_actuator", 1e4},
     {"size", "nuser_sensor", 1e4},  {"numeric", "size", 1e6},
     {"user", "dim", 1e6},           {"global", "offwidth", 32768},
     {"global", "offheight", 32768}, {"quality", "shadowsize", 32768},
     {"", "nsample", 1e5},           {"", "maxhullvert", 1e6}}};
constexpr std::array<std::string_view, 4> kQuality = {"numslices", "numstacks", "numquads",
                                                      "offsamples"};

/// Product of the numbers in an attribute; 1 where it is missing or no numbers.
double product_of(const XMLElement& element, const char* attribute) {
  const char* words = element.Attribute(attribute);
  if (words == nullptr) return 1;
  double product = 1;
  for (const double number : numbers_in(words)) product *= std::abs(number);
  return product;
}

double texels_of(const XMLElement& element) {
  if (std::string_view(element.Name()) != "texture" || element.Attribute("width") == nullptr)
    return 0;
  return product_of(element, "width") * product_of(element, "height");
}

std::string too_big(std::string_view what, double amount, double max) {
  return text(msg::guard_too_big, what, amount, max);
}

std::optional<std::string> amount_fault(const XMLElement& element) {
  const std::string_view kind = element.Name();
  for (const Amount& amount : kAmounts) {
    if (!amount.element.empty() && amount.element != kind) continue;
    const double value = product_of(element, amount.attribute.data());
    if (value > amount.max) return too_big(amount.attribute, value, amount.max);
  }
  if (kind == "quality") {
    for (const std::string_view name : kQuality) {
      const double value = product_of(element, name.data());
      if (value > 1000) return too_big(name, value, 1000);
    }
  }
  if (kind == "hfield") {
    const double cells = product_of(element, "nrow") * product_of(element, "ncol");
    if (cells > kMaxHeights) return too_big("nrow x ncol", cells, kMaxHeights);
  }
  if (kind == "flexcomp") {
    const double nodes = product_of(element, "count");
    if (nodes > kMaxNodes) return too_big("count", nodes, kMaxNodes);
  }
  return std::nullopt;
}

std::optional<std::string> timestep_fault(const XMLElement& element) {
  if (std::string_view(element.Name()) != "option") return std::nullopt;
  const char* words = element.Attribute("timestep");
  const std::vector<double> step = words != nullptr ? numbers_in(words) : std::vector<double>();
  if (step.size() != 1 || (step[0] > 0 && step[0] <= kLongestStep)) return std::nullopt;
  return text(msg::guard_timestep, step[0], kLongestStep);
}

/// Counts what <replicate> makes; an <include> stands for what it brings in.
class Replicas {
 public:
  explicit Replicas(const XmlSources& sources) : sources_(sources) {
    for (const auto& document : sources.documents()) {
      if (document->included_at != nullptr) {
        included_[document->included_at] = document->xml.RootElement();
      }
    }
  }

  Result<void> check() { return visit(*sources_.documents().front()->xml.RootElement(), 1); }

 private:
  Result<void> visit(const XMLElement& element, double times) {
    const bool is_replicate = std::string_view(element.Name()) == "replicate";
    if (is_replicate) {
      times *= std::max(1.0, product_of(element, "count"));
      if (outermost_ == nullptr) outermost_ = &element;
    }
    made_ += outermost_ != nullptr ? times : 0;
    if (made_ > kMaxElements) {
      return fail(urdf_error(file_of(*outermost_), *outermost_,
                             text(msg::guard_explodes, made_, kMaxElements)));
    }
    const auto included = included_.find(&element);
    const XMLElement& parent = included != included_.end() ? *included->second : element;
    for (const XMLElement* e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (auto done = visit(*e, times); !done) return done;
    }
    if (is_replicate && outermost_ == &element) outermost_ = nullptr;
    return {};
  }

  [[nodiscard]] const std::string& file_of(const XMLElement& element) const {
    const auto& all = sources_.documents();
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& document) {
      return &document->xml == element.GetDocument();
    });
    return (*found)->name;
  }

  const XmlSources& sources_;
  std::map<const XMLElement*, const XMLElement*> included_;  ///< <include> -> root of its file
  const XMLElement* outermost_ = nullptr;                    ///< the <replicate> around all others
  double made_ = 0;
};

}  // namespace

Result<void> check_amounts(const XmlSources& sources) {
  double texels = 0;
  for (const SourceElement& source : sources.elements()) {
    texels += texels_of(*source.element);
    if (texels > kMaxTexels) {
      return fail(urdf_error(*source.file, *source.element,
                             too_big("width x height of all textures", texels, kMaxTexels)));
    }
    for (const auto& fault : {timestep_fault(*source.element), amount_fault(*source.element)}) {
      if (fault) return fail(urdf_error(*source.file, *source.element, *fault));
    }
  }
  return Replicas(sources).check();
}

}  // namespace mjarm
