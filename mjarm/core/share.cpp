#include "mjarm/core/share.hpp"

#include <algorithm>
#include <system_error>

#include "mjarm/core/os.hpp"
#include "mjarm/core/os_libraries.hpp"

namespace mjarm {
namespace fs = std::filesystem;

std::vector<fs::path> share_folders() {
  // Looked for once: that takes the program loader's lock, which no thread should hold when another
  // one copies the process (`run_in_child`).
  static const fs::path self = library_of(reinterpret_cast<const void*>(&share_folder));
  static const fs::path mujoco = loaded_library("mujoco");
  std::vector<fs::path> folders;
  const Result<fs::path> program = executable_path();
  if (program) {
    folders.push_back((program->parent_path() / ".." / "share" / "mjarm").lexically_normal());
  }
  if (!self.empty() && self != program.value_or(fs::path())) {
    folders.push_back(self.parent_path() / "share" / "mjarm");
  }
  // What is linked into somebody else's program has no place of its own; MuJoCo is installed
  // beside it.
  if (!mujoco.empty()) {
    folders.push_back((mujoco.parent_path() / MJARM_LIBRARY_TO_SHARE).lexically_normal());
  }
  return folders;
}

Result<fs::path> share_folder() {
  const std::vector<fs::path> folders = share_folders();
  const auto found = std::ranges::find_if(folders, [](const fs::path& folder) {
    std::error_code ignored;
    return fs::is_directory(folder, ignored);
  });
  if (found != folders.end()) return *found;
  const Result<fs::path> program = executable_path();
  if (!program) return fail(program.error());
  return folders.front();
}

}  // namespace mjarm
