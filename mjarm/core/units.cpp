#include "mjarm/core/units.hpp"

#include <charconv>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <system_error>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/trim.hpp"

namespace mjarm {
namespace {

struct Unit {
  std::string_view suffix;
  double factor;  ///< to SI
};

constexpr Unit kAngles[] = {{"rad", 1}, {"mrad", 1e-3}, {"deg", std::numbers::pi / 180}};
constexpr Unit kLengths[] = {{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}};
constexpr Unit kTimes[] = {{"s", 1}, {"ms", 1e-3}, {"us", 1e-6}, {"min", 60}};
constexpr Unit kSpeeds[] = {{"m/s", 1}, {"cm/s", 1e-2}, {"mm/s", 1e-3}};

std::span<const Unit> units_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::angle:
      return kAngles;
    case Quantity::length:
      return kLengths;
    case Quantity::time:
      return kTimes;
    case Quantity::speed:
      return kSpeeds;
    case Quantity::number:
      break;
  }
  return {};
}

/// "rad, mrad, deg", for the message.
std::string list(std::span<const Quantity> quantities) {
  std::string result;
  for (const Quantity quantity : quantities) {
    for (const Unit& unit : units_of(quantity)) {
      if (!result.empty()) result += text(msg::core_comma);
      result += unit.suffix;
    }
  }
  return result;
}

/// A value of that unit in SI units. Division by a power of ten is exact where its inverse is not:
/// 25mm is 0.025, to the last bit.
double in_si(double value, const Unit& unit, Quantity quantity) {
  return unit.factor < 1 && quantity != Quantity::angle ? value / std::round(1 / unit.factor)
                                                        : value * unit.factor;
}

/// What of `words` a message shows: all of it, or its beginning.
std::string shown(std::string_view words) {
  constexpr std::size_t kMax = 40;
  return words.size() <= kMax ? std::string(words) : std::string(words.substr(0, kMax)) + "...";
}

}  // namespace

Result<WrittenNumber> parse_written(std::string_view words, std::span<const Quantity> quantities) {
  const std::string_view whole = trimmed(words);
  std::string_view digits = whole;
  if (!digits.empty() && digits.front() == '+') digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool doubled_sign = digits.size() != whole.size() && !digits.empty() && digits[0] == '-';
  if (error == std::errc::invalid_argument || doubled_sign) {
    return fail(Errc::bad_input, text(msg::core_not_a_number, shown(whole)));
  }
  if (error == std::errc::result_out_of_range || !std::isfinite(value)) {
    return fail(Errc::bad_input, text(msg::core_not_finite, shown(whole)));
  }
  const std::string_view suffix =
      trimmed(digits.substr(static_cast<std::size_t>(end - digits.data())));
  if (suffix.empty()) return WrittenNumber{value, Quantity::number};
  for (const Quantity quantity : quantities) {
    for (const Unit& unit : units_of(quantity)) {
      if (suffix == unit.suffix) return WrittenNumber{in_si(value, unit, quantity), quantity};
    }
  }
  const std::string known = list(quantities);
  if (known.empty()) {
    return fail(Errc::bad_input, text(msg::core_unit_not_allowed, shown(suffix), shown(whole)));
  }
  return fail(Errc::bad_input, text(msg::core_unknown_unit, shown(suffix), shown(whole), known));
}

std::string unit_wanted(std::string_view words, Quantity quantity) {
  const bool angle = quantity == Quantity::angle;
  return text(angle ? msg::core_bare_angle : msg::core_bare_length, shown(trimmed(words)));
}

Result<double> parse_quantity(std::string_view words, Quantity quantity) {
  const Result<WrittenNumber> read = parse_written(words, {&quantity, 1});
  if (!read) return fail(read.error());
  if (read->unit != Quantity::number) return read->value;
  const double size = std::abs(read->value);
  const bool meant_otherwise = (quantity == Quantity::angle && size > kMaxBareAngle) ||
                               (quantity == Quantity::length && size > kMaxBareLength);
  if (meant_otherwise) return fail(Errc::bad_input, unit_wanted(words, quantity));
  return read->value;
}

std::vector<std::string_view> split_list(std::string_view words) {
  std::vector<std::string_view> entries;
  std::string_view rest = trimmed(words);
  if (rest.empty()) return entries;
  const bool has_commas = rest.find(',') != std::string_view::npos;
  for (;;) {
    // Without commas blanks part the entries; with commas they may stand before a unit.
    const std::size_t end = rest.find_first_of(has_commas ? "," : " \t");
    entries.push_back(trimmed(rest.substr(0, end)));
    if (end == std::string_view::npos) return entries;
    rest = rest.substr(end + 1);
    if (!has_commas) rest = trimmed(rest);
  }
}

Result<std::vector<double>> parse_quantities(std::string_view words, Quantity quantity) {
  std::vector<double> values;
  for (const std::string_view entry : split_list(words)) {
    Result<double> value = parse_quantity(entry, quantity);
    if (!value) return fail(std::move(value.error()));
    values.push_back(*value);
  }
  if (values.empty()) return fail(Errc::bad_input, text(msg::core_not_a_number, ""));
  return values;
}

}  // namespace mjarm
