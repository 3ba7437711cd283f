#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

#include "mjarm/core/error.hpp"
#include "mjarm/core/utf8.hpp"

namespace mjarm::fuzz {

/// Ends the fuzzer with what is wrong; the input is kept.
[[noreturn]] inline void finding(const char* what, const std::string& detail) {
  std::fprintf(stderr, "FINDING: %s: %s\n", what, detail.c_str());
  std::abort();
}

/// Whatever is wrong with an input is told in one line of text.
inline void check_line(const std::string& what) {
  if (what.empty()) finding("no words", what);
  if (what.find('\n') != std::string::npos) finding("more than one line", what);
}

/// The same of an error: it is the input that is bad.
inline void check_refusal(const Error& error) {
  if (error.code != Errc::bad_input) finding("code of the error", error.what);
  check_line(error.what);
}

}  // namespace mjarm::fuzz
