#include "mjarm/serve/page_messages.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>

#include "mjarm/core/json.hpp"
#include "mjarm/core/messages/serve.hpp"

namespace mjarm::serve {
namespace {

using Eigen::Vector3d;
constexpr double kMaxDragNumber = 9007199254740992;  // whole numbers of a page are exact below it
constexpr int kMaxWhole = 2'000'000'000;

/// Reads the members of one message; the first fault is kept, and all after it yields zeros.
class Reader {
 public:
  Reader(const JsonValue& object, std::initializer_list<std::string_view> members)
      : object_(object) {
    for (const std::string_view name : members) {
      if (!object.contains(name)) refuse(text(msg::serve_missing, name));
    }
    if (!error_ && object.size() != members.size() + 1) {
      for (const JsonValue& member : object) {
        if (member.key() != "type" && std::ranges::find(members, member.key()) == members.end()) {
          refuse(text(msg::serve_not_known, std::string(member.key())));
        }
      }
    }
  }

  void refuse(std::string why) {
    if (!error_) error_ = std::move(why);
  }
  void refuse_unless(bool allowed, const char* what) {
    if (!allowed) refuse(text(msg::serve_not_here, what));
  }

  bool boolean(std::string_view name) {
    const JsonValue* value = object_.find(name);
    if (value == nullptr || !value->is_boolean()) refuse(text(msg::serve_no_boolean, name));
    return value != nullptr && value->boolean();
  }
  /// Finite and within bounds.
  double number(std::string_view name, double lower = -kMaxPageNumber,
                double upper = kMaxPageNumber) {
    const JsonValue* value = object_.find(name);
    if (value == nullptr || !value->is_number()) {
      refuse(text(msg::serve_no_number, name));
      return 0;
    }
    return within(name, value->number(), lower, upper);
  }
  int whole(std::string_view name, int lower, int upper) {
    const double value = number(name, lower, upper);
    if (value != std::floor(value)) refuse(text(msg::serve_not_whole, name));
    return error_ ? 0 : static_cast<int>(value);
  }
  Vector3d vector(std::string_view name) {
    const Result<std::vector<double>> values = number_list(object_, name, 3);
    if (!values) {
      refuse(values.error().what);
      return Vector3d::Zero();
    }
    for (const double value : *values) (void)within(name, value, -kMaxPageNumber, kMaxPageNumber);
    return {(*values)[0], (*values)[1], (*values)[2]};
  }
  Pose pose() {
    const Result<Pose> X = mjarm::pose_of(object_);
    if (!X) {
      refuse(X.error().what);
      return {};
    }
    for (const double value : X->p) (void)within("pos", value, -kMaxPageNumber, kMaxPageNumber);
    return *X;
  }

  /// `message`, unless something was wrong.
  template <class Message>
  Result<PageMessage> give(Message message) {
    if (error_) return fail(Errc::bad_input, std::move(*error_));
    return PageMessage(std::move(message));
  }

 private:
  double within(std::string_view name, double value, double lower, double upper) {
    if (std::isfinite(value) && value >= lower && value <= upper) return value;
    refuse(text(msg::serve_out_of_range, name, lower, upper));
    return 0;
  }

  const JsonValue& object_;
  std::optional<std::string> error_ = {};
};

int last_body(const PageScene& scene) { return static_cast<int>(scene.model.bodies.size()) - 1; }

Result<PageMessage> read_pause(const JsonValue& object, const PageScene&) {
  Reader in(object, {"paused"});
  const view::PauseEvent event{in.boolean("paused")};
  return in.give(view::ViewEvent(event));
}

Result<PageMessage> read_step(const JsonValue& object, const PageScene& scene) {
  Reader in(object, {"steps"});
  in.refuse_unless(scene.facts.can_step, "step");
  const view::StepEvent event{in.whole("steps", -kMaxPageSteps, kMaxPageSteps)};
  return in.give(view::ViewEvent(event));
}

Result<PageMessage> read_speed(const JsonValue& object, const PageScene&) {
  Reader in(object, {"speed"});
  const view::SpeedEvent event{in.number("speed", 0.01, 100)};
  return in.give(view::ViewEvent(event));
}

Result<PageMessage> read_reset(const JsonValue& object, const PageScene& scene) {
  Reader in(object, {});
  in.refuse_unless(scene.facts.can_reset, "reset");
  return in.give(view::ViewEvent(view::ResetEvent{}));
}

/// The page pulls at a point; what acts is that force at the centre of mass, and its torque.
Result<PageMessage> read_push(const JsonValue& object, const PageScene& scene) {
  Reader in(object, {"body", "point", "force"});
  in.refuse_unless(scene.facts.can_push, "push");
  view::PushEvent event;
  event.body = in.whole("body", 1, last_body(scene));
  const DrawnBody& body = scene.model.bodies[static_cast<std::size_t>(event.body)];
  event.name = body.name;
  event.point_W = in.vector("point");
  event.force_W = in.vector("force");
  const Vector3d arm_W = event.point_W - scene.poses.pose(event.body) * body.p_BC;
  event.torque_W = arm_W.cross(event.force_W);
  if (!body.moves) in.refuse(text(msg::serve_body_stands, body.name));
  return in.give(view::ViewEvent(std::move(event)));
}

Result<PageMessage> read_release(const JsonValue& object, const PageScene& scene) {
  Reader in(object, {"body"});
  const view::ReleaseEvent event{in.whole("body", -1, last_body(scene))};
  return in.give(view::ViewEvent(event));
}

Result<PageMessage> read_select(const JsonValue& object, const PageScene& scene) {
  Reader in(object, {"body", "geom", "point"});
  view::SelectEvent event;
  event.body = in.whole("body", -1, last_body(scene));
  const int place = in.whole("geom", -1, static_cast<int>(scene.model.geoms.size()) - 1);
  event.point_W = in.vector("point");
  if (event.body >= 0) {
    event.body_name = scene.model.bodies[static_cast<std::size_t>(event.body)].name;
  }
  if (place >= 0 && place < static_cast<int>(scene.model.geoms.size())) {
    const DrawnGeom& geom = scene.model.geoms[static_cast<std::size_t>(place)];
    if (geom.body != event.body) in.refuse(text(msg::serve_other_body, place));
    event.geom = geom.id;
    event.geom_name = geom.name.empty() ? event.body_name : geom.name;
  }
  return in.give(view::ViewEvent(std::move(event)));
}

Result<PageMessage> read_joint(const JsonValue& object, const PageScene& scene) {
  Reader in(object, {"dof", "value"});
  view::JointEvent event;
  event.dof = in.whole("dof", 0, kMaxWhole);
  event.value = in.number("value");
  const std::vector<DrawnJoint> joints = slider_joints(scene.model, scene.facts);
  const auto joint = std::ranges::find(joints, event.dof, &DrawnJoint::dof);
  if (joint == joints.end()) {
    in.refuse(text(msg::serve_no_slider, event.dof));
  } else {
    event.joint = joint->name;
    event.value = std::clamp(event.value, joint->lower, joint->upper);
  }
  return in.give(view::ViewEvent(std::move(event)));
}

/// The value of an item within its range: those who handle it count on that.
struct ItemRange {
  double lower = 0;
  double upper = 0;
  bool whole = true;
  bool clamps = false;  ///< else beyond is an error
};

struct RangeOf {
  std::optional<ItemRange> operator()(const view::PanelButton&) const { return ItemRange{1, 1}; }
  std::optional<ItemRange> operator()(const view::PanelCheckbox&) const { return ItemRange{0, 1}; }
  std::optional<ItemRange> operator()(const view::PanelSlider& slider) const {
    return ItemRange{slider.lower, std::max(slider.lower, slider.upper), false, true};
  }
  std::optional<ItemRange> operator()(const view::PanelText&) const { return std::nullopt; }
  std::optional<ItemRange> operator()(const view::PanelChoice& choice) const {
    return ItemRange{0, static_cast<double>(choice.words.size()) - 1};
  }
  std::optional<ItemRange> operator()(const view::PanelList& list) const {
    return ItemRange{0, static_cast<double>(list.lines.size()) - 1};
  }
  std::optional<ItemRange> operator()(const view::PanelTimeline& line) const {
    return ItemRange{0, std::max(0.0, line.end), false, true};
  }
};

/// Several items may have one number, as a text beside a slider; the one that takes values counts.
const view::PanelItem* find_item(std::span<const view::PanelSection> sections, int id) {
  const view::PanelItem* found = nullptr;
  for (const view::PanelSection& section : sections) {
    for (const view::PanelItem& item : section.items) {
      if (item.id != id) continue;
      if (!std::holds_alternative<view::PanelText>(item.what)) return &item;
      found = &item;
    }
  }
  return found;
}

Result<PageMessage> read_panel(const JsonValue& object, const PageScene& scene) {
  Reader in(object, {"id", "value"});
  view::PanelEvent event;
  event.id = in.whole("id", -kMaxWhole, kMaxWhole);
  event.value = in.number("value", -1e15, 1e15);
  const view::PanelItem* item = find_item(scene.panels, event.id);
  const std::optional<ItemRange> range =
      item == nullptr ? std::nullopt : std::visit(RangeOf{}, item->what);
  if (!range) {
    in.refuse(text(msg::serve_no_item, event.id));
    return in.give(std::monostate{});
  }
  const bool is_in = event.value >= range->lower && event.value <= range->upper;
  if (range->clamps) {
    event.value = std::clamp(event.value, range->lower, range->upper);
  } else if (!is_in || (range->whole && event.value != std::floor(event.value))) {
    in.refuse(text(msg::serve_out_of_range, "value", range->lower, range->upper));
  }
  if (!item->enabled) return in.give(std::monostate{});
  return in.give(view::ViewEvent(event));
}

Result<PageMessage> read_target(const JsonValue& object, const PageScene& scene) {
  Reader in(object, {});
  in.refuse_unless(scene.facts.can_target, "target");
  return in.give(view::ViewEvent(view::TargetEvent{}));
}

Result<PageMessage> read_drag(const JsonValue& object, const PageScene& scene) {
  Reader in(object, {"pos", "quat", "held", "number"});
  in.refuse_unless(scene.facts.can_target, "drag");
  view::TargetDrag drag;
  drag.X_WT = in.pose();
  drag.held = in.boolean("held");
  const double number = in.number("number", 0, kMaxDragNumber);
  if (number != std::floor(number)) in.refuse(text(msg::serve_not_whole, "number"));
  drag.number = static_cast<long>(number);
  return in.give(drag);
}

Result<PageMessage> read_lead(const JsonValue& object, const PageScene& scene) {
  Reader in(object, {"linear", "angular", "grip"});
  in.refuse_unless(scene.facts.can_lead, "lead");
  view::LeadEvent event;
  event.linear = in.vector("linear").cwiseMax(-1).cwiseMin(1);
  event.angular = in.vector("angular").cwiseMax(-1).cwiseMin(1);
  event.grip = in.number("grip", -1, 1);
  return in.give(view::ViewEvent(event));
}

using Read = Result<PageMessage> (*)(const JsonValue&, const PageScene&);
constexpr std::pair<std::string_view, Read> kTypes[] = {
    {"pause", read_pause},   {"step", read_step},   {"speed", read_speed},
    {"reset", read_reset},   {"push", read_push},   {"release", read_release},
    {"select", read_select}, {"joint", read_joint}, {"panel", read_panel},
    {"target", read_target}, {"drag", read_drag},   {"lead", read_lead},
};

}  // namespace

Result<PageMessage> read_page_message(std::string_view text_of_page, const PageScene& scene) {
  const Result<JsonObject, JsonFailure> object = JsonObject::parse(
      text_of_page, {.depth = 3, .values = 64, .bytes = kMaxPageMessage, .unique_keys = true});
  if (!object) return fail(Errc::bad_input, describe(object.error()));
  const JsonValue* type = (*object)->find("type");
  if (type == nullptr || !type->is_string()) {
    return fail(Errc::bad_input, text(msg::serve_missing, "type"));
  }
  const std::string word = type->string();
  const auto known = std::ranges::find(kTypes, word, &std::pair<std::string_view, Read>::first);
  if (known == std::end(kTypes)) {
    return fail(Errc::bad_input, text(msg::serve_bad_type, word.substr(0, 40)));
  }
  return known->second(**object, scene);
}

}  // namespace mjarm::serve
