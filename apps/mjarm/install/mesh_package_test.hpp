#pragma once

#include <archive.h>
#include <archive_entry.h>
#include <zlib.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "apps/mjarm/install/mesh_sets.hpp"
#include "apps/mjarm/install/sha256.hpp"
#include "mjarm/core/rng.hpp"

namespace mjarm::app {

/// A set of small made-up meshes, and the two files it can be had from.
struct MeshPackage {
  MeshSet set;
  std::map<std::string, std::string> contents;  ///< of the meshes by name
  std::string archive;                          ///< bytes of the tar.xz
  std::string wheel;                            ///< bytes of the wheel, as far as it matters
};

inline std::string random_bytes(Rng& rng, std::size_t size, std::uint64_t values) {
  std::string bytes(size, '\0');
  for (char& byte : bytes) byte = static_cast<char>(rng.below(values));
  return bytes;
}

/// A tar.xz with these entries.
inline std::string tar_xz(const std::vector<std::pair<std::string, std::string>>& entries) {
  std::string bytes(std::size_t{8} << 20, '\0');
  std::size_t used = 0;
  archive* writer = archive_write_new();
  archive_write_set_format_pax_restricted(writer);
  archive_write_add_filter_xz(writer);
  archive_write_open_memory(writer, bytes.data(), bytes.size(), &used);
  for (const auto& [name, content] : entries) {
    archive_entry* entry = archive_entry_new();
    archive_entry_set_pathname(entry, name.c_str());
    archive_entry_set_size(entry, static_cast<la_int64_t>(content.size()));
    archive_entry_set_filetype(entry, AE_IFREG);
    archive_entry_set_perm(entry, 0644);
    archive_write_header(writer, entry);
    archive_write_data(writer, content.data(), content.size());
    archive_entry_free(entry);
  }
  archive_write_close(writer);
  archive_write_free(writer);
  bytes.resize(used);
  return bytes;
}

/// `content` as a zip file holds it.
inline std::string deflated(const std::string& content) {
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, content.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

inline void sign_archive(MeshPackage& package) {
  package.set.archive = {"toy-1.tar.xz", package.archive.size(), sha256(package.archive)};
}

inline MeshPackage toy_package() {
  Rng rng(7);
  MeshPackage package;
  MeshSet& set = package.set;
  set.robot = "toy";
  set.folder = "toy_robot";
  set.licence = "MIT";
  set.project = "toy-world";
  std::vector<std::pair<std::string, std::string>> entries = {{"toy_robot/LICENSE", "free"}};
  package.wheel = random_bytes(rng, 5000, 256);
  for (const std::string name : {"a.obj", "b.obj", "c.stl", "d.obj"}) {
    const std::string content = random_bytes(rng, 40000, 50);
    const std::string packed = deflated(content);
    set.files.push_back(
        {name, content.size(), package.wheel.size(), packed.size(), sha256(content)});
    package.wheel += packed + random_bytes(rng, 100, 256);
    package.contents[name] = content;
    entries.emplace_back("toy_robot/assets/" + name, content);
  }
  package.wheel += random_bytes(rng, 5000, 256);
  set.wheel = {"toy_world-1.0-py3-none-any.whl", package.wheel.size(), sha256(package.wheel)};
  package.archive = tar_xz(entries);
  sign_archive(package);
  return package;
}

}  // namespace mjarm::app
