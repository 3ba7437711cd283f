#include "mjarm/session/teleop_session.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <utility>

#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/teleop.hpp"

namespace mjarm::session {
namespace {

/// Numbers of the items of the panels.
enum TeleopItem {
  kGripItem = 4000,
  kLedFrameItem,
  kLedPauseItem,
  kLedResetItem,
  kRecordItem,
  kRedoItem,
  kDiscardItem,
  kKeepItem,
  kLedTextItem,
};

constexpr double kPastEvery = 0.1;   // [s] between moments that can be gone back to
constexpr double kMaxInputs = 3600;  // [s]
constexpr std::size_t kMaxLatencies = 100'000;

std::string seconds_of(double seconds) { return text(msg::teleop_seconds, seconds); }

}  // namespace

TeleopSession::TeleopSession(const Robot& robot, TeleopSessionOptions options, Teleop teleop)
    : robot_(robot),
      options_(std::move(options)),
      teleop_(std::move(teleop)),
      sim_(robot_.model),
      desk_(std::make_unique<TeleopDesk>()),
      playback_(teleop_.period()),
      frame_(options_.frame) {
  reset();
}

Result<TeleopSession> TeleopSession::create(const Robot& robot, TeleopSessionOptions options) {
  Result<Teleop> teleop = Teleop::create(robot, options.teleop);
  if (!teleop) return fail(std::move(teleop.error()));
  return TeleopSession(robot, std::move(options), std::move(*teleop));
}

void TeleopSession::reset() {
  sim_.reset_home();
  sim_.place(robot_.arm, as_span(robot_.arm.home));
  teleop_.begin(sim_);
  close_to_ = teleop_.state().grip;
  past_.clear();
  inputs_.clear();
  rows_.clear();
  next_row_ = 0;
  tape_ = Tape::empty;
  said_.clear();
}

int TeleopSession::steps_due() {
  // While it rests no period takes what was asked for.
  if (playback_.paused()) {
    for (const TeleopAction action : desk_->take().actions) act(action);
  }
  return playback_.steps_due();
}

void TeleopSession::act(TeleopAction action) {
  switch (action) {
    case TeleopAction::gripper:
      close_to_ = close_to_ > 0.5 ? 0 : 1;
      return;
    case TeleopAction::frame:
      frame_ = frame_ == TwistFrame::world ? TwistFrame::tool : TwistFrame::world;
      return;
    case TeleopAction::pause:
      playback_.set_paused(!playback_.paused());
      return;
    case TeleopAction::reset:
      return reset();
    case TeleopAction::record:
      if (!options_.keep) {
        said_ = text(msg::teleop_no_out);
        return;
      }
      tape_ = tape_ == Tape::running ? Tape::resting : Tape::running;
      said_.clear();
      return;
    case TeleopAction::redo:
      return redo();
    case TeleopAction::discard:
      said_ = text(msg::teleop_discarded, seconds_of(recorded()));
      rows_.clear();
      tape_ = Tape::empty;
      return;
    case TeleopAction::keep:
      return keep();
  }
}

void TeleopSession::redo() {
  if (past_.empty()) return;
  const double now = sim_.time();
  while (past_.size() > 1 && past_.back().moment.world.time > now - kRedo) past_.pop_back();
  const Past& to = past_.back();
  if (!teleop_.go_to(sim_, to.moment)) return;
  close_to_ = to.close_to;
  const double time = sim_.time() + 1e-9;
  while (!rows_.empty() && rows_.back().world.time > time) rows_.pop_back();
  while (!inputs_.empty() && inputs_.back().time > time) inputs_.pop_back();
  next_row_ = rows_.empty() ? sim_.time() : rows_.back().world.time + 1.0 / options_.fps;
  said_ = text(msg::teleop_went_back, now - sim_.time());
}

void TeleopSession::keep() {
  if (!options_.keep || rows_.empty()) {
    said_ = text(options_.keep ? msg::teleop_nothing_recorded : msg::teleop_no_out);
    return;
  }
  const Result<std::string> kept = options_.keep(rows_);
  if (!kept) {
    said_ = kept.error().what;
    log_error(said_);
    return;
  }
  said_ = text(msg::teleop_kept, seconds_of(recorded()), *kept);
  log_info(said_);
  rows_.clear();
  tape_ = Tape::empty;
}

double TeleopSession::recorded() const { return static_cast<double>(rows_.size()) / options_.fps; }

void TeleopSession::record() {
  if (tape_ != Tape::running) return;
  const double every = 1.0 / options_.fps;
  const double late = sim_.time() - next_row_;
  if (late < -1e-9) return;
  rows_.push_back({sim_.snapshot(), teleop_.reference(), teleop_.state().grip});
  // In step with the first row, whatever the periods are; anew after a rest.
  next_row_ += late > every ? late + every : every;
}

void TeleopSession::remember(const TeleopInput& input) {
  if (sim_.time() < kMaxInputs) inputs_.push_back({sim_.time(), input});
  if (past_.empty() || sim_.time() > past_.back().moment.world.time + kPastEvery - 1e-9) {
    past_.push_back({teleop_.moment(sim_), close_to_});
    if (static_cast<double>(past_.size()) * kPastEvery > 4 * kRedo) past_.pop_front();
  }
}

void TeleopSession::step() {
  if (space_mouse_) space_mouse_->poll(*desk_);
  const TeleopDesk::Taken taken = desk_->take();
  for (const TeleopAction action : taken.actions) act(action);
  close_to_ = std::clamp(
      close_to_ + teleop_.period() * options_.teleop.grip_speed * taken.hand.grip, 0.0, 1.0);
  const TeleopInput input{.linear = options_.teleop.speed * taken.hand.linear,
                          .angular = options_.teleop.turn * taken.hand.angular,
                          .frame = frame_,
                          .grip_to = close_to_};
  remember(input);
  if (auto done = teleop_.advance(sim_, input); !done) {
    log_warning(done.error().what);
    reset();
    return;
  }
  record();
  // Files that are written make the period after them late.
  const bool wrote = std::ranges::find(taken.actions, TeleopAction::keep) != taken.actions.end();
  if (taken.since && !wrote && latencies_.size() < kMaxLatencies) {
    latencies_.push_back(
        std::chrono::duration<double>(TeleopDesk::Clock::now() - *taken.since).count());
  }
}

TeleopLatency TeleopSession::latency() const {
  TeleopLatency out;
  out.count = latencies_.size();
  if (latencies_.empty()) return out;
  std::vector<double> sorted = latencies_;
  std::ranges::sort(sorted);
  out.mean = std::accumulate(sorted.begin(), sorted.end(), 0.0) / static_cast<double>(out.count);
  out.p99 = sorted[std::min(sorted.size() - 1, sorted.size() * 99 / 100)];
  out.max = sorted.back();
  return out;
}

void TeleopSession::handle(const view::ViewEvent& event) {
  if (std::holds_alternative<view::ResetEvent>(event)) return reset();
  if (const auto* lead = std::get_if<view::LeadEvent>(&event)) {
    desk_->set(TeleopDesk::page, {lead->linear, lead->angular, lead->grip});
    return;
  }
  const auto* used = std::get_if<view::PanelEvent>(&event);
  if (used == nullptr) {
    (void)playback_.handle(event);
    return;
  }
  switch (used->id) {
    case kGripItem:
      return act(TeleopAction::gripper);
    case kLedFrameItem:
      frame_ = used->value == 0 ? TwistFrame::world : TwistFrame::tool;
      return;
    case kLedPauseItem:
      return act(TeleopAction::pause);
    case kLedResetItem:
      return reset();
    case kRecordItem:
      return act(TeleopAction::record);
    case kRedoItem:
      return redo();
    case kDiscardItem:
      return act(TeleopAction::discard);
    case kKeepItem:
      return keep();
    default:
      return;
  }
}

namespace {

/// What slows the arm down, for people; empty where nothing does.
std::string limit_words(const TeleopState& state) {
  switch (state.limit) {
    case TeleopLimit::none:
      return {};
    case TeleopLimit::joint_range:
      return text(msg::teleop_joint_range, state.joint);
    case TeleopLimit::joint_speed:
      return text(msg::teleop_joint_speed, state.joint);
    case TeleopLimit::singularity:
      return text(msg::teleop_singularity);
    case TeleopLimit::near:
      return state.near ? text(msg::teleop_near, state.near->body1, state.near->body2,
                               1e3 * state.near->distance)
                        : std::string();
    case TeleopLimit::pushed:
      return text(msg::teleop_pushed);
  }
  return {};
}

}  // namespace

std::string TeleopSession::status() const {
  const TeleopState state = teleop_.state();
  std::string out = text(frame_ == TwistFrame::world ? msg::teleop_in_world : msg::teleop_in_tool,
                         100 * state.scale);
  if (playback_.paused()) out += " | " + text(msg::teleop_paused);
  const std::string limit = limit_words(state);
  if (!limit.empty()) out += " | " + limit;
  if (!state.held.empty()) out += " | " + text(msg::teleop_holds, state.held);
  if (tape_ != Tape::empty || !rows_.empty()) {
    out += " | " + text(tape_ == Tape::running ? msg::teleop_recording : msg::teleop_resting,
                        seconds_of(recorded()));
  }
  if (!said_.empty()) out += " | " + said_;
  return out;
}

view::PanelSection TeleopSession::section() const {
  const TeleopState state = teleop_.state();
  const std::string near = state.near ? state.near->body1 + " - " + state.near->body2 : "-";
  const std::string far =
      state.near ? text(msg::teleop_millimetres, 1e3 * state.near->distance) : "-";
  return {text(msg::teleop_panel),
          {{kGripItem, text(close_to_ > 0.5 ? msg::teleop_open : msg::teleop_close),
            view::PanelButton{}},
           {kLedFrameItem, text(msg::teleop_axes),
            view::PanelChoice{{text(msg::teleop_world), text(msg::teleop_tool)},
                              frame_ == TwistFrame::world ? 0 : 1}},
           {kLedPauseItem, text(msg::teleop_pause), view::PanelButton{}},
           {kLedResetItem, text(msg::teleop_reset), view::PanelButton{}},
           {kLedTextItem, text(msg::teleop_speed),
            view::PanelText{text(msg::teleop_percent, 100 * state.scale)}},
           {kLedTextItem, text(msg::teleop_nearest), view::PanelText{near}},
           {kLedTextItem, text(msg::teleop_distance), view::PanelText{far}}}};
}

view::PanelSection TeleopSession::record_section() const {
  return {text(msg::teleop_recording_panel),
          {{kRecordItem, text(tape_ == Tape::running ? msg::teleop_rest : msg::teleop_record),
            view::PanelButton{}},
           {kRedoItem, text(msg::teleop_redo), view::PanelButton{}},
           {kDiscardItem, text(msg::teleop_discard), view::PanelButton{}},
           {kKeepItem, text(msg::teleop_keep), view::PanelButton{}},
           {kLedTextItem, text(msg::teleop_recorded), view::PanelText{seconds_of(recorded())}}}};
}

void TeleopSession::fill(view::ViewFrame& frame) {
  frame.snapshot = sim_.snapshot();
  frame.overlay = {};
  frame.plots.clear();
  frame.panels.clear();
  frame.panels.push_back(section());
  if (options_.keep) frame.panels.push_back(record_section());
  frame.status = status();
}

}  // namespace mjarm::session
