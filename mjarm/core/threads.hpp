#pragma once

#include <functional>

namespace mjarm {

/// Runs `work` in `threads` threads at once, of which the calling one is number 0, and returns when
/// all are through. Where the system has no more threads to give, those there are do the work: so
/// `work` takes its pieces from a counter that all share, one after the other until none is left.
/// @param threads  below 1 counts as 1; never more than 16, or two a core where that is more.
/// @param work     gets the number of its thread; must not throw.
void run_in_threads(int threads, const std::function<void(int thread)>& work);

}  // namespace mjarm
