#include "apps/mjarm/commands/render_options.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/render_command.hpp"
#include "mjarm/render/video.hpp"

namespace mjarm::app {
namespace {

constexpr double kMaxRate = 1000;     // [1/s]
constexpr double kMaxSeconds = 3600;  // [s]
constexpr double kGifRate = 20;       // [1/s] a whole number of the hundredths a GIF counts in

Result<double> read_amount(const char* option, const std::string& words, Quantity quantity,
                           double max) {
  Result<double> value = parse_quantity(words, quantity);
  if (!value) return fail(in_option(option, std::move(value.error())));
  if (*value > 0 && *value <= max) return value;
  return fail(Errc::usage, text(msg::render_command_range, option, words, max));
}

Result<void> read_times(const PictureArguments& arguments, PictureRequest& options) {
  if (!arguments.fps.empty()) {
    const Result<double> fps = read_amount("--fps", arguments.fps, Quantity::number, kMaxRate);
    if (!fps) return fail(fps.error());
    if (!options.video) return fail(Errc::usage, text(msg::render_command_video_only, "--fps"));
    options.fps = *fps;
  }
  if (!arguments.seconds.empty()) {
    const Result<double> seconds =
        read_amount("--seconds", arguments.seconds, Quantity::time, kMaxSeconds);
    if (!seconds) return fail(seconds.error());
    options.seconds = *seconds;
  }
  return {};
}

/// Reads `azimuth,elevation,distance[,x,y,z]`.
Result<render::CameraView> read_view(const Model& model, const std::string& words) {
  const std::vector<std::string_view> parts = split_list(words);
  if (parts.size() != 3 && parts.size() != 6) {
    return fail(Errc::usage, text(msg::render_command_camera_values, words, parts.size()));
  }
  std::array<double, 6> values{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Result<double> value =
        parse_quantity(parts[i], i < 2 ? Quantity::angle : Quantity::length);
    if (!value) return fail(in_option("--camera", value.error()));
    values[i] = *value;
  }
  render::CameraView view = render::default_view(model);
  view.azimuth = values[0];
  view.elevation = values[1];
  view.distance = values[2];
  if (parts.size() == 6) view.lookat_W = {values[3], values[4], values[5]};
  return view;
}

}  // namespace

void add_picture_options(CLI::App& app, PictureArguments& arguments) {
  add_option(app, "--out", arguments.out, msg::render_command_option_out, "F.png|mp4|gif");
  add_overwrite_option(app, arguments.replace);
  add_option(app, "--size", arguments.size, msg::render_command_option_size, "WxH");
  add_option(app, "--camera", arguments.camera, msg::render_command_option_camera, "C");
  add_option(app, "--quality", arguments.quality, msg::render_command_option_quality, "Q");
  add_option(app, "--fps", arguments.fps, msg::render_command_option_fps, "N");
  add_option(app, "--seconds", arguments.seconds, msg::render_command_option_seconds, "S");
}

Result<PictureRequest> read_picture_options(const PictureArguments& arguments) {
  if (arguments.out.empty()) return fail(Errc::usage, text(msg::app_option_missing, "--out"));
  PictureRequest options;
  options.out = arguments.out;
  options.camera = arguments.camera;
  const std::optional<render::VideoFormat> format = render::video_format(options.out);
  const std::string ending = options.out.extension().string();
  if (!format && ending != ".png" && ending != ".PNG") {
    return fail(Errc::usage, text(msg::render_command_ending, arguments.out));
  }
  options.video = format.has_value();
  if (format == render::VideoFormat::gif) {
    options.width /= 2;
    options.height /= 2;
    options.fps = kGifRate;
  }
  if (!arguments.size.empty()) {
    const Result<PixelSize> size = parse_size("--size", arguments.size);
    if (!size) return fail(size.error());
    options.width = size->width;
    options.height = size->height;
  }
  if (!arguments.quality.empty()) {
    static const std::array<std::string, 3> kWords = {"low", "medium", "high"};
    const Result<std::size_t> word = parse_choice("--quality", arguments.quality, kWords);
    if (!word) return fail(word.error());
    options.quality = static_cast<render::RenderQuality>(*word);
  }
  if (Result<void> read = read_times(arguments, options); !read) return fail(read.error());
  return options;
}

Result<render::Camera> choose_camera(const Model& model, const std::string& words) {
  if (words.empty()) return session::default_camera(model);
  render::Camera camera;
  if (words.find(',') != std::string::npos) {
    const Result<render::CameraView> view = read_view(model, words);
    if (!view) return fail(view.error());
    camera.view = *view;
  } else {
    camera.name = words;
  }
  if (Result<void> checked = render::check_camera(model, camera); !checked) {
    return fail(in_option("--camera", std::move(checked.error())));
  }
  return camera;
}

}  // namespace mjarm::app
