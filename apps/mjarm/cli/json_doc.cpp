#include "apps/mjarm/cli/json_doc.hpp"

#include <nlohmann/json.hpp>
#include <utility>

namespace mjarm::app {

using nlohmann::ordered_json;

JsonDoc::JsonDoc() : value_(std::make_unique<ordered_json>()) {}
JsonDoc::JsonDoc(bool value) : value_(std::make_unique<ordered_json>(value)) {}
JsonDoc::JsonDoc(int value) : value_(std::make_unique<ordered_json>(value)) {}
JsonDoc::JsonDoc(std::size_t value) : value_(std::make_unique<ordered_json>(value)) {}
JsonDoc::JsonDoc(double value) : value_(std::make_unique<ordered_json>(value)) {}
JsonDoc::JsonDoc(const char* value) : value_(std::make_unique<ordered_json>(value)) {}
JsonDoc::JsonDoc(std::string_view value) : value_(std::make_unique<ordered_json>(value)) {}
JsonDoc::JsonDoc(const std::string& value) : value_(std::make_unique<ordered_json>(value)) {}

JsonDoc::JsonDoc(std::initializer_list<double> values) : JsonDoc(std::vector<double>(values)) {}
JsonDoc::JsonDoc(const JointVec& values)
    : JsonDoc(std::vector<double>(values.begin(), values.end())) {}
JsonDoc::JsonDoc(const std::vector<double>& values)
    : value_(std::make_unique<ordered_json>(values)) {}
JsonDoc::JsonDoc(const std::vector<std::vector<double>>& rows)
    : value_(std::make_unique<ordered_json>(rows)) {}
JsonDoc::JsonDoc(const std::vector<std::string>& values)
    : value_(std::make_unique<ordered_json>(values)) {}

JsonDoc::JsonDoc(std::vector<JsonDoc> values)
    : value_(std::make_unique<ordered_json>(ordered_json::array())) {
  for (JsonDoc& value : values) value_->push_back(std::move(*value.value_));
}

JsonDoc::JsonDoc(std::initializer_list<Member> members)
    : value_(std::make_unique<ordered_json>(ordered_json::object())) {
  for (const Member& member : members) (*value_)[member.key] = std::move(*member.value.value_);
}

JsonDoc::JsonDoc(const JsonDoc& other) : value_(std::make_unique<ordered_json>(*other.value_)) {}
JsonDoc::JsonDoc(JsonDoc&& other) noexcept = default;
JsonDoc& JsonDoc::operator=(JsonDoc other) noexcept {
  value_ = std::move(other.value_);
  return *this;
}
JsonDoc::~JsonDoc() = default;

void JsonDoc::set(const char* key, JsonDoc value) { (*value_)[key] = std::move(*value.value_); }

void JsonDoc::set_all(const JsonDoc& other) {
  for (const auto& item : other.value_->items()) (*value_)[item.key()] = item.value();
}

std::string JsonDoc::document() const {
  return value_->dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

std::string JsonDoc::line() const {
  return value_->dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace mjarm::app
