#include <algorithm>

#include "mjarm/core/messages/guard.hpp"
#include "mjarm/model/preflight_internal.hpp"
#include "mjarm/model/urdf_internal.hpp"

namespace mjarm {
namespace fs = std::filesystem;

bool is_inside(const fs::path& path, std::span<const fs::path> roots) {
  const fs::path whole = fs::absolute(path).lexically_normal();
  return std::any_of(roots.begin(), roots.end(), [&](const fs::path& root) {
    const fs::path base = fs::absolute(root.empty() ? fs::path(".") : root).lexically_normal();
    const fs::path way = whole.lexically_relative(base);
    return !way.empty() && *way.begin() != "..";
  });
}

namespace {

/// The main description and the sub-models it names, each once.
class Preflight {
 public:
  explicit Preflight(const LoadOptions& options) : options_(options) {}

  Result<void> check(const XmlSources& sources) {
    if (sources.fault()) return fail(*sources.fault());
    if (auto done = check_attributes(sources); !done) return done;
    if (auto done = check_amounts(sources); !done) return done;
    if (auto done = check_files(sources, options_); !done) return done;
    const fs::path file = sources.documents().front()->name;
    chain_.push_back(fs::absolute(file).lexically_normal());
    seen_.push_back(chain_.back());
    for (const SourceElement& source : sources.elements()) {
      if (std::string_view(source.element->Name()) != "model") continue;
      if (auto done = sub_model(source, file.parent_path()); !done) return done;
    }
    chain_.pop_back();
    return {};
  }

 private:
  Result<void> sub_model(const SourceElement& source, const fs::path& folder) {
    const char* name = source.element->Attribute("file");
    if (name == nullptr) return {};
    const fs::path path = fs::absolute(folder / name).lexically_normal();
    if (std::find(chain_.begin(), chain_.end(), path) != chain_.end()) {
      return fail(urdf_error(*source.file, *source.element, text(msg::guard_model_cycle, name)));
    }
    std::error_code ignored;
    const bool known = std::find(seen_.begin(), seen_.end(), path) != seen_.end();
    if (known || !fs::exists(path, ignored)) return {};
    if (seen_.size() >= kMaxSubModels) {
      return fail(Errc::bad_input, text(msg::guard_many_files, *source.file, kMaxSubModels));
    }
    return check(XmlSources(folder / name, options_.allow_outside));
  }

  static constexpr std::size_t kMaxSubModels = 50;
  const LoadOptions& options_;
  std::vector<fs::path> chain_;  ///< from the main file to the one that is looked at
  std::vector<fs::path> seen_;
};

}  // namespace

Result<void> preflight(const XmlSources& sources, const LoadOptions& options) {
  return Preflight(options).check(sources);
}

}  // namespace mjarm
