#include "apps/mjarm/commands/plan_show.hpp"

#include <utility>

#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/commands/page_options.hpp"
#include "apps/mjarm/commands/render_options.hpp"
#include "apps/mjarm/messages/plan_show.hpp"
#include "mjarm/core/messages/view.hpp"
#include "mjarm/render/video.hpp"

namespace mjarm::app {
namespace {

Result<void> check_lone_options(const PlanShowArguments& arguments) {
  const std::pair<const char*, const std::string*> all[] = {{"--size", &arguments.size},
                                                            {"--camera", &arguments.camera},
                                                            {"--quality", &arguments.quality},
                                                            {"--seconds", &arguments.seconds}};
  for (const auto& [name, value] : all) {
    if (!value->empty()) return fail(Errc::usage, text(msg::plan_show_alone, name));
  }
  return {};
}

}  // namespace

void add_plan_show_options(CLI::App& app, PlanShowArguments& arguments) {
  add_option(app, "--picture", arguments.picture, msg::plan_show_option_picture, "F.png|mp4|gif");
  add_option(app, "--html", arguments.html, msg::plan_show_option_html, "FILE.html");
  add_flag(app, "--view", arguments.view, msg::plan_show_option_view);
  add_option(app, "--size", arguments.size, msg::plan_show_option_size, "WxH");
  add_option(app, "--camera", arguments.camera, msg::plan_show_option_camera, "C");
  add_option(app, "--quality", arguments.quality, msg::plan_show_option_quality, "Q");
  add_option(app, "--seconds", arguments.seconds, msg::plan_show_option_seconds, "S");
}

Result<std::optional<session::PlanShow>> read_plan_show(const PlanShowArguments& arguments) {
  if (!arguments.wanted()) {
    if (Result<void> none = check_lone_options(arguments); !none) return fail(none.error());
    return std::nullopt;
  }
  if (arguments.view + !arguments.picture.empty() + !arguments.html.empty() > 1) {
    return fail(Errc::usage, text(msg::plan_show_both));
  }
  session::PlanShow out;
  if (!arguments.camera.empty()) {
    out.camera = [words = arguments.camera](const Model& model) {
      return choose_camera(model, words);
    };
  }
  if (!arguments.html.empty()) {
    for (const auto& [name, value] : {std::pair{"--size", &arguments.size},
                                      {"--quality", &arguments.quality},
                                      {"--seconds", &arguments.seconds}}) {
      if (!value->empty()) return fail(Errc::usage, text(msg::plan_show_alone, name));
    }
    Result<RunPages> pages = read_run_pages({.html = arguments.html}, false);
    if (!pages) return fail(std::move(pages.error()));
    out.record = std::move(pages->record);
    return out;
  }
  // Sizes and qualities are read as those of pictures.
  const std::string file = arguments.view ? "window.png" : arguments.picture;
  const std::filesystem::path ending = std::filesystem::path(file).extension();
  if (ending != ".png" && ending != ".PNG" && !render::video_format(file)) {
    return fail(Errc::usage, text(msg::plan_show_ending, file));
  }
  const Result<PictureRequest> picture = read_picture_options({.out = file,
                                                               .size = arguments.size,
                                                               .camera = {},
                                                               .quality = arguments.quality,
                                                               .fps = {},
                                                               .seconds = {}});
  if (!picture) return fail(picture.error());
  out.quality = picture->quality;
  if (!arguments.view) {
    if (!arguments.seconds.empty()) {
      return fail(Errc::usage, text(msg::plan_show_alone, "--seconds"));
    }
    out.picture = *picture;
    return out;
  }
  if (!arguments.size.empty()) {
    out.width = picture->width;
    out.height = picture->height;
  }
  if (arguments.seconds.empty()) return out;
  const Result<double> seconds = parse_quantity(arguments.seconds, Quantity::time);
  if (!seconds) return fail(in_option("--seconds", seconds.error()));
  if (!(*seconds > 0)) return fail(Errc::usage, text(msg::view_bad_seconds, arguments.seconds));
  out.seconds = *seconds;
  return out;
}

}  // namespace mjarm::app
