#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/byte_order.hpp"

namespace mjarm::testing {

/// One field of a message of protocol buffers, as it stands in the bytes.
struct Field {
  int number = 0;
  int type = 0;                 ///< 0 varint, 1 and 5 fixed, 2 bytes
  std::uint64_t integer = 0;    ///< of a varint
  std::string_view bytes = {};  ///< of the others
};

inline std::uint64_t take_varint(std::string_view& bytes) {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    if (bytes.empty()) throw std::runtime_error("a varint is cut off");
    const auto byte = static_cast<unsigned char>(bytes.front());
    bytes.remove_prefix(1);
    value |= static_cast<std::uint64_t>(byte & 0x7F) << shift;
    if (byte < 0x80) return value;
  }
  throw std::runtime_error("a varint is too long");
}

/// The fields of a message in order. @throws std::runtime_error where it is malformed.
inline std::vector<Field> fields_of(std::string_view bytes) {
  std::vector<Field> fields;
  while (!bytes.empty()) {
    const std::uint64_t key = take_varint(bytes);
    Field field{.number = static_cast<int>(key >> 3), .type = static_cast<int>(key & 7)};
    std::size_t size = 0;
    if (field.type == 0) field.integer = take_varint(bytes);
    if (field.type == 1) size = 8;
    if (field.type == 2) size = take_varint(bytes);
    if (field.type == 5) size = 4;
    if (field.type == 3 || field.type == 4 || field.type > 5 || size > bytes.size()) {
      throw std::runtime_error("a field is damaged");
    }
    field.bytes = bytes.substr(0, size);
    bytes.remove_prefix(size);
    fields.push_back(field);
  }
  return fields;
}

inline std::vector<Field> all_of(std::string_view bytes, int number) {
  std::vector<Field> found;
  for (const Field& field : fields_of(bytes)) {
    if (field.number == number) found.push_back(field);
  }
  return found;
}

/// The only field of that number. @throws std::runtime_error where there is not exactly one.
inline Field only(std::string_view bytes, int number) {
  const std::vector<Field> found = all_of(bytes, number);
  if (found.size() != 1) throw std::runtime_error("not one field " + std::to_string(number));
  return found[0];
}

}  // namespace mjarm::testing
