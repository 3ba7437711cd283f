#include "mjarm/rl/sb3_zip.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "mjarm/core/byte_order.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/policy_file.hpp"
#include "mjarm/core/stored_zip.hpp"
#include "mjarm/rl/json_internal.hpp"
#include "mjarm/rl/sb3_layers_internal.hpp"
#include "mjarm/rl/torch_pickle_internal.hpp"

namespace mjarm::rl {
namespace {

constexpr std::size_t kLargestZip = std::size_t{256} << 20;
constexpr std::int64_t kMaxNumbers = std::int64_t{1} << 26;

/// The JSON that Python writes, whose NaN, Infinity and -Infinity JSON does not know, with null in
/// their place.
std::string as_plain_json(std::string_view words) {
  std::string out;
  out.reserve(words.size());
  bool in_string = false;
  while (!words.empty()) {
    std::size_t taken = 1;
    if (in_string) {
      if (words.front() == '\\' && words.size() > 1) taken = 2;
      if (words.front() == '"') in_string = false;
    } else {
      in_string = words.front() == '"';
      for (const std::string_view word : {"NaN", "Infinity", "-Infinity"}) {
        if (!words.starts_with(word)) continue;
        out += "null";
        words.remove_prefix(word.size());
        taken = 0;
        break;
      }
    }
    out += words.substr(0, taken);
    words.remove_prefix(taken);
  }
  return out;
}

/// The text `object[key]`; empty where there is none.
std::string text_in(const JsonValue& object, const char* key) {
  const JsonValue* const found = object.find(key);
  return found != nullptr ? found->string() : std::string();
}

/// What stands at `object[key]`; null where there is nothing.
const JsonValue& value_in(const JsonValue& object, const char* key) {
  static const JsonValue kNone;
  const JsonValue* const found = object.find(key);
  return found != nullptr ? *found : kNone;
}

/// True where a class is named, and its last name is not `name`: "<class 'torch.nn.Tanh'>".
bool is_other_class(const std::string& description, const std::string& name) {
  return !description.empty() && description.find("." + name + "'") == std::string::npos;
}

/// The numbers that numpy prints as "[-1.  0.5]"; none where that cannot be read, there are not
/// `count`, or one is not finite.
std::optional<std::vector<float>> printed_numbers(std::string_view words, std::size_t count) {
  if (!words.starts_with('[') || !words.ends_with(']')) return std::nullopt;
  words = words.substr(1, words.size() - 2);
  std::vector<float> numbers;
  constexpr const char* kSpace = " \n\t,";
  for (;;) {
    words.remove_prefix(std::min(words.find_first_not_of(kSpace), words.size()));
    if (words.empty()) break;
    const std::string_view word = words.substr(0, words.find_first_of(kSpace));
    float number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(number)) {
      return std::nullopt;
    }
    numbers.push_back(number);
    words.remove_prefix(word.size());
  }
  return numbers.size() == count ? std::optional(std::move(numbers)) : std::nullopt;
}

/// Reads one file; `source` stands in its messages.
class Sb3Reader {
 public:
  explicit Sb3Reader(const std::string& source) : source_(source) {}

  Result<TensorSet> read(std::string_view bytes);

 private:
  template <class... Args>
  tl::unexpected<Error> bad(Msg message, const Args&... args) const {
    return fail(Errc::bad_input, text(message, source_, args...));
  }
  /// What tells how the layers are used; refuses what we cannot follow.
  Result<void> read_settings(std::string_view words);
  Result<std::map<std::string, Tensor>> state(std::string_view archive);
  Result<Tensor> tensor(const StoredZip& zip, std::string_view folder, const std::string& name,
                        const PickledTensor& pickled);
  void add_action_bounds(TensorSet& set) const;

  const std::string& source_;
  std::string activation_ = "tanh";
  std::string low_, high_;    ///< bounds of the actions, as numpy prints them
  std::int64_t numbers_ = 0;  ///< in all tensors so far
};

Result<void> Sb3Reader::read_settings(std::string_view words) {
  constexpr int kDeepest = 32;
  const Result<JsonObject> settings =
      parse_json_object(as_plain_json(words), kDeepest, source_, "\"data\"");
  if (!settings) return fail(settings.error());
  const auto refuse = [&](const char* what, const std::string& value) {
    return bad(msg::policy_file_sb3_field, what, in_quotes(value));
  };
  const JsonValue& policy = value_in(**settings, "policy_kwargs");
  const std::string activation = text_in(policy, "activation_fn");
  if (!is_other_class(activation, "ReLU") && !activation.empty()) {
    activation_ = "relu";
  } else if (is_other_class(activation, "Tanh")) {
    return refuse("activation_fn", activation);
  }
  const JsonValue* const squash = policy.find("squash_output");
  if (squash != nullptr && !(squash->is_boolean() && !squash->boolean())) {
    return refuse("squash_output", squash->is_boolean() ? "true" : squash->string());
  }
  const std::string features = text_in(policy, "features_extractor_class");
  if (is_other_class(features, "FlattenExtractor")) {
    return refuse("features_extractor_class", features);
  }
  for (const char* space : {"observation_space", "action_space"}) {
    const std::string type = text_in(value_in(**settings, space), ":type:");
    if (is_other_class(type, "Box")) return refuse(space, type);
  }
  low_ = text_in(value_in(**settings, "action_space"), "low");
  high_ = text_in(value_in(**settings, "action_space"), "high");
  return {};
}

Result<Tensor> Sb3Reader::tensor(const StoredZip& zip, std::string_view folder,
                                 const std::string& name, const PickledTensor& pickled) {
  const std::string entry = std::string(folder) + "data/" + pickled.storage;
  const std::int64_t size = pickled.count * static_cast<std::int64_t>(sizeof(float));
  const Result<std::string_view> numbers = zip.read(entry);
  if (!numbers || std::cmp_not_equal(numbers->size(), size)) {
    return bad(msg::policy_file_storage, in_quotes(name), in_quotes(entry), size);
  }
  // Counts and strides are 32-bit numbers, so that nothing here can overflow.
  const std::vector<std::int64_t>& shape = pickled.shape;
  const std::vector<std::int64_t>& strides = pickled.strides;
  bool inside = shape.size() <= 2 && pickled.offset >= 0;
  std::int64_t count = 1, last = pickled.offset;
  for (std::size_t i = 0; inside && i < shape.size(); ++i) {
    inside = shape[i] >= 0 && strides[i] >= 0;
    count *= shape[i];
    last += (shape[i] - 1) * strides[i];
  }
  if (!inside || (count > 0 && last >= pickled.count)) {
    return bad(msg::policy_file_strides, in_quotes(name));
  }
  numbers_ += count;
  if (count > kMaxNumbers || numbers_ > kMaxNumbers) {
    return bad(msg::policy_file_many_numbers, kMaxNumbers);
  }
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(count));
  const std::int64_t rows = shape.size() == 2 ? shape[0] : 1;
  const std::int64_t cols = shape.empty() ? 1 : shape.back();
  const std::int64_t row_stride = shape.size() == 2 ? strides[0] : 0;
  const std::int64_t col_stride = shape.empty() ? 0 : strides.back();
  for (std::int64_t row = 0; count > 0 && row < rows; ++row) {
    for (std::int64_t col = 0; col < cols; ++col) {
      const std::int64_t at = pickled.offset + row * row_stride + col * col_stride;
      values.push_back(load_little<float>(*numbers, static_cast<std::size_t>(at) * sizeof(float)));
    }
  }
  return Tensor{.shape = shape, .values = std::move(values)};
}

Result<std::map<std::string, Tensor>> Sb3Reader::state(std::string_view archive) {
  // Its own checksums need no look: the one of the file round it covers all of it.
  const std::string inner = source_ + ": policy.pth";
  const Result<StoredZip> zip = StoredZip::open(archive, inner);
  if (!zip) return fail(zip.error());
  constexpr std::string_view kPickle = "/data.pkl";
  const std::string_view name = zip->name_ending_in(kPickle);
  const Result<std::string_view> pickle = zip->read(name.empty() ? "data.pkl" : name);
  if (!pickle) return fail(pickle.error());
  const std::string folder(name.substr(0, name.size() - kPickle.size() + 1));
  if (zip->contains(folder + "byteorder")) {
    const Result<std::string_view> order = zip->read(folder + "byteorder");
    if (!order) return fail(order.error());
    if (*order != "little") return bad(msg::policy_file_byte_order);
  }
  const auto pickled = read_torch_pickle(*pickle, inner);
  if (!pickled) return fail(pickled.error());
  std::map<std::string, Tensor> state;
  for (const auto& [key, place] : *pickled) {
    Result<Tensor> found = tensor(*zip, folder, key, place);
    if (!found) return fail(std::move(found.error()));
    state.emplace(key, std::move(*found));
  }
  return state;
}

void Sb3Reader::add_action_bounds(TensorSet& set) const {
  const std::vector<std::int64_t>& shape = set.tensors.at("log_std").shape;
  const auto count = static_cast<std::size_t>(shape.at(0));
  auto low = printed_numbers(low_, count);
  auto high = printed_numbers(high_, count);
  if (!low || !high) return;
  for (std::size_t i = 0; i < count; ++i) {
    if (!((*low)[i] <= (*high)[i])) return;
  }
  set.tensors["action.low"] = {shape, std::move(*low)};
  set.tensors["action.high"] = {shape, std::move(*high)};
}

Result<TensorSet> Sb3Reader::read(std::string_view bytes) {
  const Result<StoredZip> zip = StoredZip::open(bytes, source_);
  if (!zip) return fail(zip.error());
  const Result<std::string_view> settings = zip->read_checked("data");
  if (!settings) return fail(settings.error());
  const Result<std::string_view> weights = zip->read_checked("policy.pth");
  if (!weights) return fail(weights.error());
  if (auto done = read_settings(*settings); !done) return fail(std::move(done.error()));
  const auto tensors = state(*weights);
  if (!tensors) return fail(tensors.error());
  Result<TensorSet> set = policy_of_sb3(*tensors, source_);
  if (!set) return set;
  add_action_bounds(*set);
  set->metadata["activation"] = activation_;
  set->metadata["source"] = "stable-baselines3";
  const Result<std::string_view> version = zip->read_checked("_stable_baselines3_version");
  if (version) {
    const std::string_view digits =
        version->substr(0, version->find_first_not_of("0123456789.abcdefghijklmnopqrstuvwxyz+"));
    constexpr std::size_t kLongestVersion = 32;
    set->metadata["source"] += " " + std::string(digits.substr(0, kLongestVersion));
  }
  return set;
}

}  // namespace

Result<TensorSet> parse_sb3_zip(std::string_view bytes, const std::string& source) {
  return Sb3Reader(source).read(bytes);
}

Result<TensorSet> load_sb3_zip(const std::filesystem::path& path) {
  const Result<std::string> bytes = read_file(path, kLargestZip);
  if (!bytes) return fail(bytes.error());
  return parse_sb3_zip(*bytes, path.string());
}

}  // namespace mjarm::rl
