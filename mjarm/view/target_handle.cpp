#include "mjarm/view/target_handle.hpp"

namespace mjarm::view {

void TargetHandle::attach(Window& window) {
  window.set_mouse_hook([this](const MouseInput& input) { return use(input); });
  window.set_draw_hook([this](const Eye& eye, render::Overlay& overlay) { draw(eye, overlay); });
}

void TargetHandle::tell(bool held) { link_.drags.push({{gizmo_.pose(), held, ++number_}}); }

bool TargetHandle::use(const MouseInput& input) {
  if (!look_.shown) return false;
  const Ray mouse{input.origin_W, input.direction_W};
  switch (input.kind) {
    case MouseInput::Kind::press:
      if (input.button != 0 || input.control || !gizmo_.grab(mouse)) return false;
      tell(true);
      return true;
    case MouseInput::Kind::move:
      if (!gizmo_.held()) {
        (void)gizmo_.hover(mouse);
        return false;
      }
      gizmo_.drag(mouse);
      tell(true);
      return true;
    case MouseInput::Kind::release:
      if (!gizmo_.held()) return false;
      gizmo_.drag(mouse);
      gizmo_.release();
      tell(false);
      return true;
  }
  return false;
}

void TargetHandle::draw(const Eye& eye, render::Overlay& overlay) {
  if (link_.looks.take(look_)) {
    // What was made before the last drag would throw the target back.
    const bool is_answer = look_.number == number_;
    if (!look_.shown) gizmo_.release();
    if (!gizmo_.held()) {
      gizmo_.set_axes(look_.R_WG);
      if (is_answer) gizmo_.set_pose(look_.X_WT);
    }
  }
  if (!look_.shown) return;
  gizmo_.set_eye(eye);
  gizmo_.draw(overlay, look_.color);
}

}  // namespace mjarm::view
