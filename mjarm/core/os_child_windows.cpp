#include <windows.h>

#include <utility>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/os_child_program.hpp"
#include "mjarm/core/os_process_internal.hpp"
#include "mjarm/core/os_text_internal.hpp"

namespace mjarm {
namespace {

/// [ms] How long the listener sleeps before it looks again.
constexpr unsigned kLook = 20;
/// [s] Computing time that is no progress.
constexpr double kWakes = 1e-3;

/// Hears what the child says until it ends or has used up what it may.
class Listener {
 public:
  Listener(const Process& child, const Handle& pipe, const ChildLimits& limits)
      : child_(child), pipe_(pipe), limits_(limits) {}

  ChildResult listen() {
    bool ended = false;
    while (!ended) {
      ended = child_.wait(kLook);
      hear();
      if (!ended && has_enough()) {
        child_.kill();
        return std::move(result_);
      }
    }
    const unsigned long code = child_.exit_code();
    if (result_.said.size() > limits_.answer) {
      result_.end = ChildEnd::too_long;
    } else if (code == 0) {
      result_.end = ChildEnd::done;
    } else {
      result_.signal = static_cast<int>(code);  // of the exception, where one ended it
    }
    return std::move(result_);
  }

 private:
  void hear() {
    DWORD waiting = 0;
    while (PeekNamedPipe(pipe_.get(), nullptr, 0, nullptr, &waiting, nullptr) != FALSE &&
           waiting > 0 && result_.said.size() <= limits_.answer) {
      const std::size_t before = result_.said.size();
      result_.said.resize(before + waiting);
      DWORD count = 0;
      ReadFile(pipe_.get(), result_.said.data() + before, waiting, &count, nullptr);
      result_.said.resize(before + count);
    }
  }

  /// Sets how it ended where it may not go on.
  bool has_enough() {
    const double seconds = child_.cpu_seconds() - before_;
    if (seconds - used_ > kWakes) {
      used_ = seconds;
      idle_looks_ = 0;
    }
    ++idle_looks_;
    if (result_.said.size() > limits_.answer) {
      result_.end = ChildEnd::too_long;
    } else if (seconds > limits_.cpu_seconds) {
      result_.end = ChildEnd::out_of_time;
    } else if (idle_looks_ * (1e-3 * kLook) > limits_.idle_seconds) {
      result_.end = ChildEnd::stuck;
    } else {
      return false;
    }
    return true;
  }

  const Process& child_;
  const Handle& pipe_;
  ChildLimits limits_;
  double before_ = child_.cpu_seconds();  ///< [s] Wine gives the time of this process
  double used_ = 0;                       ///< [s] computing time of the child when it last went on
  int idle_looks_ = 0;
  ChildResult result_;
};

/// The child reads all of its input before it does anything else.
void feed(const Handle& pipe, std::string_view input) {
  while (!input.empty()) {
    const auto piece = static_cast<DWORD>(std::min<std::size_t>(input.size(), 1 << 20));
    DWORD count = 0;
    if (WriteFile(pipe.get(), input.data(), piece, &count, nullptr) == FALSE) return;
    input.remove_prefix(count);
  }
}

}  // namespace

Result<ChildResult> run_child_program(const std::filesystem::path& program,
                                      const std::vector<std::string>& arguments,
                                      std::string_view input, const ChildLimits& limits) {
  Pipe to = make_pipe();
  Pipe from = make_pipe();
  unsigned long error = to.write && from.write ? ERROR_SUCCESS : GetLastError();
  Process child;
  if (error == ERROR_SUCCESS) {
    child = start_process({.program = program,
                           .arguments = arguments,
                           .input = to.read.get(),
                           .output = from.write.get(),
                           .memory = limits.memory},
                          error);
  }
  if (!child.process) {
    return fail(Errc::system, text(msg::core_no_process, windows_message(error)));
  }
  to.read.close();
  from.write.close();
  feed(to.write, input);
  to.write.close();
  return Listener(child, from.read, limits).listen();
}

void crash_silently() noexcept { SetErrorMode(SEM_FAILCRITICALERRORS | SEM_NOGPFAULTERRORBOX); }

}  // namespace mjarm
