#include "mjarm/model/mujoco_guard.hpp"

#include <mujoco/mujoco.h>

#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <mutex>

#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/model.hpp"

namespace mjarm {
namespace {

struct Guard;

/// The innermost guarded call of this thread.
thread_local Guard* current_guard = nullptr;

/// One guarded call in progress.
struct Guard {
  Guard() { current_guard = this; }
  ~Guard() { current_guard = outer; }
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;

  std::jmp_buf return_point;
  MujocoOutcome outcome;
  Guard* outer = current_guard;
};

void take_error(const char* message) {
  if (current_guard == nullptr) {
    // MuJoCo may not be returned to after an error, so without a guard only the end is left.
    log_error(text(msg::model_mujoco_fatal, message));
    // Not exit(): it would destroy what other threads are still working with.
    std::fflush(nullptr);
    std::_Exit(EXIT_FAILURE);
  }
  current_guard->outcome.failed = true;
  current_guard->outcome.error = message;
  std::longjmp(current_guard->return_point, 1);
}

void take_message(const mjLogMessage* message) {
  if (message->level == mjLOG_ERROR) {
    take_error(message->subject);
  } else if (message->level == mjLOG_WARNING) {
    if (current_guard != nullptr) {
      current_guard->outcome.warnings.emplace_back(message->subject);
    } else {
      log_warning(text(msg::model_mujoco_says, message->subject));
    }
  } else if (message->topic == mjTOPIC_NONE) {
    log_debug(text(msg::model_mujoco_says, message->subject));
  }
}

}  // namespace

void install_mujoco_handler() noexcept {
  static std::once_flag once;
  std::call_once(once, [] {
    mjLogConfig config = mju_getLogConfig();
    config.logto_console = 0;
    config.logto_file = 0;
    mju_setLogConfig(config);
    mju_setLogHandler(take_message);
  });
}

namespace detail {

MujocoOutcome call_mujoco(void (*work)(void*), void* context) {
  install_mujoco_handler();
  Guard guard;
  // MuJoCo is C: its errors are left by a jump, as its manual asks for (Error handlers).
  if (setjmp(guard.return_point) == 0) work(context);
  return std::move(guard.outcome);
}

}  // namespace detail
}  // namespace mjarm
