#pragma once

#include "mjarm/render/overlay.hpp"
#include "mjarm/view/mouse_input.hpp"
#include "mjarm/view/target_gizmo.hpp"
#include "mjarm/view/target_link.hpp"
#include "mjarm/view/window.hpp"

namespace mjarm::view {

/// The handles of the target in a window; in the main thread. Once it is gone, the window
/// is not drawn any more.
class TargetHandle {
 public:
  /// @param turns  has rings.
  TargetHandle(TargetLink& link, bool turns) : link_(link), gizmo_({}, {.turns = turns}) {}
  TargetHandle(const TargetHandle&) = delete;
  TargetHandle& operator=(const TargetHandle&) = delete;

  /// Takes part in what the mouse does in `window`, and in its frames.
  void attach(Window& window);
  /// As it stood in the last frame.
  [[nodiscard]] const TargetGizmo& gizmo() const noexcept { return gizmo_; }
  [[nodiscard]] const TargetLook& look() const noexcept { return look_; }

 private:
  bool use(const MouseInput& input);
  void draw(const Eye& eye, render::Overlay& overlay);
  void tell(bool held);

  TargetLink& link_;
  TargetGizmo gizmo_;
  TargetLook look_;
  long number_ = 0;
};

}  // namespace mjarm::view
