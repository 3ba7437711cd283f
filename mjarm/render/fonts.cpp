#include "mjarm/render/fonts.hpp"

#include <mutex>

#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/render.hpp"
#include "mjarm/render/fonts_internal.hpp"

namespace mjarm::render {
const std::string& chinese_font() {
  static const std::string found = find_chinese_font();
  return found;
}

Language picture_language() {
  if (language() == Language::english || !chinese_font().empty()) return language();
  static std::once_flag told;
  std::call_once(told, [] { log_info(text(msg::render_no_chinese_font)); });
  return Language::english;
}

}  // namespace mjarm::render
