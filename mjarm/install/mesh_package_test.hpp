#pragma once

#include <zlib.h>

#include <map>
#include <string>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/sha256.hpp"
#include "mjarm/install/mesh_sets.hpp"

namespace mjarm::install {

/// A set of small made-up meshes, and the wheel that carries them.
struct MeshPackage {
  MeshSet set;
  std::map<std::string, std::string> contents;  ///< of the meshes by name
  std::string wheel;                            ///< bytes of the wheel, as far as it matters
};

inline std::string random_bytes(Rng& rng, std::size_t size, std::uint64_t values) {
  std::string bytes(size, '\0');
  for (char& byte : bytes) byte = static_cast<char>(rng.below(values));
  return bytes;
}

/// `content` as a zip file holds it; as gzip makes it with 16 + MAX_WBITS.
inline std::string deflated(const std::string& content, int window = -MAX_WBITS) {
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, window, 8, Z_DEFAULT_STRATEGY);
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

inline MeshPackage toy_package() {
  Rng rng(7);
  MeshPackage package;
  MeshSet& set = package.set;
  set.robot = "toy";
  set.folder = "toy_robot";
  set.licence = "MIT";
  set.project = "toy-world";
  package.wheel = random_bytes(rng, 5000, 256);
  for (const std::string name : {"a.obj", "b.obj", "c.stl", "d.obj"}) {
    const std::string content = random_bytes(rng, 40000, 50);
    const std::string packed = deflated(content);
    set.files.push_back(
        {name, content.size(), package.wheel.size(), packed.size(), sha256(content)});
    package.wheel += packed + random_bytes(rng, 100, 256);
    package.contents[name] = content;
  }
  package.wheel += random_bytes(rng, 5000, 256);
  set.wheel = "toy_world-1.0-py3-none-any.whl";
  set.wheel_sha256 = sha256(package.wheel);
  return package;
}

}  // namespace mjarm::install
