#pragma once

#include <string>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/messages.hpp"

namespace mjarm::render {

/// Font family of this machine that has the Chinese characters of the message catalogue, as
/// fontconfig finds it; empty where there is none. Looked up once a process.
[[nodiscard]] const std::string& chinese_font();

/// The language of texts in pictures: the one in use where the fonts of this machine can show it,
/// else English. The first time it falls back it says so in the log, and which package to install.
/// Whoever words a plot or a window does it in a `LanguageScope` of this language.
[[nodiscard]] Language picture_language();

/// A single text of a picture.
template <class... Args>
[[nodiscard]] std::string picture_text(Msg message, const Args&... args) {
  const LanguageScope drawn(picture_language());
  return text(message, args...);
}

}  // namespace mjarm::render
