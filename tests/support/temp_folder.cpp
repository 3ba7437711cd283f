#include "tests/support/temp_folder.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>

namespace mjarm::support {

#if defined(_WIN32)
TempFolder::TempFolder() {
  std::random_device random;
  do {
    const std::string name = "mjarm-test-" + std::to_string(random());
    path_ = std::filesystem::temp_directory_path() / name;
  } while (!std::filesystem::create_directory(path_));
}
#else
TempFolder::TempFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "mjarm-test-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot make " + pattern);
  path_ = pattern;
}
#endif

TempFolder::~TempFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TempFolder::write(const std::string& name, std::string_view content) const {
  const std::filesystem::path file = path_ / name;
  std::filesystem::create_directories(file.parent_path());
  std::ofstream output(file, std::ios::binary);
  output << content;
  output.close();
  if (!output) throw std::runtime_error("cannot write " + file.string());
  return file;
}

std::string TempFolder::read(const std::string& name) const {
  std::ifstream input(path_ / name, std::ios::binary);
  if (!input) throw std::runtime_error("cannot read " + (path_ / name).string());
  return {std::istreambuf_iterator<char>(input), std::istreambuf_iterator<char>()};
}

bool TempFolder::exists(const std::string& name) const {
  return std::filesystem::exists(path_ / name);
}

}  // namespace mjarm::support
