#pragma once

#include <filesystem>
#include <utility>

#include "mjarm/core/os_cpu_time.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/stopwatch.hpp"

namespace mjarm {

/// How much work something takes, from when this is made.
class WorkClock {
 public:
  /// [s] Time in which the process only waited, for others or for its user, is none of it, but for
  /// a core of a busy machine; nor are several threads at once more than one.
  [[nodiscard]] double seconds() const noexcept;

 private:
  Stopwatch watch_;
  double begin_ = busy_seconds();
};

/// What becomes of an earlier result. To be made where the work for the new one begins.
struct Replace {
  bool overwrite = false;  ///< replaces also what took long
  WorkClock work = {};     ///< of the new result
};

/// A file or folder of results while it is being worked for. One that took over a minute keeps a
/// note of that, and is not replaced unless that is asked for; shorter ones are, without a word.
class LongResult {
 public:
  /// @param path  need not exist; empty: a result that goes to no file.
  /// @return `usage` with the time that was spent, where what stands at `path` took over a minute.
  [[nodiscard]] static Result<LongResult> begin(const std::filesystem::path& path,
                                                const Replace& replace);

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// The result stands whole at its path: notes how long it took.
  void made() const noexcept;

 private:
  LongResult(std::filesystem::path path, const WorkClock& work)
      : path_(std::move(path)), work_(work) {}

  std::filesystem::path path_;
  WorkClock work_;
};

/// Notes that what stands at `path` took so many seconds: above a minute it is kept from now on.
void note_work(const std::filesystem::path& path, double seconds) noexcept;

}  // namespace mjarm
