#include "mjarm/session/run_show.hpp"

#include <chrono>
#include <thread>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/panels.hpp"
#include "mjarm/core/messages/show.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/render/fonts.hpp"
#include "mjarm/render/overlay_shapes.hpp"
#include "mjarm/session/arm_json.hpp"

namespace mjarm::session {
namespace {

constexpr auto kRest = std::chrono::microseconds(500);
constexpr render::Rgba kPlanned = {0.85F, 0.15F, 0.15F, 1};
constexpr render::Rgba kUnreachable = {0.98F, 0.62F, 0.05F, 1};
constexpr render::Rgba kGoal = {0.15F, 0.70F, 0.30F, 0.6F};

}  // namespace

Result<RunShow> RunShow::open(const Model& model, const std::string& title, bool headless) {
  RunShow show(model.timestep());
  if (headless) return show;
  Result<std::optional<view::RemoteWindow>> window =
      view::RemoteWindow::open_where_possible(model, title, {.can_reset = false});
  if (!window) return fail(std::move(window.error()));
  show.window_ = std::move(*window);
  return show;
}

void RunShow::add_points(std::span<const Pose> X_WT, std::size_t every) {
  for (std::size_t i = 0; i < X_WT.size(); i += every) {
    planned_.spheres.push_back({.p_W = X_WT[i].p, .radius = 0.005, .color = kPlanned});
  }
}

void RunShow::add_unreachable(std::span<const Pose> X_WT) {
  for (const Pose& pose : X_WT) {
    planned_.spheres.push_back({.p_W = pose.p, .radius = 0.009, .color = kUnreachable});
  }
}

void RunShow::add_line(std::span<const Pose> X_WT) { render::add_planned_path(planned_, X_WT); }

void RunShow::begin_goal(const Sim& sim, const Eigen::Vector3d& p_W) {
  goal_ = render::OverlaySphere{.p_W = p_W, .radius = 0.02, .color = kGoal};
  trail_.clear();
  if (video_) video_->begin_again(sim);
}

render::Overlay RunShow::overlay() const {
  render::Overlay all = planned_;
  if (goal_) all.spheres.push_back(*goal_);
  trail_.draw(all);
  return all;
}

std::vector<view::LivePlot> RunShow::plots() const {
  if (!plots_tool_) return {};
  view::LivePlot path{.title = text(msg::panel_from_above), .x_label = "x [m]", .series = {}};
  path.equal_aspect = true;
  path.series.push_back({.name = ""});
  view::LivePlot time{.title = text(msg::panel_tool_over_time),
                      .x_label = text(msg::panel_time_axis),
                      .series = {}};
  time.series = {{.name = "x", .color = {0.90F, 0.35F, 0.30F, 1}},
                 {.name = "y", .color = {0.30F, 0.75F, 0.35F, 1}},
                 {.name = "z", .color = {0.35F, 0.55F, 0.95F, 1}}};
  for (std::size_t i = 0; i < tool_.size(); ++i) {
    const Eigen::Vector3d& p_W = tool_.at(i);
    path.series[0].x.push_back(p_W.x());
    path.series[0].y.push_back(p_W.y());
    for (int axis = 0; axis < 3; ++axis) {
      view::LiveSeries& series = time.series[static_cast<std::size_t>(axis)];
      series.x.push_back(tool_.time(i));
      series.y.push_back(p_W[axis]);
    }
  }
  return {std::move(path), std::move(time)};
}

bool RunShow::step(const Sim& sim, const Eigen::Vector3d& p_WT) {
  if (interrupted()) return false;
  if (record_ && filming_ && record_->is_due(sim.time())) record_->add(sim.snapshot());
  trail_.add(p_WT, record_ ? std::optional(record_->time_at(sim.time())) : std::nullopt);
  if (video_ && filming_ && video_->is_due(sim) && !video_->step(sim, overlay())) return false;
  if (!window_) return true;
  history_.add(sim.snapshot());
  // A rehearsal has a clock that begins anew.
  if (!tool_.empty() && sim.time() <= last_time_) tool_.clear();
  last_time_ = sim.time();
  if (plots_tool_) tool_.add(last_time_, [&p_WT] { return p_WT; });
  changed_ = true;
  if (due_ > 0) --due_;
  offer();
  while (due_ == 0) {
    if (!window_->is_open() || interrupted()) return false;
    handle_events();
    due_ = playback_.steps_due();
    offer();
    if (due_ == 0) std::this_thread::sleep_for(kRest);
  }
  return true;
}

void RunShow::record(const Sim& sim, const Arm* arm) {
  record_.emplace(sim.model());
  if (arm == nullptr) return;
  arm_ = arm_json(sim.model(), *arm);
  dofs_ = dofs_of(*arm);
}

Result<void> RunShow::end_record(const Model& model, const Snapshot& last, const RunOutput& output,
                                 const view::RunKeeper& keep) {
  if (!record_) return {};
  if (filming_) record_->add(last);
  view::RecordedRun run{.model = model,
                        .title = "mjarm " + output.report.name,
                        .bodies = *record_,
                        .overlay = output.overlay,
                        .line = output.plot.note,
                        .camera = output.camera,
                        .arm = arm_,
                        .dofs = dofs_};
  for (const render::PlotPanel& panel : output.plot.panels) {
    run.plots.push_back(view::live_plot(panel));
  }
  return keep(run);
}

Result<void> RunShow::film(const Model& model, const std::filesystem::path& file,
                           const render::Camera& camera) {
  Result<VideoOfRun> video = VideoOfRun::open(model, {.out = file, .video = true}, camera);
  if (!video) return fail(std::move(video.error()));
  video_.emplace(std::move(*video));
  return {};
}

Result<void> RunShow::end_film() {
  if (!video_) return {};
  Result<void> done = video_->finish();
  if (done) {
    log_info(video_->summary());
  } else if (interrupted()) {
    log_warning(done.error().what);
    return {};
  }
  return done;
}

void RunShow::handle_events() {
  for (const view::ViewEvent& event : window_->link().events.take()) handle(event);
}

void RunShow::handle(const view::ViewEvent& event) {
  changed_ = true;
  if (const auto* push = std::get_if<view::PushEvent>(&event);
      push != nullptr && pushed_ != nullptr) {
    pushed_->set_external_force(push->body, push->force_W, push->torque_W);
  } else if (std::holds_alternative<view::ReleaseEvent>(event) && pushed_ != nullptr) {
    pushed_->clear_external_forces();
  }
  if (const auto* step = std::get_if<view::StepEvent>(&event)) {
    if (step->steps < 0) (void)history_.back();
    if (step->steps < 0 || history_.forward() != nullptr) return;
  }
  (void)playback_.handle(event);
  if (!playback_.paused()) history_.to_present();
}

void RunShow::offer() {
  view::Mailbox<view::ViewFrame>& frames = window_->link().frames;
  if (!changed_ || !frames.is_empty() || history_.size() == 0) return;
  changed_ = false;
  const LanguageScope drawn(render::picture_language());
  frame_.snapshot = history_.at();
  frame_.overlay = overlay();
  frame_.plots = plots();
  frame_.status =
      history_.is_past() ? text(msg::panel_space_goes_on) : render::overlay_notice(frame_.overlay);
  frames.post(frame_);
}

void RunShow::linger(const Sim& sim) {
  if (!window_ || !window_->is_open() || interrupted()) return;
  log_info(text(msg::show_close_window));
  history_.add(sim.snapshot());
  changed_ = true;
  while (window_->is_open() && !interrupted()) {
    handle_events();
    offer();
    std::this_thread::sleep_for(kRest);
  }
}

}  // namespace mjarm::session
