#include "mjarm/session/target_control.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/panels.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/kinematics/branch.hpp"
#include "mjarm/render/overlay_shapes.hpp"

namespace mjarm::session {
namespace {

/// Numbers of the items; those of the jog buttons follow each other.
enum TargetItem {
  kShownItem = 1000,
  kFollowItem,
  kGoItem,
  kBackItem,
  kFrameItem,
  kMoveItem,
  kTurnItem,
  kTextItem,
  kPosturesItem,
  kPostureItem,     ///< of them, by its place
  kJogItem = 1100,  ///< - x, + x, - y, ... + rz
};

constexpr double kMoveSteps[] = {0.001, 0.01, 0.05};  ///< [m]
constexpr double kTurnSteps[] = {1, 5, 15};           ///< [deg]
constexpr const char* kJogAxes[] = {"x", "y", "z", "rx", "ry", "rz"};
constexpr double kSamePosture = 1e-3;  // [rad or m]
constexpr float kGhostAlpha = 0.3F;
constexpr render::Rgba kPosture = {0.35F, 0.50F, 0.85F, 0.16F};
constexpr int kMaxShownPostures =
    static_cast<int>(render::kMaxGhosts) - 1;  // beside that of the goal

Msg word_of(TargetGrade grade) {
  switch (grade) {
    case TargetGrade::good:
      return msg::panel_reachable;
    case TargetGrade::near_limit:
      return msg::panel_near_limit;
    case TargetGrade::near_singular:
      return msg::panel_singular;
    case TargetGrade::jump:
      return msg::panel_by_jump;
    case TargetGrade::unreachable:
      break;
  }
  return msg::panel_unreachable;
}

/// Without a minus before a zero; a panel has room for 14 characters.
std::string pair_of(double length, double angle) {
  const auto shown = [](double value) { return std::round(10 * value) / 10 + 0.0; };
  char line[48];
  std::snprintf(line, sizeof(line), "%.1f %.1f", shown(1e3 * length), shown(angle / kRadPerDeg));
  return line;
}

/// Which way an arm is bent, in the words of the command line; empty where that is not known.
std::string bend(const IkSolver& ik, const JointVec& q) {
  const Branch branch = branch_of(ik, as_span(q));
  std::string out;
  for (int part = 0; part < Branch::kParts; ++part) {
    const auto place = static_cast<std::size_t>(part);
    if (branch.way[place] < 0) continue;
    if (!out.empty()) out += text(msg::core_comma);
    out += std::string(branch_parts()[place]) + " " +
           std::string(branch_ways(part)[static_cast<std::size_t>(branch.way[place])]);
  }
  return out;
}

}  // namespace

render::Rgba color_of(TargetGrade grade) noexcept {
  if (grade == TargetGrade::good) return {0.20F, 0.75F, 0.30F, 1};
  if (grade == TargetGrade::unreachable) return {0.90F, 0.15F, 0.12F, 1};
  return {0.98F, 0.65F, 0.08F, 1};
}

TargetControl::TargetControl(const Model& model, const Arm& arm, FreeSim& sim)
    : sim_(sim), target_(model, arm) {
  restart();
}

void TargetControl::restart() {
  sent_ = sim_.goal();
  target_.set_goal(sent_);
  find_postures();
}

void TargetControl::find_postures() {
  postures_.clear();
  if (shows_postures_ && shown_) postures_ = target_.postures(kMaxShownPostures + 1);
}

void TargetControl::follow_sim() {
  if (sim_.goal() != sent_) restart();
}

void TargetControl::send() {
  sim_.set_goal(target_.goal());
  sent_ = sim_.goal();
}

void TargetControl::changed() {
  find_postures();
  if (follow_) send();
}

void TargetControl::toggle() {
  shown_ = !shown_;
  held_ = false;
  shown_ ? restart() : find_postures();
}

bool TargetControl::take_drags() {
  const std::vector<view::TargetDrag> drags = link_.drags.take();
  if (drags.empty()) return false;
  number_ = drags.back().number;
  held_ = drags.back().held && shown_;
  if (!shown_) return true;
  // Between two looks of the user the way is straight; what lies between does not count.
  target_.move_to(drags.back().X_WT);
  changed();
  return true;
}

void TargetControl::jog(int button) {
  const int axis = button / 2;
  const double step = axis < 3 ? kMoveSteps[move_step_] : kRadPerDeg * kTurnSteps[turn_step_];
  (void)target_.jog(static_cast<JogFrame>(frame_), axis, button % 2 == 0 ? -step : step);
  changed();
}

bool TargetControl::handle(const view::PanelEvent& event) {
  const int chosen = static_cast<int>(event.value);
  switch (event.id) {
    case kShownItem:
      toggle();
      return true;
    case kFollowItem:
      follow_ = event.value != 0;
      changed();
      return true;
    case kGoItem:
      target_.take_jump();
      send();
      return true;
    case kBackItem:
      restart();
      return true;
    case kPosturesItem:
      shows_postures_ = event.value != 0;
      find_postures();
      return true;
    case kPostureItem:
      if (chosen < 0 || chosen >= static_cast<int>(postures_.size())) return true;
      target_.take_posture(postures_[static_cast<std::size_t>(chosen)]);
      send();
      return true;
    case kFrameItem:
      frame_ = std::clamp(chosen, 0, 2);
      return true;
    case kMoveItem:
      move_step_ = std::clamp(chosen, 0, 2);
      return true;
    case kTurnItem:
      turn_step_ = std::clamp(chosen, 0, 2);
      return true;
    default:
      break;
  }
  const int buttons = target_.turns() ? 12 : 6;
  if (event.id < kJogItem || event.id >= kJogItem + buttons) return false;
  jog(event.id - kJogItem);
  return true;
}

void TargetControl::post_look() {
  view::TargetLook look{shown_, target_.pose(), {}, color_of(target_.grade()), number_};
  const auto frame = static_cast<JogFrame>(frame_);
  if (frame != JogFrame::tool) look.R_WG = target_.axes(frame);
  link_.looks.post(look);
}

view::PanelSection TargetControl::target_section() const {
  std::string room = text(msg::panel_none);
  std::string joint;
  if (std::isfinite(target_.room())) {
    const ArmJoint& nearest = target_.arm().joints[static_cast<std::size_t>(target_.tightest())];
    const char* unit = nearest.type == JointType::hinge ? "rad" : "m";
    char printed[32];
    std::snprintf(printed, sizeof(printed), "%.2f %s", target_.room(), unit);
    room = printed;
    joint = nearest.name;
  }
  char singular[32];
  std::snprintf(singular, sizeof(singular), "%.3f", target_.singular().smallest);
  return {text(msg::panel_target),
          {{kShownItem, text(msg::panel_target), view::PanelCheckbox{shown_}},
           {kFollowItem, text(msg::panel_follow), view::PanelCheckbox{follow_}},
           {kGoItem, text(msg::panel_go), view::PanelButton{}},
           {kBackItem, text(msg::panel_back), view::PanelButton{}},
           {kPosturesItem, text(msg::panel_postures), view::PanelCheckbox{shows_postures_}},
           {kTextItem, text(msg::panel_state), view::PanelText{text(word_of(target_.grade()))}},
           {kTextItem, text(msg::panel_room), view::PanelText{room}},
           {kTextItem, text(msg::panel_of_joint), view::PanelText{joint}},
           {kTextItem, text(msg::panel_singular_value), view::PanelText{singular}}}};
}

view::PanelSection TargetControl::posture_section() const {
  view::PanelList list{.lines = {}, .current = -1};
  for (std::size_t i = 0; i < postures_.size(); ++i) {
    if ((postures_[i] - target_.goal()).cwiseAbs().maxCoeff() < kSamePosture) {
      list.current = static_cast<int>(i);
    }
    list.lines.push_back(std::to_string(i + 1) + "  " + bend(target_.solver(), postures_[i]));
  }
  return {text(msg::panel_postures), {{kPostureItem, text(msg::panel_postures), std::move(list)}}};
}

view::PanelSection TargetControl::tool_section() const {
  view::PanelSection section{
      text(msg::panel_tool),
      {{kFrameItem, text(msg::panel_frame),
        view::PanelChoice{
            {text(msg::panel_world), text(msg::panel_tool_frame), text(msg::panel_base)}, frame_}},
       {kMoveItem, text(msg::panel_move_by),
        view::PanelChoice{{"1 mm", "10 mm", "50 mm"}, move_step_}}}};
  if (target_.turns()) {
    section.items.push_back(
        {kTurnItem, text(msg::panel_turn_by),
         view::PanelChoice{{text(msg::panel_degrees, 1), text(msg::panel_degrees, 5),
                            text(msg::panel_degrees, 15)},
                           turn_step_}});
  }
  for (int i = 0; i < (target_.turns() ? 12 : 6); ++i) {
    const std::string sign = i % 2 == 0 ? "- " : "+ ";
    section.items.push_back({kJogItem + i, sign + kJogAxes[i / 2], view::PanelButton{}});
  }
  const Pose& X_WT = target_.pose();
  const Eigen::Vector3d euler = to_euler(X_WT.R);
  for (int i = 0; i < 3; ++i) {
    const std::string name =
        std::string(kJogAxes[i]) + " [mm]" + text(msg::core_comma) + kJogAxes[3 + i] + " [deg]";
    section.items.push_back({kTextItem, name, view::PanelText{pair_of(X_WT.p[i], euler[i])}});
  }
  return section;
}

void TargetControl::add_sections(std::vector<view::PanelSection>& sections) const {
  sections.push_back(target_section());
  if (!postures_.empty()) sections.push_back(posture_section());
  sections.push_back(tool_section());
}

void TargetControl::add_ghost(render::Overlay& overlay, bool always) const {
  for (std::size_t i = 0; i < postures_.size(); ++i) {
    if ((postures_[i] - target_.goal()).cwiseAbs().maxCoeff() < kSamePosture) continue;
    render::OverlayGhost& posture =
        overlay.ghosts.emplace_back(render::ghost_of(target_.arm(), as_span(postures_[i])));
    posture.color = kPosture;
    posture.item = kPostureItem;
    posture.value = static_cast<double>(i);
  }
  const JointVec& q = target_.jump() ? *target_.jump() : target_.goal();
  const bool waits = shown_ && (q - sim_.goal()).cwiseAbs().maxCoeff() > 1e-9;
  if (!always && !held_ && !waits) return;
  render::OverlayGhost& ghost =
      overlay.ghosts.emplace_back(render::ghost_of(target_.arm(), as_span(q)));
  ghost.color = color_of(target_.grade());
  ghost.color.a = kGhostAlpha;
}

std::string TargetControl::line() const { return shown_ ? target_.line() : std::string(); }

}  // namespace mjarm::session
