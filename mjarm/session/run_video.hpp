#pragma once

#include <optional>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/render/overlay.hpp"
#include "mjarm/render/video.hpp"
#include "mjarm/session/picture.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::session {

/// Takes the frames of a video from a simulation as it runs, in simulated time. It only reads: the
/// simulation goes on as if nobody looked.
///
///   Result<VideoOfRun> video = VideoOfRun::open(model, options, camera);
///   (void)video->step(sim, overlay);                       // the first frame, before it moves
///   setup.after_step = [&](const Sim& sim, const JointVec&) { return video->step(sim, overlay); };
///   ... run ...
///   Result<void> done = video->finish();
class VideoOfRun {
 public:
  /// Opens OpenGL and starts ffmpeg; nothing stands under the name of the file
  /// before `finish`.
  [[nodiscard]] static Result<VideoOfRun> open(const Model& model, const PictureOptions& options,
                                               const render::Camera& camera);

  /// Whether `step` would take a frame now; spares making an overlay for nothing.
  [[nodiscard]] bool is_due(const Sim& sim) const;

  /// Another run begins here, whatever its clock says: the next frame is due now.
  void begin_again(const Sim& sim) { start_ = sim.time() - frames() / options_.fps; }

  /// Takes the frames that are due, the first at the time of the first call. After each step.
  /// @return false where the user pressed Ctrl-C or a frame could not be kept: stop then, `finish`
  ///         tells why.
  [[nodiscard]] bool step(const Sim& sim, const render::Overlay& overlay);

  /// Adds a frame of any state and camera, whatever the time. @return false as `step`.
  [[nodiscard]] bool add(const Snapshot& snapshot, const render::Camera& camera,
                         const render::Overlay& overlay);

  /// Ends the file, which now stands under its name; without this call there is none.
  /// @return why there is no file: Ctrl-C, ffmpeg, OpenGL.
  [[nodiscard]] Result<void> finish();

  [[nodiscard]] const render::Camera& camera() const { return camera_; }
  [[nodiscard]] int frames() const { return writer_.frames(); }
  /// `a.mp4: 1280 x 720 pixels, 150 frames, 5.00 s`, for people.
  [[nodiscard]] std::string summary() const;

 private:
  VideoOfRun(PictureOptions options, render::Camera camera, render::OffscreenRenderer renderer,
             render::VideoWriter writer)
      : options_(std::move(options)),
        camera_(std::move(camera)),
        renderer_(std::move(renderer)),
        writer_(std::move(writer)) {}

  PictureOptions options_;
  render::Camera camera_;
  render::OffscreenRenderer renderer_;
  render::VideoWriter writer_;
  std::optional<render::Corner> legend_;  ///< where the first picture has it
  std::optional<double> start_;           ///< [s] of the first frame
  std::optional<Error> error_;
};

}  // namespace mjarm::session
