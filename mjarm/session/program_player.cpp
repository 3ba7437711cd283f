#include "mjarm/session/program_player.hpp"

#include <cmath>
#include <cstdio>
#include <utility>

#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/panels.hpp"
#include "mjarm/session/max_moments.hpp"

namespace mjarm::session {
namespace {

constexpr std::size_t kMaxRecorded = 5000;  // moments

}  // namespace

ProgramPlayer::ProgramPlayer(const program::LoadedProgram& loaded, Execution execution)
    : loaded_(&loaded),
      sim_(loaded.robot.model),
      execution_(std::move(execution)),
      playback_(loaded.robot.model.timestep()),
      record_(max_moments(sim_, kMaxRecorded)),
      scene_(loaded, kProgramFigure),
      lines_(program_lines(loaded.plan)) {
  sim_.hold_others(loaded.robot.arm);
  restart();
}

Result<ProgramPlayer> ProgramPlayer::create(const program::LoadedProgram& loaded) {
  Result<Execution> execution =
      Execution::create(loaded.robot.model, loaded.plan, {.control = loaded.control()});
  if (!execution) return fail(std::move(execution.error()));
  return ProgramPlayer(loaded, std::move(*execution));
}

void ProgramPlayer::restart() {
  sim_.reset_home();
  sim_.place(loaded_->robot.arm, as_span(loaded_->plan.q_start));
  execution_.restart();
  record_.clear();
  scene_.clear();
  to_present();
  unstable_ = false;
}

void ProgramPlayer::keep() {
  record_.add(sim_.time(),
              [this] { return Moment{sim_.snapshot(), clock().motion(), clock().time()}; });
  scene_.add(sim_, sim_.time() - record_.time(0), clock().motion(), clock().q_ref());
}

int ProgramPlayer::steps_due() {
  const int steps = playback_.steps_due();
  return look_ == ProgramLook::past ? 0 : steps;
}

void ProgramPlayer::step() {
  if (look_ == ProgramLook::present) return step_simulation();
  if (look_ != ProgramLook::replay) return;
  cursor_ += sim_.model().timestep();
  if (cursor_ >= record_.time(record_.size() - 1)) look_at(cursor_);
}

void ProgramPlayer::step_simulation() {
  const Execution::State state = execution_.state();
  const bool recorded = state != Execution::State::ready && state != Execution::State::done;
  if (recorded && record_.empty()) keep();
  if (auto stepped = execution_.step(sim_); !stepped) {
    log_warning(stepped.error().what);
    restart();
    unstable_ = true;
    return;
  }
  if (recorded) keep();
}

void ProgramPlayer::look_at(double time) {
  if (record_.empty() || !std::isfinite(time)) return;
  cursor_ = record_.time(record_.nearest(time));
  look_ = ProgramLook::past;
}

/// Single steps while it pauses: back into the record, through it, and out of it again.
void ProgramPlayer::step_moments(int steps) {
  if (record_.empty()) return;
  const bool present = look_ == ProgramLook::present;
  std::size_t i = record_.nearest(present ? sim_.time() : cursor_);
  if (steps > 0) {
    if (++i == record_.size()) return to_present();
  } else if (!present || record_.time(i) >= sim_.time()) {
    if (i == 0) return;
    --i;
  }
  look_at(record_.time(i));
}

void ProgramPlayer::press(const view::PanelEvent& event) {
  switch (event.id) {
    case kProgramRun:
      to_present();
      return execution_.run();
    case kProgramStep:
      to_present();
      return execution_.run_one();
    case kProgramStop:
      to_present();
      return execution_.stop();
    case kProgramRestart:
      return restart();
    case kProgramNow:
      return to_present();
    case kProgramTime:
      return look_at(record_.empty() ? 0 : record_.time(0) + event.value);
    case kProgramReplay:
      if (record_.empty()) return;
      // From where one looks, or else from the beginning.
      if (look_ != ProgramLook::past || cursor_ >= record_.time(record_.size() - 1)) {
        cursor_ = record_.time(0);
      }
      look_ = ProgramLook::replay;
      return;
    case kProgramLines:
      // A line that was begun shows how it began.
      for (std::size_t i = 0; i < record_.size(); ++i) {
        if (static_cast<double>(record_.at(i).motion) == event.value) {
          return look_at(record_.time(i));
        }
      }
      return;
    default:
      return choose(event);
  }
}

void ProgramPlayer::choose(const view::PanelEvent& event) {
  const bool on = event.value != 0;
  if (event.id == kProgramPaths) choice_.paths = on;
  if (event.id == kProgramTrail) choice_.trail = on;
  if (event.id == kProgramGoal) choice_.goal = on;
  (void)scene_.figures().handle(event);
}

void ProgramPlayer::handle(const view::ViewEvent& event) {
  unstable_ = false;
  const bool present = look_ == ProgramLook::present;
  if (const auto* panel = std::get_if<view::PanelEvent>(&event)) {
    press(*panel);
  } else if (const auto* push = std::get_if<view::PushEvent>(&event)) {
    if (present) sim_.set_external_force(push->body, push->force_W, push->torque_W);
  } else if (std::holds_alternative<view::ReleaseEvent>(event)) {
    sim_.clear_external_forces();
  } else if (std::holds_alternative<view::ResetEvent>(event)) {
    restart();
  } else if (const auto* step = std::get_if<view::StepEvent>(&event);
             step != nullptr && (step->steps < 0 || !present)) {
    step_moments(step->steps);
  } else {
    (void)playback_.handle(event);
    // Whoever lets time go on wants to see it.
    const auto* pause = std::get_if<view::PauseEvent>(&event);
    if (pause != nullptr && !pause->paused && look_ == ProgramLook::past) to_present();
  }
}

ProgramFacts ProgramPlayer::facts() const {
  ProgramFacts facts{.state = clock().state(),
                     .motion = clock().motion(),
                     .time = clock().time(),
                     .look = look_,
                     .expected = clock().duration()};
  const std::size_t motions = loaded_->plan.moves.size();
  if (!record_.empty()) {
    facts.recorded = record_.time(record_.size() - 1) - record_.time(0);
    facts.shown = facts.recorded;
    if (look_ != ProgramLook::present) {
      facts.shown = cursor_ - record_.time(0);
      facts.motion = shown().motion;
      facts.time = shown().time;
    }
  }
  if (facts.motion < motions) {
    facts.duration = clock().steps_of(facts.motion) * sim_.model().timestep();
  }
  return facts;
}

std::string ProgramPlayer::status() const {
  if (look_ == ProgramLook::present) {
    return unstable_ ? text(msg::panel_unstable) : std::string();
  }
  const bool past = look_ == ProgramLook::past;
  return text(past ? msg::panel_looking_back : msg::panel_replaying, facts().shown);
}

void ProgramPlayer::fill(view::ViewFrame& frame) const {
  const bool present = look_ == ProgramLook::present;
  frame.snapshot = present ? sim_.snapshot() : shown().snapshot;
  frame.overlay = scene_.overlay(choice_, present ? std::optional(clock().motion()) : std::nullopt);
  frame.plots = scene_.plots();
  frame.panels = program_panels(facts(), lines_, choice_, scene_.figures().section());
  frame.status = status();
}

}  // namespace mjarm::session
