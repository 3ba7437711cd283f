#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "mjarm/core/result.hpp"

namespace mjarm {

/// What a piece of work in a process of its own may use.
struct ChildLimits {
  double cpu_seconds = 3;                       ///< [s] of all its threads, > 0
  double idle_seconds = 3;                      ///< [s] it may wait without computing, > 0
  std::size_t memory = std::size_t{3} << 29;    ///< [bytes] on top of what this process has
  std::size_t answer = std::size_t{400} << 20;  ///< [bytes] it may say
};

/// How such a process ended.
enum class ChildEnd {
  done,         ///< its work came to its end
  crashed,      ///< a signal ended it, or it left by itself
  out_of_time,  ///< it used up its computing time
  stuck,        ///< it waited for too long
  too_long,     ///< it said more than it may
};

/// What became of such a process.
struct ChildResult {
  ChildEnd end = ChildEnd::crashed;
  int signal = 0;    ///< that ended it; 0 where none did or none is known
  std::string said;  ///< all it said before it ended
};

/// The way back from such a process.
class ChildVoice {
 public:
  explicit ChildVoice(int pipe) : pipe_(pipe) {}
  /// Sends `words` at once.
  void send(std::string_view words) const noexcept;

 private:
  int pipe_;
};

/// Runs `work` in a copy of this process, so that whatever it does (crash, hang, eat memory) harms
/// nobody. The copy cannot write to files, is silent on its standard streams and ends with `work`,
/// which should hold everything it needs and take no lock that another thread may hold: such a lock
/// stays locked in the copy, which then is `stuck`. (The lock of the program loader is among them:
/// exceptions take it where libunwind looks for their handlers. Another try may succeed.)
/// May be called from any thread. Where a sanitizer holds the address space, memory is not limited.
/// @param started  called in this process once the copy is made; may be null.
/// @return an error where no process can be had.
[[nodiscard]] Result<ChildResult> run_in_child(const std::function<void(const ChildVoice&)>& work,
                                               const ChildLimits& limits = {},
                                               const std::function<void()>& started = nullptr);

}  // namespace mjarm
