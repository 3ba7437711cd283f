#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "mjarm/core/result.hpp"
#include "mjarm/render/image.hpp"

namespace mjarm::render {

/// What a video is written as.
enum class VideoFormat {
  mp4,  ///< H.264, 8 bits, 4:2:0, BT.709: what every player and browser shows
  gif,  ///< one palette for all frames, played for ever
};

/// The format that the ending of `path` names (.mp4, .gif, also in capitals); none for others.
[[nodiscard]] std::optional<VideoFormat> video_format(const std::filesystem::path& path);

/// Size and rate of a video. Every default is usable as is.
struct VideoOptions {
  int width = 1280;  ///< [px] of every frame; even for MP4
  int height = 720;  ///< [px] of every frame; even for MP4
  double fps = 30;   ///< [1/s] frames a second, > 0; a GIF can show 100 at most
};

/// Writes pictures into a video file through the program ffmpeg, which is started for it. The file
/// appears under its name only when `finish` succeeds; until then it grows under a temporary name
/// beside it, which vanishes with this object.
class VideoWriter {
 public:
  /// Starts ffmpeg; `path` ends in .mp4 or .gif.
  /// @return bad_input for another ending, an odd size of an MP4, a bad rate; not_available with
  ///         the package to install where there is no ffmpeg; system where the file cannot be made.
  [[nodiscard]] static Result<VideoWriter> create(const std::filesystem::path& path,
                                                  const VideoOptions& options = {});
  ~VideoWriter();
  VideoWriter(VideoWriter&&) noexcept;
  VideoWriter& operator=(VideoWriter&&) noexcept;

  /// Appends a frame.
  /// @return bad_input where it has another size; system with what ffmpeg says where it has failed
  ///         (a full disk, no encoder). Nothing can be added then.
  [[nodiscard]] Result<void> add(const Image& frame);
  /// Lets ffmpeg end and puts the file in its place. Call once, last.
  /// @return system with what ffmpeg says, or where the user pressed Ctrl-C meanwhile.
  [[nodiscard]] Result<void> finish();

  [[nodiscard]] int frames() const noexcept;  ///< added so far

 private:
  struct Impl;
  explicit VideoWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm::render
