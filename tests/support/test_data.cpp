#include "tests/support/test_data.hpp"

#include <zlib.h>

#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "tests/support/run_program.hpp"

namespace mjarm::support {

std::optional<std::filesystem::path> test_data_file(const std::string& name) {
  const char* folder = std::getenv("MJARM_TEST_DATA");
  if (folder == nullptr || *folder == '\0') return std::nullopt;
  return std::filesystem::path(folder) / name;
}

std::string read_data(const std::filesystem::path& file) {
  // zlib reads plain files as they are.
  const gzFile input = gzopen(file.string().c_str(), "rb");
  if (input == nullptr) throw std::runtime_error("cannot open " + file.string());
  std::string content;
  char buffer[65536];
  int count = 0;
  while ((count = gzread(input, buffer, sizeof buffer)) > 0) {
    content.append(buffer, static_cast<std::size_t>(count));
  }
  gzclose(input);
  if (count < 0) throw std::runtime_error("cannot unpack " + file.string());
  return content;
}

std::string read_mjcf(const std::filesystem::path& file) {
  const std::string include = "<include file=\"", open = "<mujocoinclude>",
                    close = "</mujocoinclude>";
  std::string text = read_data(file);
  for (std::size_t at = 0; (at = text.find(include, at)) != std::string::npos;) {
    const std::size_t name = at + include.size();
    const std::size_t end = text.find("/>", at) + 2;
    const std::string part =
        read_mjcf(file.parent_path() / text.substr(name, text.find('"', name) - name));
    const std::size_t begin = part.find(open);
    if (begin == std::string::npos) {
      at = end;
      continue;
    }
    text.replace(at, end - at,
                 part.substr(begin + open.size(), part.find(close) - begin - open.size()));
  }
  return text;
}

nlohmann::json load_json(const std::filesystem::path& file) {
  return nlohmann::json::parse(read_data(file));
}

std::vector<nlohmann::json> load_json_lines(const std::filesystem::path& file) {
  std::istringstream input(read_data(file));
  std::vector<nlohmann::json> lines;
  for (std::string line; std::getline(input, line);) {
    if (!line.empty()) lines.push_back(nlohmann::json::parse(line));
  }
  return lines;
}

void unpack(const std::filesystem::path& archive, const std::filesystem::path& folder) {
  const ProgramResult done =
      run_program("/bin/tar", {"xf", archive.string(), "-C", folder.string()});
  if (done.exit_code != 0) throw std::runtime_error(done.err);
}

}  // namespace mjarm::support
