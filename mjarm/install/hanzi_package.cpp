#include "mjarm/install/hanzi_package.hpp"

#include <cmath>
#include <map>
#include <sstream>
#include <string_view>

#include "mjarm/core/file.hpp"
#include "mjarm/core/json.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/install.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/sha256.hpp"
#include "mjarm/core/trim.hpp"
#include "mjarm/install/inflate_internal.hpp"
#include "mjarm/install/npm_archive_internal.hpp"
#include "mjarm/install/stage_internal.hpp"

namespace mjarm::install {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolder = "hanzi";
constexpr const char* kStrokes = "strokes.txt";

/// `medians` of a character as a line of the kept file without the character; empty where it has
/// none.
std::string strokes_of(std::string_view json) {
  const auto object = JsonObject::parse(json);
  const JsonValue* medians = object ? (*object)->find("medians") : nullptr;
  if (medians == nullptr) return {};
  std::string line;
  for (const JsonValue& stroke : *medians) {
    if (!line.empty()) line += ';';
    bool first = true;
    for (const JsonValue& point : stroke) {
      if (point.size() != 2) return {};
      if (!first) line += ' ';
      first = false;
      line += std::to_string(std::lround(point[0].number())) + ',' +
              std::to_string(std::lround(point[1].number()));
    }
  }
  return line;
}

/// What is kept of the package.
struct Kept {
  std::string strokes;
  std::string licence;
};

Result<Kept> kept_of(const fs::path& archive, const HanziPackage& package) {
  const auto damaged = [&] {
    return fail(Errc::not_available, text(msg::install_damaged_file, archive.filename().string()));
  };
  const Result<std::string> packed = read_file(archive);
  if (!packed) return fail(packed.error());
  if (sha256(*packed) != package.sha256) return damaged();
  constexpr std::size_t kMost = std::size_t{1} << 28;
  Kept kept;
  std::map<std::string, std::string, std::less<>> lines;
  for_each_file(inflated(*packed, Packing::gzip, kMost),
                [&](std::string_view name, std::string_view content) {
                  constexpr std::string_view kTop = "package/", kEnd = ".json";
                  if (!name.starts_with(kTop)) return;
                  name.remove_prefix(kTop.size());
                  if (name == package.licence_file) kept.licence = content;
                  if (!name.ends_with(kEnd)) return;
                  name.remove_suffix(kEnd.size());
                  if (std::string line = strokes_of(content); !line.empty()) {
                    lines.emplace(name, std::move(line));
                  }
                });
  for (const auto& [character, line] : lines) kept.strokes += character + " " + line + "\n";
  if (kept.licence.empty() || sha256(kept.strokes) != package.strokes_sha256) return damaged();
  return kept;
}

/// Value of `registry` in a configuration file of npm; empty where it has none.
std::string registry_in(const fs::path& file) {
  const Result<std::string> content = read_file(file, std::size_t{1} << 20);
  if (!content) return {};
  std::istringstream lines(*content);
  std::string found;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos || trimmed(line.substr(0, equals)) != "registry") continue;
    found = trimmed(std::string_view(line).substr(equals + 1));
  }
  return found;
}

}  // namespace

std::string npm_registry() {
  std::string url;
  for (const char* name : {"npm_config_registry", "NPM_CONFIG_REGISTRY"}) {
    if (url.empty()) url = environment(name).value_or("");
  }
  const std::string home = environment("HOME").value_or("");
  const std::string file = environment("NPM_CONFIG_USERCONFIG").value_or(home + "/.npmrc");
  if (url.empty()) url = registry_in(file);
  if (url.empty()) url = "https://registry.npmjs.org";
  while (url.ends_with('/')) url.pop_back();
  return url;
}

fs::path hanzi_folder(const fs::path& data) { return data / kFolder; }

InstallState check_hanzi(const fs::path& data, const HanziPackage& package) {
  using Kind = InstallState::Kind;
  const fs::path folder = hanzi_folder(data);
  std::error_code ignored;
  if (!fs::exists(folder, ignored)) return {};
  for (const fs::path& file : {folder / kStrokes, folder / package.licence_file}) {
    if (!fs::is_regular_file(file, ignored)) {
      return {Kind::damaged, text(msg::core_no_such_file, file.string())};
    }
  }
  const Result<std::string> hash = sha256_of_file(folder / kStrokes);
  if (!hash) return {Kind::damaged, hash.error().what};
  if (*hash == package.strokes_sha256) return {Kind::whole, ""};
  return {Kind::damaged, text(msg::install_changed, (folder / kStrokes).string())};
}

Result<void> install_hanzi(const fs::path& data, const HttpOptions& http, const std::string& from,
                           const HanziPackage& package) {
  const Stage at(data, kFolder, package.file);
  const std::string url = from.empty()
                              ? npm_registry() + "/" + package.project + "/-/" + package.file
                              : from + "/" + package.file;
  const auto unpack = [&]() -> Result<void> {
    const Result<Kept> kept = kept_of(at.part, package);
    if (!kept) return fail(kept.error());
    if (interrupted()) return fail(Errc::impossible, text(msg::install_interrupted));
    return write_file(at.stage / package.licence_file, kept->licence).and_then([&] {
      return write_file(at.stage / kStrokes, kept->strokes);
    });
  };
  Result<void> done =
      at.begin()
          .and_then([&] { return at.fetch({url, {0, package.size}, kFolder}, http, unpack); })
          .and_then([&] { return at.publish(hanzi_folder(data)); });
  if (!done) at.tidy();
  return done;
}

Result<bool> remove_hanzi(const fs::path& data) {
  return remove_installed(data, hanzi_folder(data), kFolder);
}

}  // namespace mjarm::install
