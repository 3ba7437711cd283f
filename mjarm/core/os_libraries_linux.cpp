#include <link.h>

#include <string>
#include <system_error>

#include "mjarm/core/os_libraries.hpp"

namespace mjarm {
namespace {

struct Search {
  std::string stem;
  std::string found = {};
};

/// Called for every library of the process; what is not 0 ends the search.
int look_at(dl_phdr_info* library, std::size_t, void* wanted) {
  auto* search = static_cast<Search*>(wanted);
  const std::string name = library->dlpi_name == nullptr ? "" : library->dlpi_name;
  const std::string file = std::filesystem::path(name).filename().string();
  if (!file.starts_with(search->stem)) return 0;
  search->found = name;
  return 1;
}

}  // namespace

std::filesystem::path loaded_library(std::string_view stem) {
  Search search{.stem = "lib" + std::string(stem)};
  ::dl_iterate_phdr(look_at, &search);
  if (search.found.empty()) return {};
  std::error_code error;
  std::filesystem::path path = std::filesystem::weakly_canonical(search.found, error);
  return error ? std::filesystem::path(search.found) : path;
}

}  // namespace mjarm
