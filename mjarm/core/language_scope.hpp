#pragma once

#include <optional>

#include "mjarm/core/messages.hpp"

namespace mjarm {

/// While it lives, the messages of this thread are in one language, whatever the others use: for
/// what stands in pictures, where the fonts of a machine lack the letters of its language.
class LanguageScope {
 public:
  explicit LanguageScope(Language language) noexcept;
  ~LanguageScope();
  LanguageScope(const LanguageScope&) = delete;
  LanguageScope& operator=(const LanguageScope&) = delete;

 private:
  std::optional<Language> before_;
};

}  // namespace mjarm
