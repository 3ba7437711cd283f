#pragma once

#include <tl/expected.hpp>
#include <utility>

#include "mjarm/core/error.hpp"

namespace mjarm {

/// Value or failure: the one failure idiom of mjarm. Cold calls fail with `Error` (has text), hot
/// calls with a small typed struct of their own (no text, best attempt kept).
template <class T, class F = Error>
using Result = tl::expected<T, F>;

/// Shorthand for `return fail(Errc::bad_input, text)`.
[[nodiscard]] inline tl::unexpected<Error> fail(Errc code, std::string what) {
  return tl::unexpected<Error>(Error{code, std::move(what)});
}

/// Passes any failure on: `return fail(std::move(result.error()))`.
template <class F>
[[nodiscard]] tl::unexpected<std::decay_t<F>> fail(F&& failure) {
  return tl::unexpected<std::decay_t<F>>(std::forward<F>(failure));
}

}  // namespace mjarm
