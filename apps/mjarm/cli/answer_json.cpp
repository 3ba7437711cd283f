#include "apps/mjarm/cli/answer_json.hpp"

#include <cmath>

#include "mjarm/core/number.hpp"

namespace mjarm::app {

void append_key(std::string& out, const char* key) { out += std::string(",\"") + key + "\":"; }

void append_value(std::string& out, const char* key, double value) {
  append_key(out, key);
  append_number(out, value);
}

void append_value(std::string& out, const char* key, const JointVec& values) {
  append_key(out, key);
  append_numbers(out, as_span(values));
}

void append_rows(std::string& out, const char* key, std::span<const JointVec> rows) {
  append_key(out, key);
  out += '[';
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i > 0) out += ',';
    append_numbers(out, as_span(rows[i]));
  }
  out += ']';
}

void append_us(std::string& out, double us, const char* key) {
  append_value(out, key, std::round(us * 10) / 10);
}

}  // namespace mjarm::app
