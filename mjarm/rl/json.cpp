#include <functional>
#include <set>
#include <vector>

#include "mjarm/core/messages/policy_file.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/rl/json_internal.hpp"

namespace mjarm::rl {
namespace {

/// What a parser of JSON lets pass: it sees every event, and drops what lies too deep.
class JsonWatch {
 public:
  using Event = nlohmann::json::parse_event_t;

  explicit JsonWatch(int max_depth) : max_depth_(max_depth) {}

  bool operator()(int depth, Event event, const nlohmann::json& value) {
    if (event == Event::object_start || event == Event::array_start) {
      if (depth >= max_depth_) {
        too_deep = true;
        return false;
      }
      keys_.resize(static_cast<std::size_t>(depth) + 1);
      keys_.back().clear();
    } else if (event == Event::key && depth <= max_depth_) {
      const auto& key = value.get_ref<const std::string&>();
      if (!keys_[static_cast<std::size_t>(depth) - 1].insert(key).second) twice = in_quotes(key);
    }
    return true;
  }

  bool too_deep = false;
  std::string twice;  ///< a key that an object names twice, quoted

 private:
  int max_depth_;
  std::vector<std::set<std::string>> keys_;  ///< of the objects that are open
};

}  // namespace

Result<nlohmann::json> parse_json_object(std::string_view text_of_it, int max_depth,
                                         const std::string& source, const std::string& part) {
  JsonWatch watch(max_depth);
  try {
    nlohmann::json parsed = nlohmann::json::parse(text_of_it, std::ref(watch));
    if (watch.too_deep) {
      return fail(Errc::bad_input, text(msg::policy_file_json_deep, source, part, max_depth));
    }
    if (!watch.twice.empty()) {
      return fail(Errc::bad_input, text(msg::policy_file_json_twice, source, part, watch.twice));
    }
    if (!parsed.is_object()) {
      return fail(Errc::bad_input, text(msg::policy_file_json_object, source, part));
    }
    return parsed;
  } catch (const nlohmann::json::parse_error& error) {
    return fail(Errc::bad_input, text(msg::policy_file_json_bad, source, part, error.byte));
  } catch (const nlohmann::json::exception&) {  // a number that no double can hold
    return fail(Errc::bad_input, text(msg::policy_file_json_bad, source, part, 0));
  }
}

std::string in_quotes(std::string_view name) {
  constexpr std::size_t kLongest = 80;
  std::string out;
  append_json_string(out, name.substr(0, kLongest));
  if (name.size() > kLongest) out += "...";
  return out;
}

}  // namespace mjarm::rl
