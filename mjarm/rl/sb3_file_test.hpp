#pragma once

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/byte_order.hpp"
#include "mjarm/rl/policy_file_test.hpp"
#include "mjarm/rl/sb3_zip.hpp"

/// Writers of zip archives and pickles, for tests that plant faults in them.
namespace mjarm::testing {

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

inline std::string float_bytes(const std::vector<float>& values) {
  std::string out;
  for (const float value : values) append_little(out, value);
  return out;
}

/// The smallest policy: two observations, one action, one hidden layer of three.
inline std::vector<PlantedTensor> small_state() {
  const auto matrix = [](const std::string& name, int rows, int cols) {
    return PlantedTensor{.name = name + ".weight",
                         .shape = {rows, cols},
                         .strides = {cols, 1},
                         .count = rows * cols,
                         .storage = name + "w"};
  };
  const auto vector = [](const std::string& name, int size, const std::string& storage) {
    return PlantedTensor{.name = name, .shape = {size}, .count = size, .storage = storage};
  };
  return {vector("log_std", 1, "ls"),
          matrix("mlp_extractor.policy_net.0", 3, 2),
          vector("mlp_extractor.policy_net.0.bias", 3, "pb"),
          matrix("mlp_extractor.value_net.0", 3, 2),
          vector("mlp_extractor.value_net.0.bias", 3, "vb"),
          matrix("action_net", 1, 3),
          vector("action_net.bias", 1, "ab"),
          matrix("value_net", 1, 3),
          vector("value_net.bias", 1, "b")};
}

inline std::vector<ZipEntry> torch_entries(const std::vector<PlantedTensor>& state) {
  std::vector<ZipEntry> entries = {{.name = "archive/data.pkl", .content = pickled_state(state)},
                                   {.name = "archive/byteorder", .content = "little"}};
  for (const PlantedTensor& tensor : state) {
    std::vector<float> values(static_cast<std::size_t>(std::max(tensor.count, 0)));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = 0.25f * static_cast<float>(i + 1);
    entries.push_back({.name = "archive/data/" + tensor.storage, .content = float_bytes(values)});
  }
  return entries;
}

inline std::string policy_around(const std::vector<ZipEntry>& torch,
                                 const std::string& data = "{}") {
  return zip_of(
      {{.name = "data", .content = data}, {.name = "policy.pth", .content = zip_of(torch)}});
}

inline std::string policy_of(const std::vector<PlantedTensor>& state,
                             const std::string& data = "{}") {
  return policy_around(torch_entries(state), data);
}

/// The smallest policy with one of its tensors changed.
template <class Change>
inline std::string policy_with(std::size_t index, const Change& change) {
  std::vector<PlantedTensor> state = small_state();
  change(state.at(index));
  return policy_of(state);
}

inline void expect_policy_refused(const std::string& bytes, const std::string& phrase) {
  SCOPED_TRACE(phrase);
  expect_refused(rl::parse_sb3_zip(bytes, "f.zip"), "f.zip: ", phrase);
}

}  // namespace mjarm::testing
