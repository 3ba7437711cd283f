#include "apps/mjarm/commands/window_options.hpp"

#include "apps/mjarm/cli/usage.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/messages/view.hpp"
#include "mjarm/core/text_width.hpp"

namespace mjarm::app {

void add_window_options(CLI::App& app, WindowArguments& arguments) {
  add_option(app, "--size", arguments.size, msg::view_option_size, "WxH");
  add_option(app, "--camera", arguments.camera, msg::view_option_camera, "CAMERA");
  add_option(app, "--quality", arguments.quality, msg::view_option_quality, "low|high");
}

Result<view::WindowOptions> read_window_options(const WindowArguments& arguments,
                                                view::WindowOptions out) {
  if (!arguments.size.empty()) {
    const Result<PixelSize> size = parse_size("--size", arguments.size);
    if (!size) return fail(size.error());
    out.width = size->width;
    out.height = size->height;
  }
  if (!arguments.quality.empty()) {
    const std::string words[] = {"low", "high"};
    const auto chosen = parse_choice("--quality", arguments.quality, words);
    if (!chosen) return fail(chosen.error());
    out.quality = *chosen == 0 ? render::RenderQuality::low : render::RenderQuality::high;
  }
  return out;
}

std::string examples_and_controls(Language language, Msg examples, Msg heading,
                                  std::vector<view::ControlHelp> (*rows)()) {
  const LanguageScope scope(language);
  std::string lines = text(examples) + "\n\n" + text(heading);
  for (const view::ControlHelp& row : rows()) lines += "\n  " + padded(row.keys, 20) + row.about;
  return lines;
}

}  // namespace mjarm::app
