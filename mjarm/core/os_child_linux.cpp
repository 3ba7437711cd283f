#include <fcntl.h>
#include <malloc.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/os_child.hpp"

namespace mjarm {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
constexpr bool kSanitized = __has_feature(address_sanitizer);
#else
constexpr bool kSanitized = false;
#endif
/// A sanitizer takes all of the address space and makes work slower.
constexpr double kSlowness = kSanitized ? 3 : 1;
/// Once `work` is at its end the child says this; everything before is its answer.
constexpr char kEnd = '\x04';

/// [bytes] Hardly any answer is longer.
constexpr std::size_t kUsualAnswer = std::size_t{32} << 20;
/// [s] Computing time that is no progress.
constexpr double kWakes = 1e-3;
/// [ms] How long the listener sleeps before it looks whether the child still computes.
constexpr int kLook = 20;

/// Address space of this process [bytes]; 0 where unknown.
std::size_t address_space() {
  std::FILE* file = std::fopen("/proc/self/statm", "re");
  if (file == nullptr) return 0;
  unsigned long pages = 0;
  const bool read = std::fscanf(file, "%lu", &pages) == 1;
  std::fclose(file);
  return read ? pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) : 0;
}

/// @param slack  how far the limit that cannot be passed lies above the one that is told of first.
void limit(__rlimit_resource_t resource, std::size_t max, std::size_t slack = 0) {
  rlimit old{};
  if (::getrlimit(resource, &old) != 0) return;
  // Never above what this process may have itself.
  const auto at_most = [&](std::size_t value) {
    return old.rlim_max == RLIM_INFINITY ? value : std::min<rlim_t>(value, old.rlim_max);
  };
  const rlimit now{at_most(max), at_most(max + slack)};
  ::setrlimit(resource, &now);
}

/// Turns the copy of this process into one that can harm nobody.
void become_harmless(const ChildLimits& limits, std::size_t base) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGXCPU, SIGXFSZ,
                           SIGINT, SIGTERM, SIGALRM, SIGPIPE}) {
    ::signal(signal, SIG_DFL);
  }
  sigset_t none;
  sigemptyset(&none);
  ::pthread_sigmask(SIG_SETMASK, &none, nullptr);
  const int nothing = ::open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nothing, stream);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_CPU, static_cast<std::size_t>(std::ceil(limits.cpu_seconds * kSlowness)), 1);
  if (!kSanitized && base > 0) limit(RLIMIT_AS, base + limits.memory);
#if defined(__GLIBC__)
  // It will not live long: what it has freed need not go back to the system.
  ::mallopt(M_MMAP_THRESHOLD, 1 << 25);
  ::mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
}

/// Reads what the child says until it ends, closes its end of the pipe, or runs out of time.
class Listener {
 public:
  Listener(pid_t child, int pipe, const ChildLimits& limits)
      : child_(child), pipe_(pipe), limits_(limits) {
    // A large answer is not moved while it grows; what is not needed costs no memory.
    result_.said.reserve(std::min(limits.answer, kUsualAnswer));
  }

  ChildResult listen() {
    while (!closed_ && !ended_ && !stuck_ && result_.said.size() <= limits_.answer) hear();
    if (!ended_) {
      // It has said all, or will not be listened to any longer.
      if (!closed_) ::kill(child_, SIGKILL);
      wait(0);
    }
    while (!closed_ && poll(0) && read()) {
    }
    return judge();
  }

 private:
  [[nodiscard]] bool poll(int milliseconds) const {
    pollfd waiting{pipe_, POLLIN, 0};
    return ::poll(&waiting, 1, milliseconds) > 0;
  }

  /// False at the end of the pipe.
  bool read() {
    const ssize_t count = ::read(pipe_, buffer_.data(), buffer_.size());
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) return true;
    if (count <= 0) {
      closed_ = true;
      return false;
    }
    result_.said.append(buffer_.data(), static_cast<std::size_t>(count));
    return result_.said.size() <= limits_.answer;
  }

  void hear() {
    // Processes that other threads start at this moment hold the pipe open as well, so its end
    // alone does not tell that of the child.
    if (poll(kLook)) {
      read();
    } else {
      wait(WNOHANG);
      stuck_ = !ended_ && is_idle();
    }
  }

  /// True once it has not computed for as long as it may, in time that this process was awake for:
  /// both may have been stopped for a while. (On a busy machine a process that wants to compute
  /// gets its turn much sooner; one that only wakes up now and then does not compute.)
  bool is_idle() {
    clockid_t clock{};
    timespec used{};
    if (::clock_getcpuclockid(child_, &clock) != 0 || ::clock_gettime(clock, &used) != 0)
      return false;
    const double seconds =
        static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
    if (seconds - used_ > kWakes) {
      used_ = seconds;
      idle_looks_ = 0;
    }
    return ++idle_looks_ * (1e-3 * kLook) > limits_.idle_seconds;
  }

  void wait(int how) {
    int status = 0;
    pid_t found = 0;
    do {
      found = ::waitpid(child_, &status, how);
    } while (found < 0 && errno == EINTR);
    if (found == 0) return;
    ended_ = true;  // also where the host of this library has taken the child for its own
    if (found > 0 && WIFSIGNALED(status)) result_.signal = WTERMSIG(status);
  }

  ChildResult judge() {
    if (result_.said.size() > limits_.answer) {
      result_.end = ChildEnd::too_long;
    } else if (stuck_) {
      result_.end = ChildEnd::stuck;
    } else if (result_.signal == SIGXCPU) {
      result_.end = ChildEnd::out_of_time;
    } else if (result_.signal == 0 && !result_.said.empty() && result_.said.back() == kEnd) {
      result_.end = ChildEnd::done;
      result_.said.pop_back();
    }
    return std::move(result_);
  }

  pid_t child_;
  int pipe_;
  ChildLimits limits_;
  double used_ = 0;  ///< [s] computing time of the child when it last went on
  int idle_looks_ = 0;
  ChildResult result_;
  bool closed_ = false;
  bool ended_ = false;
  bool stuck_ = false;
  std::array<char, 65536> buffer_{};
};

}  // namespace

void ChildVoice::send(std::string_view words) const noexcept {
  while (!words.empty()) {
    const ssize_t count = ::write(pipe_, words.data(), words.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return;
    words.remove_prefix(static_cast<std::size_t>(count));
  }
}

Result<ChildResult> run_in_child(const std::function<void(const ChildVoice&)>& work,
                                 const ChildLimits& limits, const std::function<void()>& started) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
    return fail(Errc::system, text(msg::core_no_process, system_message(errno)));
  }
  ::fcntl(pipe[1], F_SETPIPE_SZ, 1 << 20);  // fewer turns for large answers; no matter if refused
  const std::size_t base = address_space();
  const pid_t child = ::fork();
  if (child == 0) {
    become_harmless(limits, base);
    try {
      const ChildVoice voice(pipe[1]);
      work(voice);
      voice.send({&kEnd, 1});
    } catch (...) {
      ::_exit(EXIT_FAILURE);
    }
    ::_exit(EXIT_SUCCESS);
  }
  const int code = errno;
  if (started) started();
  ::close(pipe[1]);
  if (child < 0) {
    ::close(pipe[0]);
    return fail(Errc::system, text(msg::core_no_process, system_message(code)));
  }
  ChildResult result = Listener(child, pipe[0], limits).listen();
  ::close(pipe[0]);
  return result;
}

}  // namespace mjarm
