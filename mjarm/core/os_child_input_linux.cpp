#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <optional>
#include <sstream>
#include <thread>
#include <utility>

#include "mjarm/core/messages/run.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/os_child_input.hpp"

namespace mjarm {
namespace {

/// A file descriptor that is closed with this object.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    close();
    number_ = std::exchange(other.number_, -1);
    return *this;
  }
  void close() noexcept {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

/// The end of what a file holds.
std::string end_of(int file) {
  constexpr off_t kMax = 64 << 10;
  const off_t size = ::lseek(file, 0, SEEK_END);
  if (size <= 0) return {};
  std::string words(static_cast<std::size_t>(std::min(size, kMax)), '\0');
  const off_t from = size - static_cast<off_t>(words.size());
  const ssize_t count = ::pread(file, words.data(), words.size(), from);
  words.resize(count < 0 ? 0 : static_cast<std::size_t>(count));
  return words;
}

/// Starts `argv` with these streams, in a process group of its own and with no signal blocked or
/// ignored. @return 0 or the error number.
int spawn(pid_t& child, char* const* argv, int input, int complaints) {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawnattr_init(&attributes);
  ::posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
  ::posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_adddup2(&files, complaints, STDERR_FILENO);
  sigset_t none;
  sigset_t usual;
  sigemptyset(&none);
  sigemptyset(&usual);
  for (const int signal : {SIGINT, SIGTERM, SIGPIPE, SIGCHLD}) sigaddset(&usual, signal);
  ::posix_spawnattr_setsigmask(&attributes, &none);
  ::posix_spawnattr_setsigdefault(&attributes, &usual);
  ::posix_spawnattr_setpgroup(&attributes, 0);
  ::posix_spawnattr_setflags(
      &attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  const int error = ::posix_spawnp(&child, argv[0], &files, &attributes, argv, environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&files);
  return error;
}

}  // namespace

struct FedProgram::Impl {
  ~Impl() {
    if (child <= 0) return;
    ::kill(child, SIGKILL);
    while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
    }
  }

  /// Its exit code once it has ended.
  std::optional<int> poll() {
    int status = 0;
    const pid_t found = ::waitpid(child, &status, WNOHANG);
    if (found == 0 || (found < 0 && errno == EINTR)) return std::nullopt;
    child = 0;
    if (found < 0) return 0;  // the host of this library lets nobody know
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  pid_t child = 0;
  Descriptor input;
  Descriptor complaints;
};

Result<FedProgram> FedProgram::start(const std::filesystem::path& program,
                                     const std::vector<std::string>& arguments) {
  const auto cannot = [&program](int error) {
    const Errc code = error == ENOENT ? Errc::not_available : Errc::system;
    return fail(code, text(msg::run_cannot, program.string(), system_message(error)));
  };
  // A socket and not a pipe: sending into one that nobody reads gives an error and no signal.
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return cannot(errno);
  auto impl = std::make_unique<Impl>();
  impl->input = Descriptor(ends[0]);
  Descriptor its_input(ends[1]);
  // A file in memory and not a pipe: it takes all there is without anybody reading.
  impl->complaints = Descriptor(::memfd_create("complaints", MFD_CLOEXEC));
  if (impl->complaints.number() < 0) return cannot(errno);
  std::string name = program.string();
  std::vector<std::string> words = arguments;
  std::vector<char*> argv{name.data()};
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const int error = spawn(impl->child, argv.data(), its_input.number(), impl->complaints.number());
  if (error != 0) {
    impl->child = 0;
    return cannot(error);
  }
  return FedProgram(std::move(impl));
}

FedProgram::FedProgram(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FedProgram::~FedProgram() = default;
FedProgram::FedProgram(FedProgram&&) noexcept = default;
FedProgram& FedProgram::operator=(FedProgram&&) noexcept = default;

bool FedProgram::feed(std::string_view bytes) noexcept {
  while (!bytes.empty()) {
    const ssize_t count = ::send(impl_->input.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

Result<FedProgramEnd> FedProgram::finish() {
  impl_->input.close();
  for (;;) {
    if (const std::optional<int> code = impl_->poll()) {
      return FedProgramEnd{*code, end_of(impl_->complaints.number())};
    }
    if (interrupted()) {
      impl_.reset();
      return fail(Errc::system, text(msg::run_interrupted));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

std::filesystem::path find_program(const std::string& name) {
  std::istringstream folders(environment("PATH").value_or(""));
  for (std::string folder; std::getline(folders, folder, ':');) {
    std::filesystem::path file = std::filesystem::path(folder.empty() ? "." : folder) / name;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(file, ignored) && ::access(file.c_str(), X_OK) == 0) {
      return file;
    }
  }
  return {};
}

}  // namespace mjarm
