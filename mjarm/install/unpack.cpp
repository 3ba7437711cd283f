#include <zlib.h>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/install.hpp"
#include "mjarm/core/sha256.hpp"
#include "mjarm/install/unpack_internal.hpp"

namespace mjarm::install {
namespace {

namespace fs = std::filesystem;

Error damaged(const fs::path& source, const std::string& mesh) {
  return {Errc::not_available, text(msg::install_damaged, source.filename().string(), mesh)};
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

Result<void> unpack(const fs::path& part, std::uint64_t offset, const MeshSet& set,
                    const MeshSink& sink) {
  const Result<std::string> bytes = read_file(part);
  if (!bytes) return fail(bytes.error());
  for (const MeshFile& mesh : set.files) {
    const std::uint64_t at = mesh.offset - offset;
    if (at + mesh.packed > bytes->size()) return fail(damaged(part, mesh.name));
    const std::string content =
        inflated(std::string_view(*bytes).substr(at, mesh.packed), mesh.size);
    if (sha256(content) != mesh.sha256) return fail(damaged(part, mesh.name));
    if (auto done = sink(mesh, content); !done) return done;
  }
  return {};
}

}  // namespace mjarm::install
