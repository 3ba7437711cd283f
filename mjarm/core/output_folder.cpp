#include "mjarm/core/output_folder.hpp"

#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/os.hpp"

namespace mjarm {
namespace fs = std::filesystem;
namespace {

/// Files that were never finished: their processes are no more.
void clear_unfinished(const fs::path& folder) {
  std::error_code code;
  std::vector<fs::path> unfinished;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, code)) {
    const std::optional<long> writer = writer_of_temporary(entry.path());
    if (writer && !is_running(*writer)) unfinished.push_back(entry.path());
  }
  for (const fs::path& file : unfinished) fs::remove(file, code);
}

Error held_by_other(const fs::path& folder) {
  const std::optional<long> process = lock_holder(folder);
  if (!process) return {Errc::impossible, text(msg::core_folder_in_use, folder.string())};
  return {Errc::impossible, text(msg::core_folder_held, folder.string(), *process)};
}

}  // namespace

Result<OutputFolder> OutputFolder::open(const fs::path& folder, const Replace& replace) {
  Result<LongResult> result = LongResult::begin(folder, replace);
  if (!result) return fail(std::move(result.error()));
  if (Result<void> made = make_folder(folder); !made) return fail(std::move(made.error()));
  Result<std::optional<FolderLock>> lock = FolderLock::try_lock(folder);
  if (!lock) return fail(std::move(lock.error()));
  if (!*lock) return fail(held_by_other(folder));
  clear_unfinished(folder);
  return OutputFolder(std::move(**lock), std::move(*result));
}

}  // namespace mjarm
