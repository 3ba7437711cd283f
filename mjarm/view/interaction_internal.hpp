#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mjarm/view/camera_control_internal.hpp"
#include "mjarm/view/input_internal.hpp"
#include "mjarm/view/mouse_input.hpp"
#include "mjarm/view/panels_internal.hpp"
#include "mjarm/view/pick_internal.hpp"

namespace mjarm::view {

/// What the application lets the user do.
struct Permissions {
  bool step = true;
  bool reset = true;
  bool push = true;
  bool target = false;
};

/// Turns what the user does with mouse and keys into changes of the view and into events. An OpenGL
/// context is current while it handles input.
class Interaction {
 public:
  Interaction(render::Scene& scene, Panels& panels, const Permissions& may, bool paused);

  void handle(const RawInput& input, const mjrContext& context);
  void act(ViewAction action);
  /// Once a frame: tells of the push that goes on.
  void update();
  [[nodiscard]] std::vector<ViewEvent> take_events();
  void tell(ViewEvent event) { events_.push_back(std::move(event)); }

  void set_hook(MouseHook hook) { hook_ = std::move(hook); }
  void set_paused(bool paused) { paused_ = paused; }
  [[nodiscard]] bool paused() const { return paused_; }
  [[nodiscard]] double speed() const;
  [[nodiscard]] bool help_shown() const { return help_shown_; }
  [[nodiscard]] bool close_wanted() const { return close_wanted_; }
  /// True once after the user asked for a screenshot.
  [[nodiscard]] bool take_screenshot();
  /// A line for the user that nobody asked for; gone after a while.
  void say(std::string line) { said_ = std::move(line); }
  [[nodiscard]] std::optional<std::string> take_said();

  ViewSettings settings;
  CameraControl camera;
  Picker picker;

 private:
  enum class Drag { none, panel, hook, push, camera };

  void press(const RawInput& input, const mjrContext& context);
  void move(double dx, double dy, const RawInput& input, const mjrContext& context);
  void release(const RawInput& input, const mjrContext& context);
  void scroll(const RawInput& input, const mjrContext& context);
  void key(const RawInput& input);
  void use_panel(const mjrContext& context);
  bool use_hook(const RawInput& input);
  void take_hold(const RawInput& input);
  void pause(bool paused);
  void change_speed(int by);
  [[nodiscard]] PicturePoint point_of(const RawInput& input) const;
  void copy_to_state(const RawInput& input);

  render::Scene& scene_;
  Panels& panels_;
  Permissions may_;
  MouseHook hook_;
  std::vector<ViewEvent> events_;
  std::optional<std::string> said_;
  bool paused_;
  std::size_t speed_;  ///< index into view_speeds()
  bool help_shown_ = false;
  bool close_wanted_ = false;
  bool screenshot_wanted_ = false;
  Drag drag_ = Drag::none;
  int drag_button_ = -1;
  double way_ = 0;  ///< [pixels] of the drag so far
};

}  // namespace mjarm::view
