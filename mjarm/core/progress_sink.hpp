#pragma once

#include <functional>
#include <string>

namespace mjarm {

/// Gets a line of progress; an empty one takes the last away.
using ProgressSink = std::function<void(const std::string& line)>;

/// Where every Progress shows itself from now on in place of the terminal, which need not be one
/// then: for programs with a way of their own, such as a notebook. May be called from any thread,
/// must not throw. Empty: the terminal. To be set while nothing else runs.
void set_progress_sink(ProgressSink sink);

}  // namespace mjarm
