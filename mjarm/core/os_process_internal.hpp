#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

/// Processes of Windows, for the files of core that start one.
namespace mjarm {

/// A handle of Windows that is closed with this object; null is none.
class Handle {
 public:
  Handle() = default;
  explicit Handle(void* handle) : handle_(handle) {}
  ~Handle() { close(); }
  Handle(Handle&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  void close() noexcept;
  [[nodiscard]] void* get() const { return handle_; }
  explicit operator bool() const { return handle_ != nullptr; }

 private:
  void* handle_ = nullptr;
};

/// The two ends of a pipe; none where there are no more.
struct Pipe {
  Handle read;
  Handle write;
};
[[nodiscard]] Pipe make_pipe();

/// What a process starts with. A stream that is null is the null device.
struct ProcessStart {
  std::filesystem::path program = {};  ///< path, or a name that is looked for in PATH
  std::vector<std::string> arguments = {};
  void* input = nullptr;
  void* output = nullptr;
  void* errors = nullptr;
  std::size_t memory = 0;  ///< [bytes] it may have; 0 = any
  bool own_group = true;   ///< Ctrl-C does not reach it
};

/// A process that ends at the latest with this object, whatever it does.
struct Process {
  Handle process;
  Handle job;

  /// False while it runs, for at most so long.
  [[nodiscard]] bool wait(unsigned milliseconds) const noexcept;
  /// Once it has ended.
  [[nodiscard]] unsigned long exit_code() const noexcept;
  /// [s] Computing time so far.
  [[nodiscard]] double cpu_seconds() const noexcept;
  void kill() const noexcept;
};

/// @param error  number of GetLastError where it cannot be started.
[[nodiscard]] Process start_process(const ProcessStart& start, unsigned long& error);

}  // namespace mjarm
