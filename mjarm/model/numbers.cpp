#include <charconv>

#include "mjarm/model/numbers_internal.hpp"

namespace mjarm {

std::vector<double> numbers_in(std::string_view words) {
  std::vector<double> numbers;
  const char* const end = words.data() + words.size();
  for (const char* at = words.data(); at != end;) {
    if (*at == '+' || *at == ' ' || *at == '\t' || *at == '\r' || *at == '\n') {
      ++at;
      continue;
    }
    double value = 0;
    const auto [next, failure] = std::from_chars(at, end, value);
    if (failure != std::errc()) break;
    numbers.push_back(value);
    at = next;
  }
  return numbers;
}

}  // namespace mjarm
