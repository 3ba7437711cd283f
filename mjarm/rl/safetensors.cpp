#include "mjarm/rl/safetensors.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "mjarm/core/byte_order.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/policy_file.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/core/utf8.hpp"
#include "mjarm/rl/json_internal.hpp"

namespace mjarm::rl {
namespace {

constexpr std::size_t kLargestTensorFile = std::size_t{1} << 30;
constexpr std::size_t kLargestHeader = std::size_t{4} << 20;
constexpr std::size_t kMaxDimensions = 8;
constexpr std::size_t kLengthBytes = 8;
constexpr const char* kMetadataKey = "__metadata__";

/// The types, in the order of `Tensor::values`.
struct NumberType {
  const char* name;
  std::size_t bytes;
};
constexpr NumberType kNumberTypes[] = {{"F32", 4}, {"F64", 8}, {"I64", 8}};

/// Where a tensor lies, as the header tells it.
struct TensorPlace {
  std::string name;
  std::size_t type = 0;  ///< index in kNumberTypes
  std::vector<std::int64_t> shape;
  std::uint64_t begin = 0;  ///< [bytes] from the end of the header
  std::uint64_t end = 0;
};

/// Product of the numbers of a shape; none where it is negative or overflows.
std::optional<std::uint64_t> shape_product(const std::vector<std::int64_t>& shape) {
  std::uint64_t count = 1;
  for (const std::int64_t size : shape) {
    if (size < 0) return std::nullopt;
    const auto factor = static_cast<std::uint64_t>(size);
    if (factor != 0 && count > std::numeric_limits<std::uint64_t>::max() / factor) {
      return std::nullopt;
    }
    count *= factor;
  }
  return count;
}

/// A list of whole numbers from 0; none for anything else.
std::optional<std::vector<std::int64_t>> whole_numbers(const JsonValue& list) {
  if (!list.is_list()) return std::nullopt;
  std::vector<std::int64_t> numbers;
  for (const JsonValue& entry : list) {
    if (!entry.is_whole()) return std::nullopt;
    const std::uint64_t number = entry.whole();
    if (number > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
      return std::nullopt;
    }
    numbers.push_back(static_cast<std::int64_t>(number));
  }
  return numbers;
}

/// Reads one file; `source` stands in its messages.
class SafetensorsReader {
 public:
  SafetensorsReader(std::string_view bytes, const std::string& source)
      : bytes_(bytes), source_(source) {}

  Result<TensorSet> read();

 private:
  template <class... Args>
  tl::unexpected<Error> bad(Msg message, const Args&... args) const {
    return fail(Errc::bad_input, text(message, source_, args...));
  }
  Result<JsonObject> header();
  Result<void> metadata(const JsonValue& texts);
  Result<TensorPlace> place(const std::string& name, const JsonValue& entry) const;
  Result<void> check_places(std::vector<TensorPlace>& places) const;
  Tensor tensor(const TensorPlace& place) const;

  std::string_view bytes_;  ///< of the file; from `read` on of the numbers
  const std::string& source_;
  TensorSet set_;
};

Result<JsonObject> SafetensorsReader::header() {
  if (bytes_.size() < kLengthBytes) return bad(msg::policy_file_short, bytes_.size());
  const auto length = load_little<std::uint64_t>(bytes_);
  bytes_.remove_prefix(kLengthBytes);
  if (length > bytes_.size()) {
    return bad(msg::policy_file_header_size, std::to_string(length), bytes_.size());
  }
  if (length > kLargestHeader) return bad(msg::policy_file_header_limit, length, kLargestHeader);
  const std::string_view words = bytes_.substr(0, length);
  bytes_.remove_prefix(length);
  constexpr int kDeepest = 3;
  return parse_json_object(words, kDeepest, source_, text(msg::policy_file_header));
}

Result<void> SafetensorsReader::metadata(const JsonValue& texts) {
  if (!texts.is_object()) return bad(msg::policy_file_metadata);
  for (const JsonValue& entry : texts) {
    if (!entry.is_string()) return bad(msg::policy_file_metadata);
    set_.metadata[std::string(entry.key())] = entry.string();
  }
  return {};
}

Result<TensorPlace> SafetensorsReader::place(const std::string& name,
                                             const JsonValue& entry) const {
  const JsonValue* const type_of = entry.find("dtype");
  const JsonValue* const shape_of = entry.find("shape");
  const JsonValue* const offsets_of = entry.find("data_offsets");
  if (entry.size() != 3 || !type_of || !type_of->is_string() || !shape_of || !offsets_of) {
    return bad(msg::policy_file_fields, in_quotes(name));
  }
  TensorPlace place;
  place.name = name;
  const std::string type = type_of->string();
  const NumberType* known = std::find_if(std::begin(kNumberTypes), std::end(kNumberTypes),
                                         [&](const NumberType& one) { return type == one.name; });
  if (known == std::end(kNumberTypes)) {
    return bad(msg::policy_file_dtype, in_quotes(name), in_quotes(type));
  }
  place.type = static_cast<std::size_t>(known - kNumberTypes);
  const auto shape = whole_numbers(*shape_of);
  if (!shape || shape->size() > kMaxDimensions) {
    return bad(msg::policy_file_shape, in_quotes(name), kMaxDimensions);
  }
  place.shape = *shape;
  const auto offsets = whole_numbers(*offsets_of);
  if (!offsets || offsets->size() != 2 || (*offsets)[0] > (*offsets)[1]) {
    return bad(msg::policy_file_offsets, in_quotes(name));
  }
  place.begin = static_cast<std::uint64_t>((*offsets)[0]);
  place.end = static_cast<std::uint64_t>((*offsets)[1]);
  if (place.end > bytes_.size()) {
    return bad(msg::policy_file_range, in_quotes(name), place.end, bytes_.size());
  }
  const auto count = shape_product(place.shape);
  const std::uint64_t size = place.end - place.begin;
  if (!count || size % known->bytes != 0 || *count != size / known->bytes) {
    return bad(msg::policy_file_size, in_quotes(name), size);
  }
  return place;
}

/// The tensors fill the data in some order, each beginning where another ends.
Result<void> SafetensorsReader::check_places(std::vector<TensorPlace>& places) const {
  std::sort(places.begin(), places.end(), [](const TensorPlace& a, const TensorPlace& b) {
    return std::pair(a.begin, a.end) < std::pair(b.begin, b.end);
  });
  std::uint64_t at = 0;
  for (const TensorPlace& place : places) {
    if (place.begin != at) {
      return bad(msg::policy_file_gap, in_quotes(place.name), place.begin, at);
    }
    at = place.end;
  }
  if (at != bytes_.size()) return bad(msg::policy_file_trailing, bytes_.size() - at);
  return {};
}

template <class Number>
std::vector<Number> numbers_in(std::string_view bytes) {
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = load_little<Number>(bytes, i * sizeof(Number));
  }
  return numbers;
}

Tensor SafetensorsReader::tensor(const TensorPlace& place) const {
  const std::string_view bytes = bytes_.substr(place.begin, place.end - place.begin);
  Tensor tensor{.shape = place.shape, .values = {}};
  switch (place.type) {
    case 0:
      tensor.values = numbers_in<float>(bytes);
      break;
    case 1:
      tensor.values = numbers_in<double>(bytes);
      break;
    default:
      tensor.values = numbers_in<std::int64_t>(bytes);
  }
  return tensor;
}

Result<TensorSet> SafetensorsReader::read() {
  const Result<JsonObject> names = header();
  if (!names) return fail(names.error());
  std::vector<TensorPlace> places;
  for (const JsonValue& entry : **names) {
    const std::string name(entry.key());
    if (name == kMetadataKey) {
      if (auto done = metadata(entry); !done) return fail(std::move(done.error()));
      continue;
    }
    Result<TensorPlace> found = place(name, entry);
    if (!found) return fail(std::move(found.error()));
    places.push_back(std::move(*found));
  }
  if (auto done = check_places(places); !done) return fail(std::move(done.error()));
  for (const TensorPlace& one : places) set_.tensors[one.name] = tensor(one);
  return std::move(set_);
}

std::size_t value_count(const Tensor& tensor) {
  return std::visit([](const auto& values) { return values.size(); }, tensor.values);
}

/// Widest numbers first, so that all of them are aligned; then by name, as the library has it.
std::vector<const std::pair<const std::string, Tensor>*> in_file_order(const TensorSet& set) {
  std::vector<const std::pair<const std::string, Tensor>*> order;
  for (const auto& entry : set.tensors) order.push_back(&entry);
  std::stable_sort(order.begin(), order.end(), [](const auto* a, const auto* b) {
    return a->second.values.index() > b->second.values.index();
  });
  return order;
}

void append_metadata(std::string& header, const std::map<std::string, std::string>& texts) {
  append_json_string(header, kMetadataKey);
  char before = ':';
  header += before;
  before = '{';
  for (const auto& [key, value] : texts) {
    header += before;
    append_json_string(header, key);
    header += ':';
    append_json_string(header, value);
    before = ',';
  }
  header += '}';
}

void append_place(std::string& header, const std::string& name, const Tensor& tensor,
                  std::size_t begin, std::size_t end) {
  append_json_string(header, name);
  header += ":{\"dtype\":\"";
  header += kNumberTypes[tensor.values.index()].name;
  header += "\",\"shape\":[";
  for (std::size_t i = 0; i < tensor.shape.size(); ++i) {
    if (i > 0) header += ',';
    header += std::to_string(tensor.shape[i]);
  }
  header += "],\"data_offsets\":[" + std::to_string(begin) + "," + std::to_string(end) + "]}";
}

}  // namespace

Result<std::string> to_safetensors(const TensorSet& set, const std::string& source) {
  std::string header = "{", data;
  if (!set.metadata.empty()) append_metadata(header, set.metadata);
  for (const auto& [key, value] : set.metadata) {
    if (!is_utf8(key) || !is_utf8(value)) {
      return fail(Errc::bad_input, text(msg::policy_file_text, source, in_quotes(key)));
    }
  }
  for (const auto* entry : in_file_order(set)) {
    const auto& [name, tensor] = *entry;
    if (name == kMetadataKey || !is_utf8(name) || tensor.shape.size() > kMaxDimensions ||
        shape_product(tensor.shape) != value_count(tensor)) {
      return fail(Errc::bad_input, text(msg::policy_file_unwritable, source, in_quotes(name)));
    }
    const std::size_t begin = data.size();
    std::visit(
        [&](const auto& values) {
          for (const auto value : values) append_little(data, value);
        },
        tensor.values);
    if (header.size() > 1) header += ',';
    append_place(header, name, tensor, begin, data.size());
  }
  header += '}';
  header.resize((header.size() + kLengthBytes - 1) / kLengthBytes * kLengthBytes, ' ');
  std::string bytes;
  bytes.reserve(kLengthBytes + header.size() + data.size());
  append_little<std::uint64_t>(bytes, header.size());
  bytes += header;
  bytes += data;
  return bytes;
}

Result<void> save_safetensors(const std::filesystem::path& path, const TensorSet& set) {
  const Result<std::string> bytes = to_safetensors(set, path.string());
  if (!bytes) return fail(bytes.error());
  return write_file(path, *bytes);
}

Result<TensorSet> parse_safetensors(std::string_view bytes, const std::string& source) {
  return SafetensorsReader(bytes, source).read();
}

Result<TensorSet> load_safetensors(const std::filesystem::path& path) {
  const Result<std::string> bytes = read_file(path, kLargestTensorFile);
  if (!bytes) return fail(bytes.error());
  return parse_safetensors(*bytes, path.string());
}

}  // namespace mjarm::rl
