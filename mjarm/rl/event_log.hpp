#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"

/// Logs that grow while a training runs: rows of numbers, one row a step. What `append` was given
/// is in the file when it returns, so that a program that is killed loses nothing. A training that
/// goes on from a checkpoint opens its logs again and drops the rows after it: the file is then the
/// same as if nothing had happened, to the last byte.
namespace mjarm::rl {

/// Opens a log anew: nothing of an old one is kept.
inline constexpr std::int64_t kNoStep = -1;

/// A file that only grows, and is up to date after every `append`.
class GrowingFile {
 public:
  /// Keeps the first `keep` bytes of a file that is there, and appends to them.
  [[nodiscard]] static Result<GrowingFile> open(const std::filesystem::path& path,
                                                std::uintmax_t keep);
  [[nodiscard]] Result<void> append(std::string_view bytes);
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
};

/// Scalars for TensorBoard. One training has one file, even when it was resumed: TensorBoard takes
/// several files in a folder for one run, but shows the rows after the checkpoint twice then.
class EventLog {
 public:
  /// Opens an event file. TensorBoard finds those whose name has "tfevents" in it; the custom is
  /// events.out.tfevents.SECONDS.HOST.
  /// @param tags  names of the columns, e.g. "train/reward"; a slash makes a group.
  /// @param keep  last step that stays of a file that is there; also dropped is everything from the
  ///              first damaged record on (a kill may tear the last one).
  /// @return an error where the file cannot be written, or is there and is no event file.
  [[nodiscard]] static Result<EventLog> open(const std::filesystem::path& path,
                                             std::vector<std::string> tags,
                                             std::int64_t keep = kNoStep);

  /// Appends a row. A value that is not finite was not measured: it is left out.
  /// @param step       >= 0, larger than that of the row before.
  /// @param values     one a tag.
  /// @param wall_time  [s] since 1970, for the axis "wall" of TensorBoard; with the default equal
  ///                   runs give equal bytes. The file's first record has 0 in any case.
  [[nodiscard]] Result<void> append(std::int64_t step, std::span<const double> values,
                                    double wall_time = 0);

 private:
  EventLog(GrowingFile file, std::vector<std::string> tags)
      : file_(std::move(file)), tags_(std::move(tags)) {}
  GrowingFile file_;
  std::vector<std::string> tags_;
};

/// The same rows as comma-separated values: a header, then one line a row.
class CsvLog {
 public:
  /// @param columns  names of the columns after the first, "step"; without commas and quotes.
  /// @param keep     last step that stays of a file that is there; a line without an end is
  /// dropped.
  /// @return an error where the file cannot be written, or is there with another header.
  [[nodiscard]] static Result<CsvLog> open(const std::filesystem::path& path,
                                           std::vector<std::string> columns,
                                           std::int64_t keep = kNoStep);

  /// Appends a row; a value that is not finite becomes an empty field.
  /// @param step    >= 0, larger than that of the row before.  @param values  one a column.
  [[nodiscard]] Result<void> append(std::int64_t step, std::span<const double> values);

 private:
  CsvLog(GrowingFile file, std::size_t columns) : file_(std::move(file)), columns_(columns) {}
  GrowingFile file_;
  std::size_t columns_ = 0;
};

}  // namespace mjarm::rl
