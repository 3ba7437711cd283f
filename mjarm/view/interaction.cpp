#include <algorithm>
#include <cmath>
#include <utility>

#include "mjarm/core/messages/view.hpp"
#include "mjarm/view/interaction_internal.hpp"
#include "mjarm/view/ray.hpp"
#include "mjarm/view/settings_internal.hpp"

namespace mjarm::view {
namespace {

constexpr double kDoubleClick = 0.4;  // [s] between two presses
constexpr double kClickWay = 4;       // [pixels] a click may move

/// As MuJoCo numbers buttons, which is not as GLFW does.
constexpr int kButtons[] = {mjBUTTON_LEFT, mjBUTTON_RIGHT, mjBUTTON_MIDDLE};

}  // namespace

Interaction::Interaction(render::Scene& scene, Panels& panels, const Permissions& may, bool paused)
    : settings(settings_of(scene)),
      camera(scene),
      picker(scene),
      scene_(scene),
      panels_(panels),
      may_(may),
      paused_(paused),
      speed_(static_cast<std::size_t>(std::find(view_speeds().begin(), view_speeds().end(), 1.0) -
                                      view_speeds().begin())) {
  settings.set(ViewFlag::push_force, true);
}

double Interaction::speed() const { return view_speeds()[speed_]; }
bool Interaction::take_screenshot() { return std::exchange(screenshot_wanted_, false); }
std::vector<ViewEvent> Interaction::take_events() { return std::exchange(events_, {}); }
std::optional<std::string> Interaction::take_said() { return std::exchange(said_, {}); }

PicturePoint Interaction::point_of(const RawInput& input) const {
  const mjrRect& view = panels_.view();
  const double width = std::max(view.width, 1);
  const double height = std::max(view.height, 1);
  return {(input.x - view.left) / width, (input.y - view.bottom) / height, width / height};
}

/// MuJoCo's user interface reads the mouse from there.
void Interaction::copy_to_state(const RawInput& input) {
  mjuiState& state = panels_.state();
  state.dx = input.x - state.x;
  state.dy = input.y - state.y;
  state.x = input.x;
  state.y = input.y;
  state.control = input.control ? 1 : 0;
  state.shift = input.shift ? 1 : 0;
  state.mouserect =
      mjr_findRect(static_cast<int>(std::lround(input.x)), static_cast<int>(std::lround(input.y)),
                   state.nrect - 1, state.rect + 1) +
      1;
}

void Interaction::handle(const RawInput& input, const mjrContext& context) {
  copy_to_state(input);
  mjuiState& state = panels_.state();
  switch (input.kind) {
    case RawInput::Kind::press:
      press(input, context);
      break;
    case RawInput::Kind::release:
      release(input, context);
      break;
    case RawInput::Kind::move:
      state.type = mjEVENT_MOVE;
      move(state.dx, state.dy, input, context);
      break;
    case RawInput::Kind::scroll:
      scroll(input, context);
      break;
    case RawInput::Kind::key:
      key(input);
      break;
  }
}

void Interaction::press(const RawInput& input, const mjrContext& context) {
  mjuiState& state = panels_.state();
  const int button = kButtons[input.button];
  state.type = mjEVENT_PRESS;
  state.doubleclick = button == state.button && input.time - state.buttontime < kDoubleClick;
  state.button = button;
  state.buttontime = input.time;
  (button == mjBUTTON_LEFT    ? state.left
   : button == mjBUTTON_RIGHT ? state.right
                              : state.middle) = 1;
  if (drag_ != Drag::none) return;  // a second button changes nothing
  drag_button_ = input.button;
  way_ = 0;
  state.dragrect = state.mouserect;
  state.dragbutton = button;
  if (panels_.owns_event()) {
    drag_ = Drag::panel;
    use_panel(context);
  } else if (use_hook(input)) {
    drag_ = Drag::hook;
  } else if (input.control && input.button != 2) {
    take_hold(input);
  } else {
    drag_ = Drag::camera;
    if (state.doubleclick != 0 && input.button == 0)
      events_.push_back(picker.select(point_of(input)));
  }
}

void Interaction::take_hold(const RawInput& input) {
  if (!may_.push) {
    say(text(msg::view_no_push));
  } else if (picker.take_hold(point_of(input), input.button == 0)) {
    drag_ = Drag::push;
  } else {
    say(text(msg::view_nothing_moves));
  }
}

void Interaction::move(double dx, double dy, const RawInput& input, const mjrContext& context) {
  way_ += std::hypot(dx, dy);
  const double height = std::max(panels_.view().height, 1);
  switch (drag_) {
    case Drag::none:
      (void)use_hook(input);
      break;
    case Drag::panel:
      use_panel(context);
      break;
    case Drag::hook:
      (void)use_hook(input);
      break;
    case Drag::push:
      picker.drag(dx / height, dy / height);
      break;
    case Drag::camera:
      if (drag_button_ == 0) {
        camera.turn(dx / height, dy / height);
      } else if (drag_button_ == 2 || way_ >= kClickWay) {
        camera.pan(dx / height, dy / height);
      }
      break;
  }
}

void Interaction::release(const RawInput& input, const mjrContext& context) {
  mjuiState& state = panels_.state();
  const int button = kButtons[input.button];
  state.type = mjEVENT_RELEASE;
  state.button = button;
  (button == mjBUTTON_LEFT    ? state.left
   : button == mjBUTTON_RIGHT ? state.right
                              : state.middle) = 0;
  if (input.button != drag_button_) return;
  if (drag_ == Drag::panel) use_panel(context);
  if (drag_ == Drag::hook) (void)use_hook(input);
  if (drag_ == Drag::push) {
    if (const auto released = picker.let_go()) events_.push_back(*released);
  }
  if (drag_ == Drag::camera && input.button == 1 && way_ < kClickWay) act(ViewAction::left_panel);
  drag_ = Drag::none;
  drag_button_ = -1;
  state.dragrect = state.dragbutton = 0;
}

void Interaction::scroll(const RawInput& input, const mjrContext& context) {
  mjuiState& state = panels_.state();
  state.type = mjEVENT_SCROLL;
  state.sx = 0;
  state.sy = input.notches;
  if (panels_.owns_event()) {
    use_panel(context);
  } else {
    camera.zoom(input.notches);
  }
}

void Interaction::use_panel(const mjrContext& context) {
  const auto asked = panels_.handle(settings, context);
  if (!asked) return;
  if (const auto* action = std::get_if<ViewAction>(&*asked)) {
    act(*action);
  } else {
    events_.push_back(std::get<ViewEvent>(*asked));
  }
}

bool Interaction::use_hook(const RawInput& input) {
  if (!hook_ || (drag_ == Drag::none && panels_.owns_event())) return false;
  const PicturePoint point = point_of(input);
  const Ray line = ray_of_share(eye_of(scene_), point.aspect, point.x, point.y);
  MouseInput::Kind kind = MouseInput::Kind::move;
  if (input.kind == RawInput::Kind::press) kind = MouseInput::Kind::press;
  if (input.kind == RawInput::Kind::release) kind = MouseInput::Kind::release;
  return hook_({.kind = kind,
                .button = input.button,
                .control = input.control,
                .shift = input.shift,
                .x = point.x,
                .y = point.y,
                .origin_W = line.origin_W,
                .direction_W = line.direction_W});
}

void Interaction::key(const RawInput& input) {
  if (const auto action = action_of(input.key, input.control, input.shift)) {
    act(*action);
    return;
  }
  if (input.control) return;
  if (input.key >= '0' && input.key < '0' + kViewGroups) {
    bool& group = (input.shift ? settings.site_groups
                               : settings.geom_groups)[static_cast<std::size_t>(input.key - '0')];
    group = !group;
    return;
  }
  for (const SettingRow& row : setting_rows()) {
    if (row.key == input.key) settings.set(row.flag, !settings.shows(row.flag));
  }
}

void Interaction::pause(bool paused) {
  if (paused_ == paused) return;
  paused_ = paused;
  events_.push_back(PauseEvent{paused});
}

void Interaction::change_speed(int by) {
  const auto last = static_cast<int>(view_speeds().size()) - 1;
  const auto next = static_cast<std::size_t>(std::clamp(static_cast<int>(speed_) + by, 0, last));
  if (next == speed_) return;
  speed_ = next;
  events_.push_back(SpeedEvent{speed()});
}

void Interaction::act(ViewAction action) {
  switch (action) {
    case ViewAction::pause:
      return pause(!paused_);
    case ViewAction::step:
    case ViewAction::step_back:
      if (!may_.step) return say(text(msg::view_no_step));
      pause(true);
      events_.push_back(StepEvent{action == ViewAction::step ? 1 : -1});
      return;
    case ViewAction::faster:
      return change_speed(1);
    case ViewAction::slower:
      return change_speed(-1);
    case ViewAction::reset:
      if (!may_.reset) return say(text(msg::view_no_reset));
      events_.push_back(ResetEvent{});
      return;
    case ViewAction::first_view:
      return camera.to_first_view();
    case ViewAction::next_camera:
      return camera.cycle(1);
    case ViewAction::previous_camera:
      return camera.cycle(-1);
    case ViewAction::left_panel:
      return panels_.toggle_left();
    case ViewAction::right_panel:
      return panels_.toggle_right();
    case ViewAction::next_frame:
      settings.frame = (settings.frame + 1) % static_cast<int>(view_frame_names().size());
      return;
    case ViewAction::next_label:
      settings.label = (settings.label + 1) % static_cast<int>(view_label_names().size());
      return;
    case ViewAction::target:
      if (!may_.target) return say(text(msg::view_no_target));
      events_.emplace_back(TargetEvent{});
      return;
    case ViewAction::screenshot:
      screenshot_wanted_ = true;
      return;
    case ViewAction::help:
      help_shown_ = !help_shown_;
      return;
    case ViewAction::close:
      close_wanted_ = true;
      return;
  }
}

void Interaction::update() {
  if (const auto push = picker.push()) events_.push_back(*push);
}

}  // namespace mjarm::view
