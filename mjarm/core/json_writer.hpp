#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/joint_vec.hpp"

namespace mjarm {

struct Pose;

/// Appends JSON to a text piece by piece, commas by itself: for answers that come by the thousand.
/// `JsonWriter(out).object().member("ok", true).member("q", q).end_object()` appends
/// `{"ok":true,"q":[...]}`. Numbers are as `append_number` writes them. What is opened has to be
/// ended; the text before must end with what a value may follow.
class JsonWriter {
 public:
  explicit JsonWriter(std::string& out) noexcept : out_(out) {}

  JsonWriter& object() { return open('{'); }
  JsonWriter& end_object() { return close('}'); }
  JsonWriter& list() { return open('['); }
  JsonWriter& end_list() { return close(']'); }
  /// The next entry begins on a line of its own.
  JsonWriter& line_break();
  /// The next value is that of member `key`.
  JsonWriter& key(std::string_view key);

  JsonWriter& value(double value);
  JsonWriter& value(std::string_view value);  ///< bytes that are no UTF-8 become U+FFFD
  JsonWriter& value(const char* text) { return value(std::string_view(text)); }
  JsonWriter& value(std::nullptr_t);
  JsonWriter& value(std::span<const double> values);
  JsonWriter& value(std::span<const JointVec> rows);
  JsonWriter& value(std::span<const std::string> words);
  template <std::integral Int>
  JsonWriter& value(Int value) {
    if constexpr (std::same_as<Int, bool>) return literal(value ? "true" : "false");
    return literal(std::to_string(value));
  }
  JsonWriter& value(const std::vector<double>& v) { return value(std::span<const double>(v)); }
  JsonWriter& value(const std::vector<JointVec>& v) { return value(std::span<const JointVec>(v)); }
  JsonWriter& value(const std::vector<std::string>& v) {
    return value(std::span<const std::string>(v));
  }
  /// A vector of Eigen of fixed or bounded size.
  template <class Vector>
    requires requires(const Vector& v) { v.derived().data(); }
  JsonWriter& value(const Vector& v) {
    return value(std::span<const double>(v.data(), static_cast<std::size_t>(v.size())));
  }
  template <class Value>
  JsonWriter& member(std::string_view name, const Value& of_it) {
    return key(name).value(of_it);
  }
  /// Members `"pos":[3]` [m] and `"quat":[4]` (w, x, y, z), as pose_of() reads them.
  JsonWriter& pose_members(const Pose& X);
  /// How long something took, to a tenth of a microsecond.
  JsonWriter& member_us(std::string_view name, double us);

 private:
  JsonWriter& open(char bracket);
  JsonWriter& close(char bracket);
  JsonWriter& literal(std::string_view word);
  /// A comma unless this is the first entry, or the value of a member.
  void separate();

  std::string& out_;
};

/// A JSON value as a tree, for documents: `JsonDoc{{"name", "ur5e"}, {"range", {0.0, 1.0}}}`.
/// Members keep their order.
class JsonDoc {
 public:
  struct Member;

  JsonDoc();  ///< null
  JsonDoc(std::nullptr_t) : JsonDoc() {}
  JsonDoc(bool value);
  JsonDoc(int value);
  JsonDoc(long value);
  JsonDoc(std::size_t value);
  JsonDoc(double value);  ///< infinities and NaN are printed as null
  JsonDoc(const char* value);
  JsonDoc(std::string_view value);
  JsonDoc(const std::string& value);
  /// Lists.
  JsonDoc(std::initializer_list<double> values);
  JsonDoc(const JointVec& values);
  JsonDoc(const std::vector<double>& values);
  JsonDoc(const std::vector<std::vector<double>>& rows);
  JsonDoc(const std::vector<std::string>& values);
  JsonDoc(std::vector<JsonDoc> values);
  /// An object.
  JsonDoc(std::initializer_list<Member> members);

  JsonDoc(const JsonDoc& other);
  JsonDoc(JsonDoc&& other) noexcept;
  JsonDoc& operator=(JsonDoc other) noexcept;
  ~JsonDoc();

  /// Adds a member to an object or to null, or replaces it.
  void set(const char* key, JsonDoc value);
  /// The same with all members of `other`, which is an object or null.
  void set_all(const JsonDoc& other);

  /// The value as a document for people, indented, with a line break at its end. Bytes that are no
  /// UTF-8, as names in files may have them, become U+FFFD.
  [[nodiscard]] std::string document() const;
  /// The same in one line, without a line break.
  [[nodiscard]] std::string line() const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;  // none once moved from
};

/// One member of an object that is being made.
struct JsonDoc::Member {
  const char* key;
  mutable JsonDoc value;  ///< moved out: a list of initialisers is constant
};

/// An object of the members that JsonWriter::pose_members() writes.
[[nodiscard]] JsonDoc pose_json(const Pose& X);

}  // namespace mjarm
