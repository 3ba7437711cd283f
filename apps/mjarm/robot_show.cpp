#include "apps/mjarm/robot_show.hpp"

#include <algorithm>
#include <cstddef>

#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/manipulability_ellipsoid.hpp"
#include "mjarm/render/overlay_shapes.hpp"

namespace mjarm::app {
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

constexpr double kRowPeriod = 0.01;     ///< [s] simulated, of the figures
constexpr double kNearestWithin = 0.5;  ///< [m]
constexpr double kNearestRed = 0.02;    ///< [m]
constexpr const char* kFigures[] = {"Tool position", "Tracking error", "Joint error",
                                    "Joints",        "Torque",         "Manipulability"};

}  // namespace

RobotShow::RobotShow(const Model& model, const Arm& arm)
    : arm_(arm), checker_(model, arm, {.margin = kNearestWithin}), plots_(arm) {}

bool RobotShow::handle(const PanelEvent& event) {
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
  } else if (event.id >= kFigureItem && event.id < kFigureItem + 6) {
    figures_[static_cast<std::size_t>(event.id - kFigureItem)] = on;
  } else {
    return false;
  }
  return true;
}

void RobotShow::clear() {
  trail_.clear();
  plots_.clear();
  next_row_ = 0;
}

void RobotShow::add(const ViewSim& sim) {
  const double time = sim.sim().time();
  if (time < next_row_ && time > next_row_ - 2 * kRowPeriod) return;
  next_row_ = time + kRowPeriod;
  LiveRow row{.time = time,
              .q = sim.sim().arm_state(arm_).q,
              .X_WT = sim.sim().tool(arm_),
              .torque = sim.sim().arm_torque(arm_)};
  row.manipulability = manipulability(fk_jacobian(arm_, view(row.q)).J_W);
  row.X_ref = row.X_WT;
  if (sim.is_held()) {
    row.q_ref = sim.reference();
    row.X_ref = fk(arm_, view(row.q_ref));
  }
  plots_.add(row);
  trail_.add(row.X_WT.p);
}

void RobotShow::add_sections(std::vector<PanelSection>& sections) const {
  sections.push_back({"Show",
                      {{kGhostItem, "Ghost of goal", PanelCheckbox{ghost_}},
                       {kEllipsoidItem, "Ellipsoid", PanelCheckbox{ellipsoid_}},
                       {kContactItem, "Contacts", PanelCheckbox{contacts_}},
                       {kNearestItem, "Closest pair", PanelCheckbox{nearest_}},
                       {kTrailItem, "Trail", PanelChoice{{"off", "line", "balls"}, trail_look_}}}});
  PanelSection plots{"Plots", {}};
  for (std::size_t i = 0; i < figures_.size(); ++i) {
    plots.items.push_back(
        {kFigureItem + static_cast<int>(i), kFigures[i], PanelCheckbox{figures_[i]}});
  }
  sections.push_back(std::move(plots));
}

void RobotShow::add_contact(Overlay& overlay, const JointVec& q) {
  const Result<CollisionReport> report = checker_.check(view(q));
  if (!report) return;
  if (contacts_) {
    std::vector<ContactMark> marks;
    for (const ContactPoint& contact : report->contacts) marks.push_back({contact.point_W, {}});
    add_contacts(overlay, marks);
  }
  if (nearest_ && report->nearest) {
    const NearestPair& pair = *report->nearest;
    add_closest_pair(overlay, pair.p1_W, pair.p2_W, pair.distance, kNearestRed);
  }
}

void RobotShow::add_overlay(Overlay& overlay, const ViewSim& sim) {
  if (trail_look_ != 0) trail_.draw(overlay);
  if (!ellipsoid_ && !contacts_ && !nearest_) return;
  const JointVec q = sim.sim().arm_state(arm_).q;
  if (contacts_ || nearest_) add_contact(overlay, q);
  if (ellipsoid_) {
    const VelocityEllipsoid ellipsoid = manipulability_ellipsoid(arm_, view(q));
    add_velocity_ellipsoid(overlay, sim.sim().tool(arm_).p, ellipsoid.R_WE, ellipsoid.semi_axes);
  }
}

std::vector<LivePlot> RobotShow::plots() const {
  std::vector<LivePlot> out;
  for (std::size_t i = 0; i < figures_.size(); ++i) {
    if (figures_[i]) out.push_back(plots_.figure(static_cast<LiveFigure>(i)));
  }
  return out;
}

}  // namespace mjarm::app
