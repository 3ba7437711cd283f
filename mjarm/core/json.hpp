#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm {

/// One value of a JSON text that was read. Lives as long as the `JsonObject` it is part of.
class JsonValue {
 public:
  enum class Kind : std::uint8_t { null, boolean, whole, negative, real, string, list, object };

  [[nodiscard]] Kind kind() const noexcept { return kind_; }
  [[nodiscard]] bool is_null() const noexcept { return kind_ == Kind::null; }
  [[nodiscard]] bool is_boolean() const noexcept { return kind_ == Kind::boolean; }
  /// A number without a point, an exponent and a minus sign, that fits 64 bits.
  [[nodiscard]] bool is_whole() const noexcept { return kind_ == Kind::whole; }
  [[nodiscard]] bool is_number() const noexcept {
    return kind_ >= Kind::whole && kind_ <= Kind::real;
  }
  [[nodiscard]] bool is_string() const noexcept { return kind_ == Kind::string; }
  [[nodiscard]] bool is_list() const noexcept { return kind_ == Kind::list; }
  [[nodiscard]] bool is_object() const noexcept { return kind_ == Kind::object; }

  /// False unless it is `true`.
  [[nodiscard]] bool boolean() const noexcept { return is_boolean() && data_.boolean; }
  /// Finite; 0 unless it is a number.
  [[nodiscard]] double number() const noexcept;
  /// 0 unless `is_whole`.
  [[nodiscard]] std::uint64_t whole() const noexcept { return is_whole() ? data_.whole : 0; }
  /// 0 unless it is a number below 0 without point and exponent.
  [[nodiscard]] std::int64_t negative() const noexcept {
    return kind_ == Kind::negative ? data_.negative : 0;
  }
  /// UTF-8; empty unless it is a string.
  [[nodiscard]] std::string string() const {
    return is_string() ? std::string(data_.chars, size_) : std::string();
  }

  /// Entries of a list in its order, or members of an object in the order of their keys; else none.
  [[nodiscard]] const JsonValue* begin() const noexcept {
    return kind_ >= Kind::list ? data_.first : nullptr;
  }
  [[nodiscard]] const JsonValue* end() const noexcept { return begin() + size(); }
  [[nodiscard]] std::size_t size() const noexcept { return kind_ >= Kind::list ? size_ : 0; }
  [[nodiscard]] bool empty() const noexcept { return size() == 0; }
  /// @param i  < size()
  [[nodiscard]] const JsonValue& operator[](std::size_t i) const noexcept { return begin()[i]; }
  /// Name of a member of an object, else empty.
  [[nodiscard]] std::string_view key() const noexcept { return {key_, key_size_}; }
  /// Member `key` of an object; null where there is none, or this is no object.
  [[nodiscard]] const JsonValue* find(std::string_view key) const noexcept;
  [[nodiscard]] bool contains(std::string_view key) const noexcept { return find(key) != nullptr; }

 private:
  friend class JsonBuilder;
  union Data {
    bool boolean;
    std::uint64_t whole;  // of a list or object that is being built: where its entries begin
    std::int64_t negative;
    double real;
    const char* chars;
    const JsonValue* first;
  };

  const char* key_ = "";
  Data data_{.whole = 0};
  std::uint32_t key_size_ = 0;
  std::uint32_t size_ = 0;  // of a string [bytes], list or object
  Kind kind_ = Kind::null;
};

/// What a text may ask of who reads it.
struct JsonLimits {
  int depth = 32;                             ///< brackets open at once, >= 1
  std::size_t values = std::size_t{1} << 23;  ///< numbers, strings, lists, ... in all
  std::size_t bytes = std::size_t{1} << 28;   ///< at most 2^31
  bool unique_keys = true;  ///< refuse an object that names a key twice; else the last one counts
};

/// Why a text is not taken.
enum class JsonErrc {
  syntax,        ///< no JSON from `byte` on
  number_range,  ///< a number beyond the range of double
  no_object,     ///< JSON, but a list, a number, ...
  too_deep,      ///< beyond `JsonLimits::depth`
  too_many,      ///< beyond `JsonLimits::values`
  too_long,      ///< beyond `JsonLimits::bytes`
  key_twice,     ///< an object names `key` twice
};
/// Why a text could not be read.
struct JsonFailure {
  JsonErrc code;
  std::size_t byte = 0;  ///< where, from 1; 0 where that is not known
  std::string key = {};
};
/// The failure as a sentence, without the place of the text.
[[nodiscard]] std::string describe(const JsonFailure& failure);

/// A JSON text that was read, an object. Owns all its values; moving it keeps them in place.
class JsonObject {
 public:
  /// Never throws; takes time and memory in proportion to the text.
  [[nodiscard]] static Result<JsonObject, JsonFailure> parse(std::string_view text,
                                                             const JsonLimits& limits = {});

  [[nodiscard]] const JsonValue& operator*() const noexcept { return root_; }
  [[nodiscard]] const JsonValue* operator->() const noexcept { return &root_; }

 private:
  friend class JsonBuilder;
  JsonValue root_;
  std::vector<JsonValue> values_;
  std::unique_ptr<char[]> chars_;  // of strings and keys
};

/// As `JsonObject::parse`, its failure in words.
[[nodiscard]] Result<JsonObject> parse_json_object(std::string_view text);

// What requests are made of. Errors name the member, not the text.

/// Whether no key of `object` is but a misspelt one of `known`, such as `maxstep` for `max_step` or
/// `V0` for `v0`; else what it says would be dropped without a word. Other keys may stand beside
/// those that are read: files of cases hold more than one program needs.
/// @return an error with the key and the one that was meant.
[[nodiscard]] Result<void> check_keys(const JsonValue& object,
                                      std::span<const std::string_view> known);

/// Member `key` of `object` as a list of `size` finite numbers.
[[nodiscard]] Result<std::vector<double>> number_list(const JsonValue& object, std::string_view key,
                                                      std::size_t size);
/// The same of a value that has no name of its own; `name` stands for it in the error.
[[nodiscard]] Result<std::vector<double>> numbers_of(const JsonValue& value, std::string_view name,
                                                     std::size_t size);
/// Pose from `"pos":[3]` [m] and `"quat":[4]` (w, x, y, z) of `object`. The quaternion may be off
/// unit length by a few rounded digits; it is normalised.
[[nodiscard]] Result<Pose> pose_of(const JsonValue& object);
/// Rotation of a quaternion (w, x, y, z) as a user writes it; `wxyz` has shape (4,).
[[nodiscard]] Result<Eigen::Matrix3d> rotation_of_quat(std::span<const double> wxyz);

}  // namespace mjarm
