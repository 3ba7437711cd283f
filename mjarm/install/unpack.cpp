#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/install.hpp"
#include "mjarm/core/sha256.hpp"
#include "mjarm/install/inflate_internal.hpp"
#include "mjarm/install/unpack_internal.hpp"

namespace mjarm::install {
namespace {

namespace fs = std::filesystem;

Error damaged(const fs::path& source, const std::string& mesh) {
  return {Errc::not_available, text(msg::install_damaged, source.filename().string(), mesh)};
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
        inflated(std::string_view(*bytes).substr(at, mesh.packed), Packing::deflate, mesh.size);
    const bool right = content.size() == mesh.size && sha256(content) == mesh.sha256;
    if (!right) return fail(damaged(part, mesh.name));
    if (auto done = sink(mesh, content); !done) return done;
  }
  return {};
}

}  // namespace mjarm::install
