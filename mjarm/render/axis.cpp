#include <algorithm>
#include <charconv>
#include <cmath>

#include "mjarm/render/axis_internal.hpp"

namespace mjarm::axis {
namespace {

/// The smallest of 1, 2, 5 times a power of ten that is not below `least`; and that power.
struct Step {
  double size = 1;
  int exponent = 0;
};

Step nice_step(double least) {
  const int exponent = static_cast<int>(std::floor(std::log10(least)));
  const double unit = std::pow(10.0, exponent);
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * unit >= least * (1 - 1e-9)) return {factor * unit, exponent};
  }
  return {10 * unit, exponent + 1};
}

std::string fixed(double value, int decimals) {
  char digits[64];
  const auto [end, error] =
      std::to_chars(digits, digits + sizeof(digits), value, std::chars_format::fixed, decimals);
  std::string text = error == std::errc() ? std::string(digits, end) : "?";
  if (text.find_first_not_of("-0.") == std::string::npos && text[0] == '-') text.erase(0, 1);
  // The true minus sign is as wide as the digits.
  if (text[0] == '-') text.replace(0, 1, "\u2212");
  return text;
}

/// "×10⁻³"
std::string power_of_ten(int exponent) {
  static constexpr const char* kDigits[] = {"\u2070", "\u00B9", "\u00B2", "\u00B3", "\u2074",
                                            "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string text = "\u00D710";
  if (exponent < 0) text += "\u207B";
  for (const char c : std::to_string(std::abs(exponent))) text += kDigits[c - '0'];
  return text;
}

}  // namespace

void Extent::add(double value) {
  if (!std::isfinite(value)) return;
  lower_ = seen_ ? std::min(lower_, value) : value;
  upper_ = seen_ ? std::max(upper_, value) : value;
  seen_ = true;
}

render::PlotRange Extent::range(double margin) const {
  if (!seen_) return {0, 1};
  const double middle = lower_ / 2 + upper_ / 2;
  // Below this the marks on the axis could not be told apart in the digits of a double.
  const double least = std::max(1e-6 * std::abs(middle), 1e-15);
  double half = (upper_ / 2 - lower_ / 2) * (1 + 2 * margin);
  if (half < least) half = middle == 0 ? 1 : std::max(0.1 * std::abs(middle), least);
  return {middle - half, middle + half};
}

Ticks ticks_for(const render::PlotRange& range, int count) {
  const Step step = nice_step((range.upper - range.lower) / std::max(count, 1));
  Ticks ticks;
  const double slack = 1e-9 * step.size;
  for (double n = std::ceil((range.lower - slack) / step.size);
       n * step.size <= range.upper + slack && ticks.at.size() < 100; ++n) {
    ticks.at.push_back(n * step.size);
  }
  const double largest = std::max(std::abs(range.lower), std::abs(range.upper));
  const int magnitude = static_cast<int>(std::floor(std::log10(largest)));
  // Long labels are hard to read; a common factor keeps them short. Powers of a thousand go with
  // the prefixes of units (milli, micro).
  const int thousands = static_cast<int>(std::floor(magnitude / 3.0));
  const int power = magnitude >= 5 || magnitude <= -4 ? 3 * thousands : 0;
  if (power != 0) ticks.factor = power_of_ten(power);
  const int decimals = std::clamp(power - step.exponent, 0, 12);
  for (const double value : ticks.at) {
    ticks.labels.push_back(fixed(value / std::pow(10.0, power), decimals));
  }
  return ticks;
}

Ticks log_ticks_for(const render::PlotRange& range, int count) {
  const int from = static_cast<int>(std::floor(range.lower));
  const int to = static_cast<int>(std::ceil(range.upper));
  constexpr double kSlack = 1e-9;
  const int every = std::max(1, (to - from) / std::max(count, 1));
  const bool few = range.upper - range.lower < 2;
  Ticks ticks;
  for (int exponent = from; exponent <= to && ticks.at.size() < 100; exponent += every) {
    for (const int factor : {1, 2, 5}) {
      const double at = exponent + std::log10(factor);
      if ((factor > 1 && !few) || at < range.lower - kSlack || at > range.upper + kSlack) continue;
      const bool plain = std::abs(exponent) <= 3;
      ticks.at.push_back(at);
      ticks.labels.push_back(plain
                                 ? fixed(factor * std::pow(10.0, exponent), std::max(-exponent, 0))
                                 : (factor > 1 ? fixed(factor, 0) : std::string()) +
                                       power_of_ten(exponent).substr(factor > 1 ? 0 : 2));
    }
  }
  return ticks;
}

void equalise(render::PlotRange& x, render::PlotRange& y, double width, double height) {
  const double x_unit = (x.upper - x.lower) / width;
  const double y_unit = (y.upper - y.lower) / height;
  const double unit = std::max(x_unit, y_unit);
  const auto widen = [](render::PlotRange& range, double length) {
    const double middle = range.lower / 2 + range.upper / 2;
    range = {middle - length / 2, middle + length / 2};
  };
  if (x_unit < unit) widen(x, unit * width);
  if (y_unit < unit) widen(y, unit * height);
}

}  // namespace mjarm::axis
