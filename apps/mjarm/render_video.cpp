#include "apps/mjarm/render_video.hpp"

#include <cmath>
#include <utility>

#include "mjarm/core/messages/render_command.hpp"
#include "mjarm/core/os.hpp"

namespace mjarm::app {

Result<VideoOfRun> VideoOfRun::open(const Model& model, const PictureOptions& options) {
  Result<Camera> camera = choose_camera(model, options.camera);
  if (!camera) return fail(std::move(camera.error()));
  Result<OffscreenRenderer> renderer = OffscreenRenderer::create(model, offscreen_options(options));
  if (!renderer) return fail(std::move(renderer.error()));
  Result<VideoWriter> writer = VideoWriter::create(
      options.out, {.width = options.width, .height = options.height, .fps = options.fps});
  if (!writer) return fail(std::move(writer.error()));
  return VideoOfRun(options, std::move(*camera), std::move(*renderer), std::move(*writer));
}

bool VideoOfRun::add(const Snapshot& snapshot, const Camera& camera, const Overlay& overlay) {
  if (error_ || interrupted()) return false;
  const Result<Image> image = renderer_.draw(snapshot, camera, overlay);
  const Result<void> added = image ? writer_.add(*image) : fail(image.error());
  if (!added) error_ = added.error();
  return !error_;
}

bool VideoOfRun::step(const Sim& sim, const Overlay& overlay) {
  if (error_ || interrupted()) return false;
  const double now = sim.time();
  if (!start_) start_ = now;
  // Half a step early is as near as half a step late.
  const double half = sim.model().timestep() / 2;
  while (*start_ + frames() / options_.fps <= now + half) {
    if (!add(sim.snapshot(), camera_, overlay)) return false;
  }
  return true;
}

Result<void> VideoOfRun::finish() {
  if (!error_ && !interrupted()) {
    Result<void> finished = writer_.finish();
    if (finished) return {};
    error_ = std::move(finished.error());
  }
  if (interrupted()) {
    return fail(Errc::system, text(msg::render_command_stopped, options_.out.string()));
  }
  return fail(*error_);
}

std::string VideoOfRun::summary() const {
  return text(msg::render_command_video, options_.out.string(), options_.width, options_.height,
              frames(), frames() / options_.fps);
}

void grow_trail(std::vector<Eigen::Vector3d>& points_W, const Eigen::Vector3d& p_W) {
  constexpr double kSpacing = 0.002;  // [m] the eye sees no difference below
  constexpr double kOff = 0.0002;   // [m] so far may a straight piece leave the bend it stands for
  constexpr double kLongest = 0.1;  // [m] of a piece
  if (points_W.empty()) {
    points_W.push_back(p_W);
    return;
  }
  const Eigen::Vector3d step = p_W - points_W.back();
  if (step.norm() < kSpacing) return;
  if (points_W.size() >= 2) {
    const Eigen::Vector3d& from = points_W[points_W.size() - 2];
    const Eigen::Vector3d piece = p_W - from;
    const double length = piece.norm();
    // Half the angle by which the way has turned since `from`; an arc of it bulges by a quarter of
    // its length times that.
    const double turn = std::atan2(step.cross(piece).norm(), step.dot(piece));
    if (length < kLongest && length * turn / 4 < kOff) {
      points_W.back() = p_W;
      return;
    }
  }
  points_W.push_back(p_W);
}

}  // namespace mjarm::app
