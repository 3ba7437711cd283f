#include "mjarm/session/arm_figures.hpp"

#include <utility>

#include "mjarm/core/messages/panels.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm::session {
namespace {

constexpr double kRowPeriod = 0.01;  ///< [s] of the figures' time
constexpr Msg kFigureNames[kLiveFigures] = {msg::panel_tool_position, msg::panel_tracking_error,
                                            msg::panel_joint_error,   msg::panel_joints,
                                            msg::panel_torque,        msg::panel_manipulability};

}  // namespace

ArmFigures::ArmFigures(const Arm& arm, int first_item, const Choice& shown)
    : plots_(arm), first_item_(first_item), shown_(shown) {}

bool ArmFigures::handle(const view::PanelEvent& event) {
  const int figure = event.id - first_item_;
  if (figure < 0 || figure >= static_cast<int>(kLiveFigures)) return false;
  shown_[static_cast<std::size_t>(figure)] = event.value != 0;
  return true;
}

view::PanelSection ArmFigures::section() const {
  view::PanelSection out{text(msg::panel_plots), {}};
  for (std::size_t i = 0; i < kLiveFigures; ++i) {
    out.items.push_back(
        {first_item_ + static_cast<int>(i), text(kFigureNames[i]), view::PanelCheckbox{shown_[i]}});
  }
  return out;
}

void ArmFigures::add(const Sim& sim, double time, const Arm& arm, const JointVec& q_ref) {
  // Time may have gone back, and then a row is due at once.
  if (time < next_row_ && time > next_row_ - 2 * kRowPeriod) return;
  next_row_ = time + kRowPeriod;
  view::LiveRow row{.time = time,
                    .q = sim.arm_state(arm).q,
                    .q_ref = q_ref,
                    .X_WT = sim.tool(arm),
                    .torque = sim.arm_torque(arm)};
  row.X_ref = q_ref.size() > 0 ? fk(arm, as_span(q_ref)) : row.X_WT;
  row.manipulability = manipulability(fk_jacobian(arm, as_span(row.q)).J_W);
  plots_.add(row);
}

void ArmFigures::clear() {
  plots_.clear();
  next_row_ = 0;
}

std::vector<view::LivePlot> ArmFigures::plots() const {
  std::vector<view::LivePlot> out;
  for (std::size_t i = 0; i < kLiveFigures; ++i) {
    if (shown_[i]) out.push_back(plots_.figure(static_cast<view::LiveFigure>(i)));
  }
  return out;
}

}  // namespace mjarm::session
