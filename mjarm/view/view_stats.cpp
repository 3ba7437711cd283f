#include "mjarm/view/view_stats.hpp"

namespace mjarm::view {

void FrameCounter::add(double begin, double end, double sim_time, bool paused) {
  if (frames_++ == 0) first_end_ = end;
  drawing_ += end - begin;
  // Where time goes back the user did, or another simulation began.
  if (last_ && !paused && !last_->paused && sim_time >= last_->sim_time) {
    sim_ += sim_time - last_->sim_time;
    wall_ += end - last_->end;
  }
  last_ = Frame{end, sim_time, paused};
}

ViewStats FrameCounter::stats() const {
  ViewStats stats{.frames = frames_};
  if (frames_ == 0) return stats;
  const double shown = last_->end - first_end_;
  if (shown > 0) stats.fps = static_cast<double>(frames_ - 1) / shown;
  stats.frame_ms = 1e3 * drawing_ / static_cast<double>(frames_);
  stats.first_frame_ms = 1e3 * (first_end_ - opened_);
  if (wall_ > 0) stats.sim_rate = sim_ / wall_;
  return stats;
}

}  // namespace mjarm::view
