#include "apps/mjarm/cli/usage.hpp"

#include <algorithm>
#include <charconv>
#include <vector>

#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/model/joint_values.hpp"

namespace mjarm::app {
namespace {

constexpr int kMaxPixels = 8192;

/// A whole number from the beginning of `words`, which is taken away; 0 where there is none.
int take_whole(std::string_view& words) {
  int value = 0;
  const auto [end, error] = std::from_chars(words.data(), words.data() + words.size(), value);
  if (error != std::errc()) return 0;
  words.remove_prefix(static_cast<std::size_t>(end - words.data()));
  return value;
}

}  // namespace

Result<std::uint64_t> parse_whole(const std::string& option, const std::string& value) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error != std::errc() || end != value.data() + value.size()) {
    return fail(Errc::usage, text(msg::app_not_whole, option, value));
  }
  return number;
}

Result<int> parse_count(const std::string& option, const std::string& value, int max, int min) {
  const Result<std::uint64_t> count = parse_whole(option, value);
  if (!count) return fail(count.error());
  if (*count < static_cast<std::uint64_t>(min) || *count > static_cast<std::uint64_t>(max)) {
    return fail(Errc::usage, text(msg::app_count, option, min, max, *count));
  }
  return static_cast<int>(*count);
}

Result<int> parse_threads(const std::string& value) {
  constexpr std::uint64_t kMaxThreads = 1024;
  const Result<std::uint64_t> threads = parse_whole("--threads", value);
  if (!threads) return fail(threads.error());
  if (*threads < 1 || *threads > kMaxThreads) {
    return fail(Errc::usage, text(msg::app_bad_threads, *threads, kMaxThreads));
  }
  return static_cast<int>(*threads);
}

Result<std::size_t> parse_choice(const std::string& option, const std::string& value,
                                 std::span<const std::string> words) {
  const auto word = std::find(words.begin(), words.end(), value);
  if (word != words.end()) return static_cast<std::size_t>(word - words.begin());
  return fail(Errc::usage, text(msg::app_unknown_choice, option, value, did_you_mean(value, words),
                                listed(words)));
}

Result<std::vector<double>> parse_list(const std::string& option, const std::string& value,
                                       Quantity quantity, std::size_t size) {
  if (value.empty()) return fail(Errc::usage, text(msg::app_option_missing, option));
  Result<std::vector<double>> values = parse_quantities(value, quantity);
  if (!values) return fail(in_option(option, std::move(values.error())));
  if (values->size() != size) {
    return fail(Errc::usage, text(msg::app_wrong_count, option, size, values->size()));
  }
  return values;
}

Result<std::vector<double>> parse_joints(const std::string& option, const std::string& value,
                                         const Arm& arm) {
  Result<std::vector<double>> q = parse_joint_values(value, arm);
  if (!q) return fail(in_option(option, std::move(q.error())));
  return q;
}

Result<PixelSize> parse_size(const std::string& option, std::string_view value) {
  std::string_view left = value;
  PixelSize size{};
  size.width = take_whole(left);
  const bool crossed = left.starts_with('x') || left.starts_with('X');
  if (crossed) left.remove_prefix(1);
  size.height = take_whole(left);
  const auto fits = [](int side) { return side >= 1 && side <= kMaxPixels; };
  if (crossed && left.empty() && fits(size.width) && fits(size.height)) {
    // A renderer keeps several samples a pixel: more would take gigabytes.
    constexpr long long kMaxArea = 1LL << 24;
    const long long area = 1LL * size.width * size.height;
    if (area <= kMaxArea) return size;
    return fail(Errc::usage, text(msg::app_many_pixels, option, value, area, kMaxArea));
  }
  return fail(Errc::usage, text(msg::app_bad_size, option, value, kMaxPixels));
}

Error in_option(const std::string& option, Error error) {
  error.what = text(msg::core_at_place, option, error.what);
  return error;
}

}  // namespace mjarm::app
