#include <algorithm>
#include <array>
#include <optional>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/model.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/share.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/model/preflight_internal.hpp"

namespace mjarm {
namespace fs = std::filesystem;
namespace {

/// Names that a user may say, and the file under the folder of models.
struct Entry {
  std::string_view name;
  std::string_view file;
};
constexpr std::array<Entry, 5> kShipped = {{
    {"car", "car.xml"},
    {"hello", "hello.xml"},
    {"panda", "franka_emika_panda/scene.xml"},
    {"ur5e", "universal_robots_ur5e/scene.xml"},
    {"ur5e_gripper", "universal_robots_ur5e/scene_gripper.xml"},
}};

/// Folders in which shipped models may lie, in the order of search.
std::vector<fs::path> model_folders() {
  std::vector<fs::path> folders;
  if (const auto named = environment("MJARM_MODELS"); named && !named->empty()) {
    folders.push_back(fs::absolute(*named));
  }
  for (const fs::path& share : share_folders()) folders.push_back(share / "models");
  if (const Result<fs::path> program = executable_path()) {
    folders.push_back(program->parent_path() / "models");
  }
  return folders;
}

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

std::optional<fs::path> find_shipped(std::string_view relative) {
  for (const fs::path& folder : model_folders()) {
    if (is_there(folder / relative)) return folder / relative;
  }
  return std::nullopt;
}

}  // namespace

bool is_shipped(const fs::path& file) {
  std::error_code error;
  const fs::path whole = fs::canonical(file, error);
  if (error) return false;
  const std::vector<fs::path> folders = model_folders();
  return std::any_of(folders.begin(), folders.end(), [&](const fs::path& folder) {
    const fs::path real = fs::canonical(folder, error);
    return !error && is_inside(whole, {real});
  });
}

std::optional<fs::path> find_shipped_include(const fs::path& name) {
  if (name.is_absolute()) return std::nullopt;
  fs::path inside;
  for (const fs::path& part : name.lexically_normal()) {
    if (inside.empty() && part == "..") continue;
    inside /= part;
  }
  std::optional<fs::path> file = inside.empty() ? std::nullopt : find_shipped(inside.string());
  std::error_code ignored;
  if (file && !fs::is_regular_file(*file, ignored)) file.reset();
  return file;
}

std::vector<ShippedModel> shipped_models() {
  std::vector<ShippedModel> models;
  for (const Entry& entry : kShipped) {
    if (auto file = find_shipped(entry.file)) {
      models.push_back({std::string(entry.name), std::move(*file)});
    }
  }
  return models;
}

Result<fs::path> find_model_file(std::string_view name_or_path) {
  std::error_code ignored;
  if (const auto named = environment("MJARM_MODELS");
      named && !named->empty() && !fs::is_directory(*named, ignored)) {
    return fail(Errc::usage, text(msg::model_no_models_folder, *named));
  }
  const auto entry = std::find_if(kShipped.begin(), kShipped.end(),
                                  [&](const Entry& e) { return e.name == name_or_path; });
  if (entry != kShipped.end()) {
    if (auto file = find_shipped(entry->file)) return std::move(*file);
  }
  const fs::path path = fs::path(name_or_path);
  if (!name_or_path.empty() && is_there(path)) return path;
  if (entry != kShipped.end()) {
    std::string places;
    for (const fs::path& folder : model_folders()) {
      places += (places.empty() ? "" : text(msg::core_comma)) + folder.string();
    }
    return fail(Errc::not_available,
                text(msg::model_not_shipped, name_or_path, entry->file, places));
  }
  // A name relative to the folder of models, such as `scenes/studio.xml`.
  if (!name_or_path.empty() && path.is_relative()) {
    if (auto file = find_shipped(name_or_path)) return std::move(*file);
  }
  std::vector<std::string> names;
  for (const Entry& known : kShipped) names.emplace_back(known.name);
  return fail(Errc::bad_input, text(msg::model_unknown, name_or_path,
                                    did_you_mean(name_or_path, names), listed(names)));
}

}  // namespace mjarm
