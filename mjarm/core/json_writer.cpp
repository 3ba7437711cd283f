#include "mjarm/core/json_writer.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "mjarm/core/number.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm {
namespace {

/// DEL and U+0080 to U+009F by their numbers: JSON may hold them as they are, in strings, but
/// terminals obey them.
std::string safe(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  for (std::size_t i = 0; i < json.size(); ++i) {
    const auto next = static_cast<unsigned char>(i + 1 < json.size() ? json[i + 1] : 0);
    const bool c1 = json[i] == '\xC2' && next >= 0x80 && next < 0xA0;
    if (c1 || json[i] == '\x7F') {
      out += fmt::format("\\u{:04x}", c1 ? next : 0x7F);
      i += c1 ? 1 : 0;
    } else {
      out += json[i];
    }
  }
  return out;
}

}  // namespace

void JsonWriter::separate() {
  constexpr std::string_view kNoComma = "{[: ";
  if (!out_.empty() && kNoComma.find(out_.back()) == std::string_view::npos) out_ += ',';
}

JsonWriter& JsonWriter::open(char bracket) {
  separate();
  out_ += bracket;
  return *this;
}

JsonWriter& JsonWriter::close(char bracket) {
  out_ += bracket;
  return *this;
}

JsonWriter& JsonWriter::literal(std::string_view word) {
  separate();
  out_ += word;
  return *this;
}

JsonWriter& JsonWriter::line_break() {
  if (!out_.empty() && out_.back() != '{' && out_.back() != '[') out_ += ",\n ";
  return *this;
}

JsonWriter& JsonWriter::key(std::string_view key) {
  separate();
  append_json_string(out_, key);
  out_ += ':';
  return *this;
}

JsonWriter& JsonWriter::value(double value) {
  separate();
  append_number(out_, value);
  return *this;
}

JsonWriter& JsonWriter::value(std::string_view value) {
  separate();
  append_json_string(out_, value);
  return *this;
}

JsonWriter& JsonWriter::value(std::nullptr_t) { return literal("null"); }

JsonWriter& JsonWriter::value(std::span<const double> values) {
  separate();
  append_numbers(out_, values);
  return *this;
}

JsonWriter& JsonWriter::value(std::span<const JointVec> rows) {
  list();
  for (const JointVec& row : rows) value(row);
  return end_list();
}

JsonWriter& JsonWriter::value(std::span<const std::string> words) {
  list();
  for (const std::string& word : words) value(word);
  return end_list();
}

JsonWriter& JsonWriter::pose_members(const Pose& X) {
  const Quat q = to_quat(X.R);
  return member("pos", X.p).member("quat", Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()));
}

JsonWriter& JsonWriter::member_us(std::string_view name, double us) {
  return member(name, std::round(us * 10) / 10);
}

using nlohmann::ordered_json;

struct JsonDoc::Tree {
  ordered_json json;
};

JsonDoc::JsonDoc() : tree_(new Tree) {}
JsonDoc::JsonDoc(bool value) : tree_(new Tree{value}) {}
JsonDoc::JsonDoc(int value) : tree_(new Tree{value}) {}
JsonDoc::JsonDoc(long value) : tree_(new Tree{value}) {}
JsonDoc::JsonDoc(std::size_t value) : tree_(new Tree{value}) {}
JsonDoc::JsonDoc(double value) : tree_(new Tree{value}) {}
JsonDoc::JsonDoc(const char* value) : tree_(new Tree{value}) {}
JsonDoc::JsonDoc(std::string_view value) : tree_(new Tree{value}) {}
JsonDoc::JsonDoc(const std::string& value) : tree_(new Tree{value}) {}

JsonDoc::JsonDoc(std::initializer_list<double> values) : JsonDoc(std::vector<double>(values)) {}
JsonDoc::JsonDoc(const JointVec& values)
    : JsonDoc(std::vector<double>(values.begin(), values.end())) {}
JsonDoc::JsonDoc(const std::vector<double>& values) : tree_(new Tree{values}) {}
JsonDoc::JsonDoc(const std::vector<std::vector<double>>& rows) : tree_(new Tree{rows}) {}
JsonDoc::JsonDoc(const std::vector<std::string>& values) : tree_(new Tree{values}) {}

JsonDoc::JsonDoc(std::vector<JsonDoc> values) : tree_(new Tree{ordered_json::array()}) {
  for (JsonDoc& value : values) tree_->json.push_back(std::move(value.tree_->json));
}

JsonDoc::JsonDoc(std::initializer_list<Member> members) : tree_(new Tree{ordered_json::object()}) {
  for (const Member& member : members) {
    tree_->json[member.key] = std::move(member.value.tree_->json);
  }
}

JsonDoc::JsonDoc(const JsonDoc& other) : tree_(new Tree(*other.tree_)) {}
JsonDoc::JsonDoc(JsonDoc&& other) noexcept = default;
JsonDoc& JsonDoc::operator=(JsonDoc other) noexcept {
  tree_ = std::move(other.tree_);
  return *this;
}
JsonDoc::~JsonDoc() = default;

void JsonDoc::set(const char* key, JsonDoc value) {
  tree_->json[key] = std::move(value.tree_->json);
}

void JsonDoc::set_all(const JsonDoc& other) {
  for (const auto& item : other.tree_->json.items()) tree_->json[item.key()] = item.value();
}

std::string JsonDoc::document() const {
  return safe(tree_->json.dump(2, ' ', false, ordered_json::error_handler_t::replace)) + '\n';
}

std::string JsonDoc::line() const {
  return safe(tree_->json.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
}

JsonDoc pose_json(const Pose& X) {
  const Quat q = to_quat(X.R);
  return {{"pos", {X.p[0], X.p[1], X.p[2]}}, {"quat", {q.w(), q.x(), q.y(), q.z()}}};
}

}  // namespace mjarm
