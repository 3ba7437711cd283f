#include <dlfcn.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <system_error>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/os.hpp"

namespace mjarm {
namespace {

std::atomic<bool> interrupt_seen{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler sets it");

extern "C" void on_interrupt(int signal) {
  if (!interrupt_seen.exchange(true)) return;
  // The default action cannot be lost this way, not even when the program is stuck in a library.
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

Result<std::filesystem::path> executable_path() {
  std::error_code error;
  std::filesystem::path path = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return fail(Errc::system, text(msg::core_no_executable_path, error.message()));
  return path;
}

std::filesystem::path library_of(const void* address) {
  Dl_info info{};
  if (::dladdr(address, &info) == 0 || info.dli_fname == nullptr) return {};
  std::error_code error;
  std::filesystem::path path = std::filesystem::weakly_canonical(info.dli_fname, error);
  return error ? std::filesystem::path(info.dli_fname) : path;
}

std::optional<std::string> environment(const std::string& name) {
  const char* value = std::getenv(name.c_str());
  if (value == nullptr) return std::nullopt;
  return std::string(value);
}

std::string locale_name() {
  for (const char* variable : {"LC_ALL", "LC_MESSAGES", "LANG"}) {
    const std::optional<std::string> value = environment(variable);
    if (value && !value->empty()) return *value;
  }
  return {};
}

bool stderr_is_terminal() noexcept {
  const char* term = std::getenv("TERM");
  const bool dumb = term == nullptr || std::string_view(term) == "dumb";
  return !dumb && ::isatty(STDERR_FILENO) == 1;
}

int terminal_width() noexcept {
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
  return size.ws_col;
}

bool has_display() {
  for (const char* variable : {"DISPLAY", "WAYLAND_DISPLAY"}) {
    const std::optional<std::string> value = environment(variable);
    if (value && !value->empty()) return true;
  }
  return false;
}

std::optional<std::filesystem::path> user_folder(const std::string& variable,
                                                 const std::string& below_home) {
  const std::filesystem::path named = environment(variable).value_or("");
  if (named.is_absolute()) return named;  // the XDG rules: a relative path is to be ignored
  const std::filesystem::path home = environment("HOME").value_or("");
  if (home.is_absolute()) return home / below_home;
  return {};
}

long process_id() noexcept { return ::getpid(); }

bool is_running(long process) noexcept {
  return ::kill(static_cast<pid_t>(process), 0) == 0 || errno == EPERM;
}

void catch_interrupts() noexcept {
  struct sigaction action{};
  action.sa_handler = on_interrupt;
  sigemptyset(&action.sa_mask);
  action.sa_flags = 0;  // blocking reads return, so that a waiting program can end
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() noexcept { return interrupt_seen.load(); }

Result<void*> open_library(const std::string& name) {
  void* library = ::dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library != nullptr) return library;
  const char* reason = ::dlerror();
  return fail(Errc::not_available, reason == nullptr ? name : std::string(reason));
}

void publish_library(const std::string& name) noexcept {
  ::dlopen(name.c_str(), RTLD_NOW | RTLD_NOLOAD | RTLD_GLOBAL);
}

void* library_symbol(void* library, const std::string& symbol) noexcept {
  return ::dlsym(library, symbol.c_str());
}

}  // namespace mjarm
