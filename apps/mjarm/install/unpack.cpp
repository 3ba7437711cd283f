#include "apps/mjarm/install/unpack.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <zlib.h>

#include <algorithm>
#include <memory>
#include <set>

#include "apps/mjarm/install/sha256.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/install.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;

struct FreeArchive {
  void operator()(archive* handle) const { archive_read_free(handle); }
};
using ArchiveHandle = std::unique_ptr<archive, FreeArchive>;

Error damaged(const fs::path& source, const std::string& mesh) {
  return {Errc::not_available, text(msg::install_damaged, source.filename().string(), mesh)};
}

Result<void> hand_over(const fs::path& source, const MeshFile& mesh, const std::string& content,
                       const MeshSink& sink) {
  if (content.size() != mesh.size || sha256(content) != mesh.sha256) {
    return fail(damaged(source, mesh.name));
  }
  return sink(mesh, content);
}

Error archive_error(const fs::path& source, archive* handle) {
  const char* reason = archive_error_string(handle);
  return {Errc::not_available, text(msg::install_bad_archive, source.filename().string(),
                                    reason == nullptr ? "libarchive" : reason)};
}

bool leaves_its_folder(const fs::path& path) {
  return path.is_absolute() || std::find(path.begin(), path.end(), "..") != path.end();
}

/// The mesh of `set` that an entry of the archive is; null for all others.
const MeshFile* mesh_of(const MeshSet& set, const fs::path& path) {
  if (path.parent_path() != fs::path(set.folder) / "assets") return nullptr;
  const auto found = std::find_if(set.files.begin(), set.files.end(), [&](const MeshFile& mesh) {
    return mesh.name == path.filename();
  });
  return found == set.files.end() ? nullptr : &*found;
}

/// The bytes deflated in `packed`, which must be `size`; empty where they are damaged.
std::string inflated(std::string_view packed, std::uint64_t size) {
  std::string content(size, '\0');
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return {};
  // zlib does not change what it reads.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(content.data());
  stream.avail_out = static_cast<uInt>(content.size());
  const bool whole = inflate(&stream, Z_FINISH) == Z_STREAM_END && stream.avail_out == 0;
  inflateEnd(&stream);
  return whole ? content : std::string();
}

}  // namespace

Result<void> unpack_archive(const fs::path& source, const MeshSet& set, const MeshSink& sink) {
  const ArchiveHandle handle(archive_read_new());
  archive_read_support_filter_xz(handle.get());
  archive_read_support_filter_gzip(handle.get());
  archive_read_support_format_tar(handle.get());
  if (archive_read_open_filename(handle.get(), source.c_str(), 65536) != ARCHIVE_OK) {
    return fail(archive_error(source, handle.get()));
  }
  std::set<std::string> seen;
  archive_entry* entry = nullptr;
  int status = ARCHIVE_OK;
  while ((status = archive_read_next_header(handle.get(), &entry)) == ARCHIVE_OK) {
    const char* name = archive_entry_pathname(entry);
    const fs::path path = name == nullptr ? fs::path() : fs::path(name).lexically_normal();
    if (name == nullptr || leaves_its_folder(name)) {
      return fail(Errc::not_available, text(msg::install_leaves_folder, source.filename().string(),
                                            name == nullptr ? "?" : name));
    }
    const MeshFile* mesh = mesh_of(set, path);
    if (mesh == nullptr || archive_entry_filetype(entry) != AE_IFREG) continue;
    if (archive_entry_size(entry) != static_cast<la_int64_t>(mesh->size)) {
      return fail(damaged(source, mesh->name));
    }
    std::string content(mesh->size, '\0');
    const la_ssize_t count = archive_read_data(handle.get(), content.data(), content.size());
    if (count != static_cast<la_ssize_t>(content.size())) {
      return fail(damaged(source, mesh->name));
    }
    if (auto done = hand_over(source, *mesh, content, sink); !done) return done;
    seen.insert(mesh->name);
  }
  if (status != ARCHIVE_EOF) return fail(archive_error(source, handle.get()));
  for (const MeshFile& mesh : set.files) {
    if (!seen.contains(mesh.name)) return fail(damaged(source, mesh.name));
  }
  return {};
}

Result<void> unpack_wheel_part(const fs::path& part, std::uint64_t offset, const MeshSet& set,
                               const MeshSink& sink) {
  const Result<std::string> bytes = read_file(part);
  if (!bytes) return fail(bytes.error());
  for (const MeshFile& mesh : set.files) {
    const std::uint64_t at = mesh.offset - offset;
    if (at + mesh.packed > bytes->size()) return fail(damaged(part, mesh.name));
    const std::string content =
        inflated(std::string_view(*bytes).substr(at, mesh.packed), mesh.size);
    if (auto done = hand_over(part, mesh, content, sink); !done) return done;
  }
  return {};
}

}  // namespace mjarm::app
