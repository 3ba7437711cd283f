#include "mjarm/render/video.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/render.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/core/os_child_input.hpp"

namespace mjarm::render {
namespace {

constexpr double kMaxFps = 1000;  // [1/s]
constexpr double kGifFps = 100;   // [1/s] a GIF counts hundredths of a second

/// What ffmpeg is told about how the file is to be.
std::vector<std::string> output_options(VideoFormat format) {
  if (format == VideoFormat::gif) {
    // A palette for the whole, made from what moves as much as from what stands.
    return {"-filter_complex",
            "[0:v]split[a][b];[a]palettegen=stats_mode=full[p];"
            "[b][p]paletteuse=dither=bayer:bayer_scale=4:diff_mode=rectangle",
            "-loop",
            "0",
            "-f",
            "gif"};
  }
  // Players take untagged video of this size for BT.709, so it is converted to that and says so.
  return {"-vf",
          "scale=out_color_matrix=bt709:out_range=tv",
          "-c:v",
          "libx264",
          "-preset",
          "fast",
          "-crf",
          "18",
          "-pix_fmt",
          "yuv420p",
          "-colorspace",
          "bt709",
          "-color_trc",
          "bt709",
          "-color_range",
          "tv",
          "-movflags",
          "+faststart",
          "-f",
          "mp4",
          "-color_primaries",
          "bt709"};
}

std::vector<std::string> ffmpeg_arguments(VideoFormat format, const VideoOptions& options,
                                          const std::filesystem::path& file) {
  const std::string size = std::to_string(options.width) + "x" + std::to_string(options.height);
  // Without -xerror a disk that is full at the very end would be no failure.
  std::vector<std::string> words = {
      "-xerror",    "-hide_banner",      "-loglevel", "error", "-nostdin",    "-y",
      "-f",         "rawvideo",          "-pix_fmt",  "rgb24", "-video_size", size,
      "-framerate", number(options.fps), "-i",        "pipe:0"};
  for (std::string& word : output_options(format)) words.push_back(std::move(word));
  words.push_back("file:" + file.string());  // else a name with a colon would be a protocol
  return words;
}

Result<void> check_options(VideoFormat format, const VideoOptions& options) {
  if (options.width < 1 || options.height < 1) {
    return fail(Errc::bad_input, text(msg::render_video_size, options.width, options.height));
  }
  if (format == VideoFormat::mp4 && (options.width % 2 != 0 || options.height % 2 != 0)) {
    return fail(Errc::bad_input,
                text(msg::render_video_odd, options.width, options.height,
                     options.width + options.width % 2, options.height + options.height % 2));
  }
  const double max = format == VideoFormat::gif ? kGifFps : kMaxFps;
  if (!(options.fps > 0) || options.fps > max) {
    return fail(Errc::bad_input, text(msg::render_video_fps, options.fps, max));
  }
  return {};
}

/// The first line of what ffmpeg said: the cause; what follows are its consequences.
std::string first_line(std::string_view words) {
  const std::size_t start = words.find_first_not_of("\r\n ");
  if (start == std::string_view::npos) return {};
  words.remove_prefix(start);
  return std::string(words.substr(0, words.find_first_of("\r\n")));
}

}  // namespace

std::optional<VideoFormat> video_format(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending == ".mp4") return VideoFormat::mp4;
  if (ending == ".gif") return VideoFormat::gif;
  return std::nullopt;
}

struct VideoWriter::Impl {
  /// Waits for the end of ffmpeg. @return what it complains about.
  Result<void> end() {
    const Result<FedProgramEnd> done = ffmpeg.finish();
    if (!done) return fail(done.error());
    if (done->exit_code == 0) return {};
    std::string why = first_line(done->complaints);
    if (why.empty()) why = text(msg::render_ffmpeg_code, done->exit_code);
    return fail(Errc::system, text(msg::render_ffmpeg_failed, path.string(), why));
  }

  std::filesystem::path path;
  VideoOptions options;
  AtomicFile file;  ///< is removed after ffmpeg has ended
  FedProgram ffmpeg;
  int frames = 0;
  bool failed = false;
};

Result<VideoWriter> VideoWriter::create(const std::filesystem::path& path,
                                        const VideoOptions& options) {
  const std::optional<VideoFormat> format = video_format(path);
  if (!format) return fail(Errc::bad_input, text(msg::render_video_ending, path.string()));
  if (Result<void> checked = check_options(*format, options); !checked) {
    return fail(std::move(checked.error()));
  }
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return fail(std::move(file.error()));
  Result<FedProgram> ffmpeg =
      FedProgram::start("ffmpeg", ffmpeg_arguments(*format, options, file->growing()));
  if (!ffmpeg) {
    if (ffmpeg.error().code != Errc::not_available) return fail(std::move(ffmpeg.error()));
    return fail(Errc::not_available, text(msg::render_no_ffmpeg, path.string()));
  }
  return VideoWriter(
      std::unique_ptr<Impl>(new Impl{path, options, std::move(*file), std::move(*ffmpeg)}));
}

VideoWriter::VideoWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
VideoWriter::~VideoWriter() = default;
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;

Result<void> VideoWriter::add(const Image& frame) {
  const VideoOptions& options = impl_->options;
  const std::size_t bytes = 3 * static_cast<std::size_t>(options.width) * options.height;
  if (frame.width != options.width || frame.height != options.height || frame.rgb.size() != bytes) {
    return fail(Errc::bad_input, text(msg::render_video_frame, frame.width, frame.height,
                                      options.width, options.height));
  }
  const auto* data = reinterpret_cast<const char*>(frame.rgb.data());
  if (!impl_->failed && impl_->ffmpeg.feed({data, bytes})) {
    ++impl_->frames;
    return {};
  }
  if (std::exchange(impl_->failed, true)) {
    return fail(Errc::system, text(msg::render_ffmpeg_failed, impl_->path.string(),
                                   text(msg::render_ffmpeg_ended)));
  }
  if (Result<void> ended = impl_->end(); !ended) return ended;
  return fail(Errc::system, text(msg::render_ffmpeg_failed, impl_->path.string(),
                                 text(msg::render_ffmpeg_ended)));
}

Result<void> VideoWriter::finish() {
  if (impl_->failed) {
    return fail(Errc::system, text(msg::render_ffmpeg_failed, impl_->path.string(),
                                   text(msg::render_ffmpeg_ended)));
  }
  impl_->failed = true;  // whatever comes, nothing can be added any more
  if (impl_->frames == 0) {
    return fail(Errc::bad_input, text(msg::render_video_empty, impl_->path.string()));
  }
  if (Result<void> ended = impl_->end(); !ended) return ended;
  return impl_->file.commit();
}

int VideoWriter::frames() const noexcept { return impl_->frames; }

}  // namespace mjarm::render
