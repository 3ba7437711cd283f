#pragma once

#include <Eigen/Core>
#include <array>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "mjarm/core/pose.hpp"

namespace mjarm::detail {

/// The bytes of what a computation is made from, for UserCache. Numbers are taken as they are, to
/// the last bit; lists with their length.
class ByteKey {
 public:
  explicit ByteKey(std::string name) : bytes_(std::move(name)) {}

  template <class... Values>
  void add(const Values&... values) {
    (append(values), ...);
  }
  [[nodiscard]] const std::string& bytes() const noexcept { return bytes_; }

 private:
  template <class Number>
    requires(std::is_arithmetic_v<Number> || std::is_enum_v<Number>)
  void append(Number value) {
    char raw[sizeof(value)];
    std::memcpy(raw, &value, sizeof(value));
    bytes_.append(raw, sizeof(value));
  }
  template <int kRows, int kColumns>
  void append(const Eigen::Matrix<double, kRows, kColumns>& values) {
    static_assert(kRows > 0 && kColumns > 0);
    for (Eigen::Index k = 0; k < values.size(); ++k) append(values.data()[k]);
  }
  void append(const Pose& X) { add(X.p, X.R); }
  template <class Value, std::size_t kCount>
  void append(const std::array<Value, kCount>& values) {
    for (const Value& value : values) append(value);
  }
  template <class Value>
  void append(const std::vector<Value>& values) {
    append(values.size());
    for (const Value& value : values) append(value);
  }

  std::string bytes_;
};

/// Reads numbers from bytes; all that follow one that is not there are zero.
class ByteReader {
 public:
  explicit ByteReader(const std::string& bytes) : bytes_(bytes) {}
  template <class Number>
  void read(Number& value) {
    value = {};
    if (bytes_.size() - at_ < sizeof(value)) {
      fine_ = false;
      return;
    }
    std::memcpy(&value, bytes_.data() + at_, sizeof(value));
    at_ += sizeof(value);
  }
  /// A length, with room for so many values of at least `each` bytes.
  std::size_t read_length(std::size_t each) {
    std::size_t length = 0;
    read(length);
    if (length > (bytes_.size() - at_) / each) fine_ = false;
    return fine_ ? length : 0;
  }
  [[nodiscard]] bool is_done() const { return fine_ && at_ == bytes_.size(); }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
  bool fine_ = true;
};

}  // namespace mjarm::detail
