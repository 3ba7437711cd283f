#include "mjarm/install/index_settings.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>
#include <string_view>
#include <vector>

#include "mjarm/core/file.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/trim.hpp"

namespace mjarm::install {
namespace {

namespace fs = std::filesystem;
using Values = std::map<std::string, std::string>;

std::string variable(const std::string& name) { return environment(name).value_or(""); }

constexpr std::string_view kBlanks = " \t\r";

/// `Index_URL` and `index-url` are one key.
std::string key_of(std::string_view written) {
  std::string key(trimmed(written, kBlanks));
  std::transform(key.begin(), key.end(), key.begin(), [](char c) {
    if (c == '_') return '-';
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  });
  return key;
}

/// Adds what one configuration file says to all commands, then what it says to `pip install`.
void add_file(const fs::path& file, Values& values) {
  const Result<std::string> content = read_file(file, std::size_t{1} << 20);
  if (!content) return;
  for (const std::string_view wanted : {"[global]", "[install]"}) {
    std::istringstream lines(*content);
    bool inside = false;
    for (std::string line; std::getline(lines, line);) {
      const std::string_view words = trimmed(line, kBlanks);
      if (words.empty() || words.front() == '#' || words.front() == ';') continue;
      if (words.front() == '[') inside = words == wanted;
      const std::size_t equals = words.find_first_of("=:");
      if (inside && equals != std::string_view::npos) {
        values[key_of(words.substr(0, equals))] = trimmed(words.substr(equals + 1), kBlanks);
      }
    }
  }
}

/// Where pip looks, the ones that count more later.
std::vector<fs::path> config_files() {
  const std::string named = variable("PIP_CONFIG_FILE");
  if (named == "/dev/null") return {};  // pip's way to say: none at all
  std::vector<fs::path> files;
  std::istringstream folders(environment("XDG_CONFIG_DIRS").value_or("/etc/xdg"));
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (!folder.empty()) files.push_back(fs::path(folder) / "pip/pip.conf");
  }
  files.emplace_back("/etc/pip.conf");
  const fs::path home = variable("HOME");
  const fs::path config = variable("XDG_CONFIG_HOME");
  if (!home.empty()) files.push_back(home / ".pip/pip.conf");
  if (!config.empty() || !home.empty()) {
    files.push_back((config.empty() ? home / ".config" : config) / "pip/pip.conf");
  }
  if (const fs::path venv = variable("VIRTUAL_ENV"); !venv.empty()) {
    files.push_back(venv / "pip.conf");
  }
  if (!named.empty()) files.emplace_back(named);
  return files;
}

}  // namespace

IndexSettings index_settings() {
  Values values;
  for (const fs::path& file : config_files()) add_file(file, values);
  const auto setting = [&](const std::string& pip_variable, const std::string& key) {
    const std::string value = variable(pip_variable);
    return value.empty() ? values[key] : value;
  };
  IndexSettings settings;
  if (std::string url = setting("PIP_INDEX_URL", "index-url"); !url.empty()) {
    while (url.ends_with('/')) url.pop_back();
    settings.url = std::move(url);
  }
  settings.http.proxy = setting("PIP_PROXY", "proxy");
  settings.http.ca_bundle = setting("PIP_CERT", "cert");
  for (const char* name : {"REQUESTS_CA_BUNDLE", "CURL_CA_BUNDLE", "SSL_CERT_FILE"}) {
    if (settings.http.ca_bundle.empty()) settings.http.ca_bundle = variable(name);
  }
  return settings;
}

}  // namespace mjarm::install
