#pragma once

#include <functional>

#include "mjarm/core/error.hpp"

namespace mjarm {

/// Ends a long call early: asked again and again while the call works, from any of its threads;
/// true ends it with an error, or a failure whose reason is `stopped`. Once true it has to stay
/// true. It must be quick and never throw. Empty: the call goes on to its end. As long as it is
/// false, the answer is the same as without it. Programs that catch interrupts give
/// `interrupted` (os.hpp).
using StopCheck = std::function<bool()>;

/// Whether the call is to end.
[[nodiscard]] inline bool is_stopped(const StopCheck& stop) { return stop && stop(); }

/// What a call says that was ended early.
[[nodiscard]] Error stopped();

}  // namespace mjarm
