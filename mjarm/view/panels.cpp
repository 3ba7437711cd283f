#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string>

#include "mjarm/core/messages/view.hpp"
#include "mjarm/view/panels_internal.hpp"

namespace mjarm::view {
namespace {

/// Numbers of the items of the left panel; those of settings follow each other.
enum Item {
  kActionItems = 0,
  kFlagItems = 100,
  kGeomGroupItems = 200,
  kSiteGroupItems = 210,
  kLabelItem = 220,
  kFrameItem = 221,
  kTextItem = 230,
};

PanelItem button(ViewAction action, std::string name, bool enabled = true) {
  return {kActionItems + static_cast<int>(action), std::move(name), PanelButton{}, enabled};
}

/// MuJoCo's words for kinds of objects, in the language in use.
std::vector<std::string> words(std::span<const char* const> names) {
  static constexpr Msg kKinds[] = {
      msg::view_kind_none,       msg::view_kind_body,           msg::view_kind_joint,
      msg::view_kind_geom,       msg::view_kind_site,           msg::view_kind_camera,
      msg::view_kind_light,      msg::view_kind_tendon,         msg::view_kind_actuator,
      msg::view_kind_constraint, msg::view_kind_flex,           msg::view_kind_skin,
      msg::view_kind_selection,  msg::view_kind_selected_point, msg::view_kind_contact,
      msg::view_kind_island,     msg::view_kind_contact_force,  msg::view_kind_world};
  std::vector<std::string> out;
  for (const char* name : names) {
    const auto* known = std::ranges::find(
        kKinds, std::string_view(name), [](const Msg& kind) { return kind.in(Language::english); });
    out.push_back(known != std::end(kKinds) ? text(*known) : name);
  }
  return out;
}

/// Without the digits of a zero that is almost one.
double shown(double value) { return std::round(1e4 * value) / 1e4 + 0.0; }

}  // namespace

Panels::Panels(const mjModel& m, std::vector<int> jog_dofs, bool can_step, bool can_reset)
    : can_step_(can_step), can_reset_(can_reset) {
  for (int i = 0; i < m.njnt; ++i) {
    if (m.jnt_type[i] != mjJNT_HINGE && m.jnt_type[i] != mjJNT_SLIDE) continue;
    const bool hinge = m.jnt_type[i] == mjJNT_HINGE;
    const double max = hinge ? std::numbers::pi : 1;
    const bool limited = m.jnt_limited[i] != 0;
    const char* name = mj_id2name(&m, mjOBJ_JOINT, i);
    const int dof = m.jnt_dofadr[i];
    joints_.push_back({.dof = dof,
                       .qpos = m.jnt_qposadr[i],
                       .name = name != nullptr ? name : "joint " + std::to_string(i),
                       .lower = limited ? m.jnt_range[2 * i] : -max,
                       .upper = limited ? m.jnt_range[2 * i + 1] : max,
                       .live = std::find(jog_dofs.begin(), jog_dofs.end(), dof) != jog_dofs.end()});
  }
  if (joints_.size() > mjMAXUIITEM / 2) joints_.resize(mjMAXUIITEM / 2);
}

void Panels::resize(int width, int height) {
  state_.rect[0] = {0, 0, width, height};
  layout();
}

void Panels::layout() {
  const mjrRect& whole = state_.rect[0];
  const int left = left_shown_ ? std::min(left_.width(), whole.width) : 0;
  const int right = right_shown_ ? std::min(right_.width(), whole.width - left) : 0;
  state_.nrect = 4;
  state_.rect[1] = {0, 0, left, whole.height};
  state_.rect[2] = {whole.width - right, 0, right, whole.height};
  state_.rect[3] = {left, 0, whole.width - left - right, whole.height};
}

void Panels::toggle_left() { left_shown_ = !left_shown_; }
void Panels::toggle_right() { right_shown_ = !right_shown_; }

std::vector<PanelSection> Panels::left_sections(const ViewSettings& settings,
                                                const PanelFacts& facts) const {
  PanelSection simulation{
      text(msg::view_simulation),
      {{kActionItems + static_cast<int>(ViewAction::pause), text(msg::view_item_pause),
        PanelCheckbox{facts.paused}},
       {kTextItem, text(msg::view_speed), PanelText{text(msg::view_speed_value, facts.speed)}},
       button(ViewAction::step_back, text(msg::view_item_step_back), can_step_),
       button(ViewAction::step, text(msg::view_item_step), can_step_),
       button(ViewAction::slower, text(msg::view_item_slower)),
       button(ViewAction::faster, text(msg::view_item_faster)),
       button(ViewAction::reset, text(msg::view_item_reset), can_reset_),
       button(ViewAction::first_view, text(msg::view_item_first_view)),
       button(ViewAction::screenshot, text(msg::view_item_screenshot)),
       button(ViewAction::help, text(msg::view_item_help))}};
  PanelSection flags{text(msg::view_settings), {}};
  flags.items = {{kLabelItem, text(msg::view_item_labels),
                  PanelChoice{words(view_label_names()), settings.label}},
                 {kFrameItem, text(msg::view_item_frames),
                  PanelChoice{words(view_frame_names()), settings.frame}}};
  for (const SettingRow& row : setting_rows()) {
    flags.items.push_back({kFlagItems + static_cast<int>(row.flag), text(row.label),
                           PanelCheckbox{settings.shows(row.flag)}});
  }
  PanelSection groups{text(msg::view_groups), {}};
  for (int i = 0; i < kViewGroups; ++i) {
    const auto group = static_cast<std::size_t>(i);
    groups.items.push_back({kGeomGroupItems + i, text(msg::view_item_geom_group, i),
                            PanelCheckbox{settings.geom_groups[group]}});
    groups.items.push_back({kSiteGroupItems + i, text(msg::view_item_site_group, i),
                            PanelCheckbox{settings.site_groups[group]}});
  }
  return {std::move(simulation), std::move(flags), std::move(groups)};
}

PanelSection Panels::joint_section(const PanelFacts& facts) const {
  PanelSection section{text(msg::view_joints), {}, joints_open_};
  for (const Joint& joint : joints_) {
    section.items.push_back({joint.dof, joint.name,
                             PanelText{text(msg::view_range, joint.lower, joint.upper)},
                             joint.live});
    section.items.push_back(
        {joint.dof, "", PanelSlider{shown(facts.d->qpos[joint.qpos]), joint.lower, joint.upper},
         joint.live});
  }
  return section;
}

void Panels::show(const ViewSettings& settings, const PanelFacts& facts,
                  std::span<const PanelSection> sections, mjrContext& context) {
  if (left_shown_) left_.show(left_sections(settings, facts), state_, context);
  if (right_shown_) {
    right_sections_ = {joint_section(facts)};
    right_sections_.insert(right_sections_.end(), sections.begin(), sections.end());
    right_.show(right_sections_, state_, context);
  }
  layout();
}

void Panels::render(const mjrContext& context, GlyphFont& font) {
  if (left_shown_) left_.render(state_, context, font);
  if (right_shown_) right_.render(state_, context, font);
}

bool Panels::owns_event() const {
  const int rect = state_.dragrect != 0 ? state_.dragrect : state_.mouserect;
  return rect == 1 || rect == 2;
}

std::optional<std::variant<ViewAction, ViewEvent>> Panels::handle(ViewSettings& settings,
                                                                  const mjrContext& context) {
  const int rect = state_.dragrect != 0 ? state_.dragrect : state_.mouserect;
  const std::optional<UiChange> change = (rect == 1 ? left_ : right_).handle(state_, context);
  if (!change) return {};
  if (rect == 2) {
    const PanelItem& item = right_sections_[static_cast<std::size_t>(change->section)]
                                .items[static_cast<std::size_t>(change->item)];
    if (change->section > 0) return PanelEvent{item.id, change->value};
    const Joint& joint = joints_[static_cast<std::size_t>(change->item / 2)];
    return JointEvent{joint.dof, joint.name, change->value};
  }
  const PanelItem item = left_sections(settings, {})[static_cast<std::size_t>(change->section)]
                             .items[static_cast<std::size_t>(change->item)];
  const bool on = change->value != 0;
  if (item.id == kLabelItem) {
    settings.label = static_cast<int>(change->value);
  } else if (item.id == kFrameItem) {
    settings.frame = static_cast<int>(change->value);
  } else if (item.id >= kSiteGroupItems) {
    settings.site_groups[static_cast<std::size_t>(item.id - kSiteGroupItems)] = on;
  } else if (item.id >= kGeomGroupItems) {
    settings.geom_groups[static_cast<std::size_t>(item.id - kGeomGroupItems)] = on;
  } else if (item.id >= kFlagItems) {
    settings.set(static_cast<ViewFlag>(item.id - kFlagItems), on);
  } else {
    return static_cast<ViewAction>(item.id - kActionItems);
  }
  return {};
}

std::optional<mjrRect> Panels::place(bool left, int section, int item) const {
  if (left ? !left_shown_ : !right_shown_) return {};
  return (left ? left_ : right_).place(section, item, state_);
}

}  // namespace mjarm::view
