#include "mjarm/session/plan_player.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/panels.hpp"

namespace mjarm::session {
namespace {

constexpr double kPlanSpeed = 1;  // [rad/s or m/s, L2]

template <class... Values>
std::string plan_words(const char* format, Values... values) {
  char text[80];
  std::snprintf(text, sizeof(text), format, values...);
  return text;
}

view::PanelItem plan_checkbox(PlanItem item, Msg name, bool on) {
  return {item, text(name), view::PanelCheckbox{on}};
}

view::PanelItem plan_line(Msg name, std::string value) {
  return {kPlanText, text(name), view::PanelText{std::move(value)}};
}

}  // namespace

PlanPlayer::PlanPlayer(const PlanSubject& subject, PlanDrawing& drawing)
    : subject_(&subject),
      drawing_(&drawing),
      sim_(subject.model),
      playback_(subject.model.timestep()) {
  layers_.corners = false;  // with the arm on its way they are too many
}

void PlanPlayer::go(double ways) {
  const double length = drawing_->way().length();
  if (!(length > 0)) return;
  place_ += back_ ? -ways : ways;
  // It turns round at the ends.
  if (place_ > length) {
    place_ = std::max(2 * length - place_, 0.0);
    back_ = !back_;
  } else if (place_ < 0) {
    place_ = std::min(-place_, length);
    back_ = !back_;
  }
}

void PlanPlayer::step() { go(kPlanSpeed * subject_->model.timestep()); }

void PlanPlayer::press(const view::PanelEvent& event) {
  const bool on = event.value != 0;
  switch (event.id) {
    case kPlanTime:
      if (!std::isfinite(event.value)) return;
      place_ = std::clamp(event.value * kPlanSpeed, 0.0, drawing_->way().length());
      return;
    case kPlanTightest:
      place_ = drawing_->tightest();
      return;
    case kPlanSpheres:
      layers_.spheres = on;
      return;
    case kPlanPair:
      layers_.pair = on;
      return;
    case kPlanPath:
      layers_.path = on;
      return;
    case kPlanTree:
      layers_.tree = on;
      return;
    case kPlanEnds:
      layers_.ends = on;
      return;
    case kPlanCorners:
      layers_.corners = on;
      return;
    default:
      return;
  }
}

void PlanPlayer::handle(const view::ViewEvent& event) {
  if (const auto* panel = std::get_if<view::PanelEvent>(&event)) {
    press(*panel);
  } else if (std::holds_alternative<view::ResetEvent>(event)) {
    place_ = 0;
    back_ = false;
  } else if (const auto* steps = std::get_if<view::StepEvent>(&event);
             steps != nullptr && steps->steps < 0) {
    go(kPlanSpeed * subject_->model.timestep() * steps->steps);
  } else {
    (void)playback_.handle(event);
  }
}

std::vector<view::PanelSection> PlanPlayer::panels(const PlanLook& look) const {
  const PathWay& way = drawing_->way();
  const PlannedPath& path = subject_->path;
  const std::size_t edge = way.edge_at(place_), edges = path.q.size() - 1;
  view::PanelSection place{
      text(msg::panel_path),
      {{kPlanTime, "",
        view::PanelTimeline{place_ / kPlanSpeed, std::max(way.length() / kPlanSpeed, 1e-3)}},
       {kPlanTightest, text(msg::panel_tightest), view::PanelButton{}},
       plan_line(msg::panel_edge, text(msg::panel_edge_value, edge + 1, edges)),
       plan_line(msg::panel_way, plan_words("%.2f / %.2f", place_, way.length()))}};
  if (edge < path.proof.size()) {
    const EdgeCertificate& proof = path.proof[edge];
    // Of a model the certificate tells of spheres where these were enough.
    if (drawing_->has_spheres()) {
      place.items.push_back(
          plan_line(msg::panel_proved, text(msg::panel_mm, 1e3 * proof.nearest.distance)));
    } else if (edge < path.kept.size()) {
      place.items.push_back(
          plan_line(msg::panel_proved, text(msg::panel_mm, 1e3 * path.kept[edge])));
    }
    place.items.push_back(plan_line(msg::panel_intervals, plan_words("%.2g", proof.step)));
  }
  if (look.pair) {
    place.items.push_back(
        plan_line(msg::panel_closest_now, text(msg::panel_mm, 1e3 * look.pair->distance)));
  }
  if (look.obstacle_pair) {
    place.items.push_back(plan_line(msg::panel_to_obstacles,
                                    text(msg::panel_mm, 1e3 * look.obstacle_pair->distance)));
  }
  view::PanelSection layers{text(msg::panel_show),
                            {plan_checkbox(kPlanPair, msg::panel_closest_pair, layers_.pair),
                             plan_checkbox(kPlanPath, msg::panel_path, layers_.path),
                             plan_checkbox(kPlanTree, msg::panel_tree, layers_.tree),
                             plan_checkbox(kPlanEnds, msg::panel_ends, layers_.ends),
                             plan_checkbox(kPlanCorners, msg::panel_corners, layers_.corners)}};
  if (drawing_->has_spheres()) {
    layers.items.insert(layers.items.begin(),
                        plan_checkbox(kPlanSpheres, msg::panel_spheres, layers_.spheres));
  }
  return {std::move(place),
          std::move(layers),
          {text(msg::panel_search),
           {plan_line(msg::panel_samples, std::to_string(path.counts.samples)),
            plan_line(msg::panel_nodes, std::to_string(path.counts.nodes)),
            plan_line(msg::panel_edges_checked, std::to_string(path.counts.edges)),
            plan_line(msg::panel_corners, std::to_string(path.q.size() - 2)),
            plan_line(msg::panel_length, plan_words("%.3f", path.cost))}}};
}

void PlanPlayer::fill(view::ViewFrame& frame) {
  const JointVec q = drawing_->way().at(place_);
  place_subject(sim_, *subject_, q);
  const PlanLook look = drawing_->look(q);
  frame.snapshot = sim_.snapshot();
  frame.snapshot.time = place_ / kPlanSpeed;
  frame.overlay = drawing_->overlay(layers_, look);
  frame.panels = panels(look);
  frame.status = look.pair ? pair_line(*look.pair) : std::string();
  if (look.obstacle_pair)
    frame.status += text(msg::core_semicolon) + pair_line(*look.obstacle_pair);
}

}  // namespace mjarm::session
