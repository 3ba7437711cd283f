#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/rl/byte_order_internal.hpp"

/// Writers of zip archives and pickles, for tests that plant faults in them.
namespace mjarm::rl::testing {

struct ZipEntry {
  std::string name;
  std::string content;
  unsigned method = 0;
  unsigned flags = 0;
  std::int64_t size_off = 0;   ///< added to both sizes in the directory
  std::int64_t local_off = 0;  ///< added to where the directory says the entry lies
  bool wrong_crc = false;
};

inline std::uint32_t crc_of(std::string_view bytes) {
  const auto* first = reinterpret_cast<const Bytef*>(bytes.data());
  return static_cast<std::uint32_t>(crc32(0, first, static_cast<uInt>(bytes.size())));
}

/// The fields that the records of an entry share.
inline void append_shared(std::string& out, const ZipEntry& entry, std::int64_t size_off) {
  const auto size = static_cast<std::int64_t>(entry.content.size()) + size_off;
  append_little<std::uint16_t>(out, 20);
  append_little(out, static_cast<std::uint16_t>(entry.flags));
  append_little(out, static_cast<std::uint16_t>(entry.method));
  append_little<std::uint32_t>(out, 0);
  append_little(out, crc_of(entry.content) ^ (entry.wrong_crc ? 1u : 0u));
  append_little(out, static_cast<std::uint32_t>(size));
  append_little(out, static_cast<std::uint32_t>(size));
  append_little(out, static_cast<std::uint16_t>(entry.name.size()));
  append_little<std::uint16_t>(out, 0);
}

inline std::string zip_of(const std::vector<ZipEntry>& entries) {
  std::string out, directory;
  for (const ZipEntry& entry : entries) {
    directory += "PK\1\2";
    append_little<std::uint16_t>(directory, 20);
    append_shared(directory, entry, entry.size_off);
    directory += std::string(10, '\0');
    append_little(directory, static_cast<std::uint32_t>(static_cast<std::int64_t>(out.size()) +
                                                        entry.local_off));
    directory += entry.name;
    out += "PK\3\4";
    append_shared(out, entry, 0);
    out += entry.name + entry.content;
  }
  const auto count = static_cast<std::uint16_t>(entries.size());
  const auto at = static_cast<std::uint32_t>(out.size());
  out += directory + "PK\5\6" + std::string(4, '\0');
  append_little(out, count);
  append_little(out, count);
  append_little(out, static_cast<std::uint32_t>(directory.size()));
  append_little(out, at);
  append_little<std::uint16_t>(out, 0);
  return out;
}

// Pieces of pickles, named as pickletools names them.
inline std::string unicode(const std::string& words) {
  std::string out = "X";
  append_little(out, static_cast<std::uint32_t>(words.size()));
  return out + words;
}
inline std::string integer(std::int32_t value) {
  std::string out = "J";
  append_little(out, value);
  return out;
}
inline std::string integers(const std::vector<std::int32_t>& values) {
  std::string out = "(";
  for (const std::int32_t value : values) out += integer(value);
  return out + "t";
}
inline std::string global(const std::string& module, const std::string& name) {
  return "c" + module + "\n" + name + "\n";
}

struct PlantedTensor {
  std::string name = "w";
  std::vector<std::int32_t> shape = {2};
  std::vector<std::int32_t> strides = {1};
  std::int32_t offset = 0;
  std::int32_t count = 2;
  std::string storage = "0";
};

inline const std::string kDictGlobal = global("collections", "OrderedDict");
inline const std::string kTensorGlobal = global("torch._utils", "_rebuild_tensor_v2");
inline const std::string kFloatGlobal = global("torch", "FloatStorage");

inline std::string pickled(const PlantedTensor& tensor) {
  return kTensorGlobal + "((" + unicode("storage") + kFloatGlobal + unicode(tensor.storage) +
         unicode("cpu") + integer(tensor.count) + "tQ" + integer(tensor.offset) +
         integers(tensor.shape) + integers(tensor.strides) + "\x89" + kDictGlobal + ")RtR";
}

inline std::string pickled_state(const std::vector<PlantedTensor>& tensors) {
  std::string out = "\x80\x02" + kDictGlobal + ")R(";
  for (const PlantedTensor& tensor : tensors) out += unicode(tensor.name) + pickled(tensor);
  return out + "u.";
}

}  // namespace mjarm::rl::testing
