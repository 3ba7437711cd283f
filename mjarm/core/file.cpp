#include "mjarm/core/file.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <system_error>
#include <utility>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/os_file.hpp"

namespace mjarm {
namespace fs = std::filesystem;
namespace {

Error write_error(const fs::path& path, int code) {
  return {Errc::system, text(msg::core_cannot_write, path.string(), system_message(code))};
}

constexpr std::string_view kTemporary = ".tmp";  // before number of process, "-" and count

/// A name beside `target` that no other process and no other thread of this one uses.
fs::path temporary_name(const fs::path& target) {
  static std::atomic<unsigned> counter{0};
  return target.string() + std::string(kTemporary) + std::to_string(process_id()) + "-" +
         std::to_string(counter++);
}

/// The file that `path` means, through links, also where it does not exist yet.
fs::path target_of(fs::path path) {
  constexpr int kMaxLinks = 40;  // as the system follows
  std::error_code code;
  for (int i = 0; i < kMaxLinks && fs::is_symlink(path, code); ++i) {
    const fs::path to = fs::read_symlink(path, code);
    if (code) break;
    path = path.parent_path() / to;
  }
  const fs::path target = fs::weakly_canonical(path, code);
  return code ? path : target;
}

}  // namespace

Result<std::string> read_file(const fs::path& path, std::size_t max_bytes) {
  std::error_code status_error;
  const fs::file_status status = fs::status(path, status_error);
  if (status.type() == fs::file_type::not_found) {
    return fail(Errc::bad_input, text(msg::core_no_such_file, path.string()));
  }
  if (status.type() == fs::file_type::directory) {
    return fail(Errc::bad_input, text(msg::core_is_a_folder, path.string()));
  }
  std::FILE* file = open_file(path, "rb");
  if (file == nullptr) {
    return fail(Errc::bad_input, text(msg::core_cannot_read, path.string(), system_message(errno)));
  }
  std::string content;
  const std::uintmax_t size = fs::file_size(path, status_error);
  if (!status_error) content.reserve(std::min<std::uintmax_t>(size, max_bytes));
  char buffer[65536];
  std::size_t count = 0;
  while (content.size() <= max_bytes && (count = std::fread(buffer, 1, sizeof buffer, file)) > 0) {
    content.append(buffer, count);
  }
  const bool failed = std::ferror(file) != 0;
  const int code = errno;
  std::fclose(file);
  if (failed) {
    return fail(Errc::system, text(msg::core_cannot_read, path.string(), system_message(code)));
  }
  if (content.size() > max_bytes) {
    return fail(Errc::bad_input, text(msg::core_file_too_large, path.string(), max_bytes));
  }
  return content;
}

Result<void> write_file(const fs::path& path, std::string_view content) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return fail(std::move(file.error()));
  if (Result<void> written = file->write(content); !written) return written;
  return file->commit();
}

std::optional<long> writer_of_temporary(const fs::path& path) {
  const std::string name = path.filename().string();
  const std::size_t mark = name.rfind(kTemporary), dash = name.rfind('-');
  if (mark == std::string::npos || mark == 0 || dash == std::string::npos) return std::nullopt;
  const char* const first = name.data() + mark + kTemporary.size();
  const char *const middle = name.data() + dash, *const end = name.data() + name.size();
  if (first >= middle) return std::nullopt;
  long process = 0;
  unsigned count = 0;
  const auto number = std::from_chars(first, middle, process);
  const auto rest = std::from_chars(middle + 1, end, count);
  const bool whole = number.ec == std::errc() && number.ptr == middle && rest.ec == std::errc() &&
                     rest.ptr == end && process > 0;
  return whole ? std::optional(process) : std::nullopt;
}

Result<AtomicFile> AtomicFile::create(const fs::path& path) {
  AtomicFile file;
  file.path_ = path;
  std::error_code ignored;
  const fs::file_type type = fs::status(path, ignored).type();
  if (type == fs::file_type::directory) {
    return fail(Errc::bad_input, text(msg::core_is_a_folder, path.string()));
  }
  if (type == fs::file_type::regular || type == fs::file_type::not_found) {
    // A link keeps pointing where it does: its target is what gets replaced.
    file.target_ = target_of(path);
    file.temporary_ = temporary_name(file.target_);
    file.file_ = open_file(file.temporary_, "wbx");
  } else {
    file.file_ = open_file(path, "wb");
  }
  if (file.file_ == nullptr) {
    const int code = errno;
    file.temporary_.clear();
    return fail(write_error(path, code));
  }
  return file;
}

Result<void> AtomicFile::write(std::string_view content) {
  if (std::fwrite(content.data(), 1, content.size(), file_) != content.size()) {
    return fail(write_error(path_, errno));
  }
  return {};
}

Result<void> AtomicFile::commit() {
  // Closing is where a full disk shows at the latest.
  const bool flushed = std::fflush(file_) == 0;
  int code = errno;
  const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
  if (flushed && !closed) code = errno;
  if (!flushed || !closed) {
    discard();
    return fail(write_error(path_, code));
  }
  if (temporary_.empty()) return {};
  std::error_code error;
  const fs::file_status old = fs::status(target_, error);
  if (fs::exists(old)) fs::permissions(temporary_, old.permissions(), error);
  fs::rename(temporary_, target_, error);
  if (error) {
    discard();
    return fail(Errc::system, text(msg::core_cannot_write, path_.string(), error.message()));
  }
  temporary_.clear();
  return {};
}

void AtomicFile::discard() noexcept {
  if (file_ != nullptr) std::fclose(std::exchange(file_, nullptr));
  if (temporary_.empty()) return;
  std::error_code ignored;
  fs::remove(temporary_, ignored);
  temporary_.clear();
}

AtomicFile::~AtomicFile() { discard(); }

AtomicFile::AtomicFile(AtomicFile&& other) noexcept { *this = std::move(other); }

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
  if (this == &other) return *this;
  discard();
  path_ = std::move(other.path_);
  target_ = std::move(other.target_);
  temporary_ = std::exchange(other.temporary_, {});
  file_ = std::exchange(other.file_, nullptr);
  return *this;
}

Result<void> make_folder(const fs::path& folder) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (code || !fs::is_directory(folder, code)) {
    return fail(Errc::system, text(msg::core_no_folder, folder.string(), code.message()));
  }
  return {};
}

}  // namespace mjarm
