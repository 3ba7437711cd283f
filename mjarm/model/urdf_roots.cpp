#include <algorithm>
#include <set>

#include "mjarm/core/os.hpp"
#include "mjarm/core/path_list.hpp"
#include "mjarm/model/urdf_internal.hpp"

namespace mjarm {
namespace fs = std::filesystem;
using tinyxml2::XMLElement;
namespace {

/// The folders of a list that is parted by colons.
std::vector<fs::path> folders_in(const std::string& variable) {
  std::vector<fs::path> folders;
  const std::string list = environment(variable).value_or("");
  for (std::size_t begin = 0; begin < list.size();) {
    const std::size_t end = std::min(list.find(kPathListSeparator, begin), list.size());
    if (end > begin) folders.emplace_back(list.substr(begin, end - begin));
    begin = end + 1;
  }
  return folders;
}

void collect_packages(const XMLElement& element, std::set<std::string>& packages) {
  if (const char* name = element.Attribute("filename")) {
    const std::string_view whole = name;
    const std::size_t begin = whole.find("://");
    if (begin != std::string_view::npos) {
      const std::string_view rest = whole.substr(begin + 3);
      packages.emplace(rest.substr(0, std::min(rest.find('/'), rest.size())));
    }
  }
  for (const XMLElement* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
    collect_packages(*e, packages);
  }
}

bool is_package(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / "package.xml", ignored);
}

}  // namespace

std::vector<fs::path> urdf_roots(const fs::path& file, const XMLElement& robot,
                                 const LoadOptions& options) {
  const fs::path folder = fs::absolute(file).parent_path().lexically_normal();
  std::vector<fs::path> roots = options.package_paths;
  roots.push_back(folder);
  // Packages keep descriptions in a folder of this name, beside that of the meshes.
  if (folder.filename() == "urdf" || folder.filename() == "robots") {
    roots.push_back(folder.parent_path());
  }
  for (fs::path& path : folders_in("ROS_PACKAGE_PATH")) roots.push_back(std::move(path));
  for (const fs::path& path : folders_in("AMENT_PREFIX_PATH")) roots.push_back(path / "share");
  std::set<std::string> packages;
  collect_packages(robot, packages);
  // Folders right below the root of the file system are nobody's package.
  for (fs::path up = folder; up.has_relative_path() && up.parent_path().has_relative_path();
       up = up.parent_path()) {
    if (is_package(up) || packages.count(up.filename().string()) > 0) roots.push_back(up);
    for (const std::string& package : packages) {
      if (!package.empty() && package != ".." && is_package(up.parent_path() / package)) {
        roots.push_back(up.parent_path() / package);
      }
    }
  }
  return roots;
}

}  // namespace mjarm
