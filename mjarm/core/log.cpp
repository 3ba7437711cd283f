#include "mjarm/core/log.hpp"

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <mutex>
#include <string>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/utf8.hpp"

namespace mjarm {
namespace {

constexpr std::string_view kEraseLine = "\r\x1b[2K";

/// Writes log lines and the one changing status line, under one lock.
class TerminalSink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  void show_status(std::string_view line) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (line == status_) return;
    put(kEraseLine);
    put(line);
    status_ = line;
    std::fflush(stderr);
  }

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    if (!status_.empty()) put(kEraseLine);
    put({message.payload.data(), message.payload.size()});
    put("\n");
    if (!status_.empty()) put(status_);
    std::fflush(stderr);
  }
  void flush_() override { std::fflush(stderr); }

 private:
  static void put(std::string_view piece) { std::fwrite(piece.data(), 1, piece.size(), stderr); }

  std::string status_;
};

/// The one logger; lives until the process ends, so that destructors of statics may still log.
struct Log {
  std::shared_ptr<TerminalSink> sink = std::make_shared<TerminalSink>();
  spdlog::logger logger{"mjarm", sink};
};
Log& the_log() {
  static Log* log = new Log;
  return *log;
}

spdlog::level::level_enum to_spdlog(LogLevel level) {
  switch (level) {
    case LogLevel::debug:
      return spdlog::level::debug;
    case LogLevel::info:
      return spdlog::level::info;
    case LogLevel::warning:
      return spdlog::level::warn;
    case LogLevel::error:
      return spdlog::level::err;
  }
  return spdlog::level::info;
}

std::string one_line(std::string_view line) {
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
  return printable(line);
}

void write(LogLevel level, std::string_view line) noexcept {
  try {
    std::string message = one_line(line);
    if (level == LogLevel::warning) message = text(msg::core_log_warning, message);
    the_log().logger.log(to_spdlog(level), message);
  } catch (...) {  // out of memory: saying nothing is all that is left
  }
}

}  // namespace

void set_log_level(LogLevel level) noexcept { the_log().logger.set_level(to_spdlog(level)); }

LogLevel log_level() noexcept {
  switch (the_log().logger.level()) {
    case spdlog::level::trace:
    case spdlog::level::debug:
      return LogLevel::debug;
    case spdlog::level::info:
      return LogLevel::info;
    case spdlog::level::warn:
      return LogLevel::warning;
    default:
      return LogLevel::error;
  }
}

void log_debug(std::string_view line) noexcept { write(LogLevel::debug, line); }
void log_info(std::string_view line) noexcept { write(LogLevel::info, line); }
void log_warning(std::string_view line) noexcept { write(LogLevel::warning, line); }
void log_error(std::string_view line) noexcept { write(LogLevel::error, line); }

void show_status(std::string_view line) noexcept {
  try {
    the_log().sink->show_status(line);
  } catch (...) {
  }
}

}  // namespace mjarm
