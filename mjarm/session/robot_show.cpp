#include "mjarm/session/robot_show.hpp"

#include <algorithm>
#include <cstddef>

#include "mjarm/core/messages/panels.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/manipulability_ellipsoid.hpp"
#include "mjarm/render/overlay_shapes.hpp"

namespace mjarm::session {
namespace {

/// Numbers of the items; those of the figures follow each other.
enum ShowItem {
  kGhostItem = 2000,
  kEllipsoidItem,
  kContactItem,
  kNearestItem,
  kTrailItem,
  kFigureItem = 2100
};

constexpr double kNearestWithin = 0.5;  ///< [m]
constexpr double kNearestRed = 0.02;    ///< [m]

}  // namespace

RobotShow::RobotShow(const Model& model, const Arm& arm)
    : arm_(arm), checker_(model, arm, {.margin = kNearestWithin}), figures_(arm, kFigureItem) {}

bool RobotShow::handle(const view::PanelEvent& event) {
  const bool on = event.value != 0;
  if (event.id == kGhostItem) {
    ghost_ = on;
  } else if (event.id == kEllipsoidItem) {
    ellipsoid_ = on;
  } else if (event.id == kContactItem) {
    contacts_ = on;
  } else if (event.id == kNearestItem) {
    nearest_ = on;
  } else if (event.id == kTrailItem) {
    trail_look_ = std::clamp(static_cast<int>(event.value), 0, 2);
    trail_.set_balls(trail_look_ == 2);
  } else {
    return figures_.handle(event);
  }
  return true;
}

void RobotShow::clear() {
  trail_.clear();
  figures_.clear();
}

void RobotShow::add(const FreeSim& sim) {
  figures_.add(sim.sim(), sim.sim().time(), arm_, sim.is_held() ? sim.reference() : JointVec());
  trail_.add(sim.sim().tool(arm_).p);
}

void RobotShow::add_sections(std::vector<view::PanelSection>& sections) const {
  sections.push_back(
      {text(msg::panel_show),
       {{kGhostItem, text(msg::panel_ghost), view::PanelCheckbox{ghost_}},
        {kEllipsoidItem, text(msg::panel_ellipsoid), view::PanelCheckbox{ellipsoid_}},
        {kContactItem, text(msg::panel_contacts), view::PanelCheckbox{contacts_}},
        {kNearestItem, text(msg::panel_closest_pair), view::PanelCheckbox{nearest_}},
        {kTrailItem, text(msg::panel_trail),
         view::PanelChoice{{text(msg::panel_off), text(msg::panel_line), text(msg::panel_balls)},
                           trail_look_}}}});
  sections.push_back(figures_.section());
}

void RobotShow::add_contact(render::Overlay& overlay, const JointVec& q) {
  const Result<CollisionReport> report = checker_.check(as_span(q));
  if (!report) return;
  if (contacts_) {
    std::vector<render::ContactMark> marks;
    for (const ContactPoint& contact : report->contacts) marks.push_back({contact.point_W, {}});
    render::add_contacts(overlay, marks);
  }
  if (nearest_ && report->nearest) {
    const NearestPair& pair = *report->nearest;
    render::add_closest_pair(overlay, pair.p1_W, pair.p2_W, pair.distance, kNearestRed);
  }
}

void RobotShow::add_overlay(render::Overlay& overlay, const FreeSim& sim) {
  if (trail_look_ != 0) trail_.draw(overlay);
  if (!ellipsoid_ && !contacts_ && !nearest_) return;
  const JointVec q = sim.sim().arm_state(arm_).q;
  if (contacts_ || nearest_) add_contact(overlay, q);
  if (ellipsoid_) {
    const VelocityEllipsoid ellipsoid = manipulability_ellipsoid(arm_, as_span(q));
    render::add_velocity_ellipsoid(overlay, sim.sim().tool(arm_).p, ellipsoid.R_WE,
                                   ellipsoid.semi_axes);
  }
}

}  // namespace mjarm::session
