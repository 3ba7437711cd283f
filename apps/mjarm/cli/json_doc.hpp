#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/joint_vec.hpp"

namespace mjarm::app {

/// A JSON value to be written: `JsonDoc{{"name", "ur5e"}, {"range", {0.0, 1.0}}}`. Members keep
/// their order. Stands before nlohmann's own type, which takes seconds to compile in every file
/// that makes, copies or prints one.
class JsonDoc {
 public:
  struct Member;

  JsonDoc();  ///< null
  JsonDoc(std::nullptr_t) : JsonDoc() {}
  JsonDoc(bool value);
  JsonDoc(int value);
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
  std::unique_ptr<nlohmann::ordered_json> value_;  // none once moved from
};

/// One member of an object that is being made.
struct JsonDoc::Member {
  const char* key;
  mutable JsonDoc value;  ///< moved out: a list of initialisers is constant
};

}  // namespace mjarm::app
