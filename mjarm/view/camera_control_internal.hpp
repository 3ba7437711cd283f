#pragma once

#include <string>

#include "mjarm/render/scene.hpp"

namespace mjarm::view {

/// Moves the camera of a scene as the user asks. A camera of the model is left where it stands: the
/// free camera goes on from there.
class CameraControl {
 public:
  explicit CameraControl(render::Scene& scene) : scene_(scene) {}

  /// Remembers the view as it is, and makes it a free one.
  void begin();
  /// @param dx, dy way of the cursor as a share of the view's height, y up.
  void turn(double dx, double dy);
  void pan(double dx, double dy);
  void zoom(double notches);
  void to_first_view();
  /// Goes through the cameras of the model; `by` = 1 or -1.
  void cycle(int by);
  /// Name of the camera in use; empty for the free one.
  [[nodiscard]] std::string name() const;

 private:
  void make_free();

  render::Scene& scene_;
  render::CameraView first_;
};

}  // namespace mjarm::view
