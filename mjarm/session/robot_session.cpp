#include "mjarm/session/robot_session.hpp"

namespace mjarm::session {

RobotSession::RobotSession(const Model& model, const std::optional<Arm>& arm, FreeSim& sim)
    : sim_(sim) {
  if (!arm) return;
  if (sim.is_held()) target_.emplace(model, *arm, sim);
  show_.emplace(model, *arm);
}

void RobotSession::handle(const view::ViewEvent& event) {
  if (const auto* used = std::get_if<view::PanelEvent>(&event)) {
    if (target_ && target_->handle(*used)) return;
    if (show_) (void)show_->handle(*used);
    return;
  }
  if (std::holds_alternative<view::TargetEvent>(event)) {
    if (target_) target_->toggle();
    return;
  }
  sim_.handle(event);
  const bool anew = std::holds_alternative<view::ResetEvent>(event);
  if (anew && show_) show_->clear();
  if (!target_) return;
  if (anew) target_->restart();
  target_->follow_sim();
}

bool RobotSession::take_drags() { return target_ && target_->take_drags(); }

void RobotSession::step() {
  sim_.step();
  if (show_) show_->add(sim_);
  if (target_) target_->follow_sim();
}

void RobotSession::fill(view::ViewFrame& frame) {
  frame.snapshot = sim_.sim().snapshot();
  frame.overlay = {};
  frame.panels.clear();
  if (target_) {
    target_->add_sections(frame.panels);
    target_->add_ghost(frame.overlay, show_ && show_->wants_ghost());
    target_->post_look();
  }
  if (show_) {
    show_->add_sections(frame.panels);
    show_->add_overlay(frame.overlay, sim_);
    frame.plots = show_->plots();
  }
  frame.status = sim_.status();
  if (frame.status.empty()) frame.status = render::overlay_notice(frame.overlay);
  if (frame.status.empty() && target_) frame.status = target_->line();
}

}  // namespace mjarm::session
