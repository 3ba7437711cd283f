#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "mjarm/core/json.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm {

/// Reads a text line by line; a line has a bounded length, so that no input can eat the memory.
class LineReader {
 public:
  static constexpr std::size_t kLongestLine = std::size_t{1} << 20;  ///< [bytes] unless told

  /// Opens a file, or standard input for `-`.
  /// @param longest  [bytes] of a line.
  [[nodiscard]] static Result<LineReader> open(const std::string& path,
                                               std::size_t longest = kLongestLine);

  /// The next line that is not blank, without its end (LF or CRLF); none at the end of the input.
  /// The view holds until the next call. @return an error at reading, at a line that is too long
  /// and at Ctrl-C.
  [[nodiscard]] Result<std::optional<std::string_view>> next();

  /// `file:line` of the line last returned.
  [[nodiscard]] std::string place() const;
  /// Name of the input for messages.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// True for standard input, where somebody may be waiting for each answer.
  [[nodiscard]] bool is_stream() const { return is_stream_; }
  /// Lines of a regular file, for the progress bar; 0 for a stream.
  [[nodiscard]] std::uint64_t count_lines() const;

 private:
  struct Closer {
    void operator()(std::FILE* file) const {
      if (file != stdin) std::fclose(file);
    }
  };

  LineReader() = default;
  /// Reads up to the next line break; false at the end of the input.
  Result<bool> read_line();

  std::string path_, name_;
  std::unique_ptr<std::FILE, Closer> file_;
  bool is_stream_ = false;
  std::uint64_t line_ = 0;
  std::size_t longest_ = kLongestLine;
  std::string current_;
};

/// Gives `take` every line of a file, each one JSON object; blank lines are skipped.
/// @param longest  [bytes] of a line.
/// @return an error that begins with `file:line:` at the first line that is none, or that `take`
/// refuses.
[[nodiscard]] Result<void> read_json_lines(
    const std::filesystem::path& file, std::size_t longest,
    const std::function<Result<void>(const JsonValue& object)>& take);

}  // namespace mjarm
