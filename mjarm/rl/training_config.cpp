#include "mjarm/rl/training_config.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/rl.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/core/yaml_tree.hpp"
#include "mjarm/rl/option_table_internal.hpp"
#include "mjarm/rl/safetensors.hpp"

namespace mjarm::rl {
namespace {

template <class T>
inline constexpr bool kIsList = false;
template <class T>
inline constexpr bool kIsList<std::vector<T>> = true;

/// The last value of an enumeration.
constexpr ReachRegion last_of(ReachRegion) { return ReachRegion::wide; }
constexpr ReachAction last_of(ReachAction) { return ReachAction::torque; }
constexpr ReachGripper last_of(ReachGripper) { return ReachGripper::as_model; }
constexpr Schedule last_of(Schedule) { return Schedule::linear; }
constexpr Activation last_of(Activation) { return Activation::relu; }

/// Names of an enumeration, in its order.
template <class T>
std::vector<std::string> words() {
  if constexpr (std::is_same_v<T, bool>) {
    return {"false", "true"};
  } else {
    std::vector<std::string> names;
    for (int i = 0; i <= static_cast<int>(last_of(T{})); ++i) {
      names.emplace_back(name(static_cast<T>(i)));
    }
    return names;
  }
}

template <class T>
std::string written(const T& value) {
  if constexpr (kIsList<T>) {
    std::string list;
    for (const auto& item : value) list += (list.empty() ? "" : ", ") + written(item);
    return "[" + list + "]";
  } else if constexpr (std::is_same_v<T, double>) {
    return number(value);
  } else if constexpr (std::is_enum_v<T> || std::is_same_v<T, bool>) {
    return words<T>()[static_cast<std::size_t>(value)];
  } else {
    return std::to_string(value);
  }
}

/// Reads a number; the fault in words, or nothing where it was taken.
template <class T>
std::string take_number(const std::string& key, const YamlNode& node,
                        const detail::OptionRange& range, T& value) {
  T read{};
  const char* end = node.text.data() + node.text.size();
  const auto [stop, code] = std::from_chars(node.text.data(), end, read);
  bool good = node.kind == YamlNode::Kind::scalar && code == std::errc() && stop == end;
  if constexpr (std::is_floating_point_v<T>) good = good && std::isfinite(read);
  if (!good) {
    const Msg expected =
        std::is_integral_v<T> ? msg::rl_config_no_integer : msg::rl_config_no_number;
    return text(msg::core_at_place, key, text(expected, in_words(range)));
  }
  if (std::string fault = range_fault(key, range, static_cast<double>(read)); !fault.empty()) {
    return fault;
  }
  value = read;
  return {};
}

template <class T>
std::string take_number(const std::string& key, const YamlNode& node,
                        const detail::OptionRange& range, std::vector<T>& value) {
  if (node.kind != YamlNode::Kind::list)
    return text(msg::core_at_place, key, text(msg::rl_config_no_list));
  std::vector<T> list(node.items.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (std::string fault = take_number(key, node.items[i], range, list[i]); !fault.empty()) {
      return fault;
    }
  }
  value = std::move(list);
  return {};
}

template <class T>
std::string take_word(const std::string& key, const YamlNode& node, T& value) {
  const std::vector<std::string> known = words<T>();
  const auto found = std::find(known.begin(), known.end(), node.text);
  if (node.kind != YamlNode::Kind::scalar || found == known.end()) {
    return text(msg::core_at_place, key, text(msg::rl_config_no_word, listed(known))) +
           did_you_mean(node.text, known);
  }
  value = static_cast<T>(found - known.begin());
  return {};
}

/// One line of a configuration.
struct Field {
  std::string section, key;
  std::function<std::string(const YamlNode&)> take;  ///< gives the fault in words, or nothing
  std::function<std::string()> write;
};

/// The fields of `options`, which they refer to.
class Fields {
 public:
  explicit Fields(TrainingOptions& options) { detail::visit_options(options, *this); }

  template <class T>
  void operator()(const char* section, const char* key, T& word) {
    all.push_back({section, key,
                   [key, &word](const YamlNode& node) { return take_word(key, node, word); },
                   [&word] { return written(word); }});
  }
  template <class T>
  void operator()(const char* section, const char* key, T& value,
                  const detail::OptionRange& range) {
    all.push_back({section, key,
                   [key, range, &value](const YamlNode& node) {
                     return take_number(key, node, range, value);
                   },
                   [&value] { return written(value); }});
  }

  std::vector<Field> all;
};

/// Keys of one section, or the sections where `section` is empty.
std::vector<std::string> names_in(const std::vector<Field>& fields, std::string_view section) {
  std::vector<std::string> names;
  for (const Field& field : fields) {
    const std::string& name = section.empty() ? field.section : field.key;
    if ((section.empty() || field.section == section) && (names.empty() || names.back() != name)) {
      names.push_back(name);
    }
  }
  return names;
}

Error fault_at(const std::string& name, const YamlNode& node, std::string what) {
  return {Errc::bad_input, at_place(name, node.place, what)};
}

Error unknown_key(const std::string& name, const YamlNode& key,
                  const std::vector<std::string>& known) {
  const std::string near = did_you_mean(key.text, known);
  return fault_at(name, key,
                  text(msg::rl_config_unknown, key.text) +
                      (near.empty() ? text(msg::rl_config_known, listed(known)) : near));
}

}  // namespace

Result<TrainingOptions> read_config(const std::string& yaml, const std::string& name,
                                    TrainingOptions options) {
  const Result<YamlNode> root = read_yaml(yaml, name);
  if (!root) return fail(root.error());
  const std::vector<Field> fields = Fields(options).all;
  const std::vector<std::string> sections = names_in(fields, "");
  if (root->kind != YamlNode::Kind::map) {
    return fail(fault_at(name, *root, text(msg::rl_config_shape, listed(sections))));
  }
  for (const auto& [section, body] : root->members) {
    const std::vector<std::string> keys = names_in(fields, section.text);
    if (keys.empty()) return fail(unknown_key(name, section, sections));
    if (body.kind != YamlNode::Kind::map) {
      return fail(fault_at(name, section, text(msg::rl_config_shape, listed(keys))));
    }
    for (const auto& [key, value] : body.members) {
      const auto field = std::find_if(fields.begin(), fields.end(), [&](const Field& known) {
        return known.section == section.text && known.key == key.text;
      });
      if (field == fields.end()) return fail(unknown_key(name, key, keys));
      const std::string fault = field->take(value);
      if (!fault.empty()) return fail(fault_at(name, value, fault));
    }
  }
  return options;
}

Result<TrainingOptions> load_config(const std::filesystem::path& file) {
  constexpr std::size_t kMaxBytes = std::size_t{1} << 20;
  const Result<std::string> content = read_file(file, kMaxBytes);
  if (!content) return fail(content.error());
  return read_config(*content, file.string());
}

Result<TrainingOptions> config_of_checkpoint(const std::filesystem::path& file) {
  const Result<TensorSet> set = load_safetensors(file);
  if (!set) return fail(set.error());
  Result<std::optional<TrainingOptions>> config = config_in(*set, file);
  if (!config) return fail(std::move(config.error()));
  if (!*config) return fail(Errc::bad_input, text(msg::rl_no_config, file.string()));
  return std::move(**config);
}

Result<std::optional<TrainingOptions>> config_in(const TensorSet& checkpoint,
                                                 const std::filesystem::path& file) {
  const auto config = checkpoint.metadata.find("config");
  if (config == checkpoint.metadata.end()) return std::nullopt;
  return read_config(config->second, file.string());
}

std::string config_text(const TrainingOptions& options) {
  TrainingOptions copy = options;
  std::string out, section;
  for (const Field& field : Fields(copy).all) {
    if (field.section != section) out += field.section + ":\n";
    section = field.section;
    out += "  " + field.key + ": " + field.write() + "\n";
  }
  return out;
}

}  // namespace mjarm::rl
