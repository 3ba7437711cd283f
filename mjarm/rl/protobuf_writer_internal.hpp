#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "mjarm/core/byte_order.hpp"

namespace mjarm::rl {

/// One message of protocol buffers, field after field as they are added.
/// https://protobuf.dev/programming-guides/encoding
class ProtobufMessage {
 public:
  ProtobufMessage& integer(int field, std::int64_t value) {
    key(field, kVarint);
    varint(static_cast<std::uint64_t>(value));
    return *this;
  }
  ProtobufMessage& real32(int field, float value) {
    key(field, kFixed32);
    append_little(bytes_, value);
    return *this;
  }
  ProtobufMessage& real64(int field, double value) {
    key(field, kFixed64);
    append_little(bytes_, value);
    return *this;
  }
  /// A text, or any bytes.
  ProtobufMessage& words(int field, std::string_view value) {
    key(field, kLengthDelimited);
    varint(value.size());
    bytes_ += value;
    return *this;
  }
  ProtobufMessage& message(int field, const ProtobufMessage& value) {
    return words(field, value.bytes());
  }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  static constexpr unsigned kVarint = 0, kFixed64 = 1, kLengthDelimited = 2, kFixed32 = 5;

  void key(int field, unsigned type) { varint(static_cast<std::uint64_t>(field) << 3 | type); }
  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes_ += static_cast<char>((value & 0x7F) | 0x80);
    bytes_ += static_cast<char>(value);
  }

  std::string bytes_;
};

}  // namespace mjarm::rl
