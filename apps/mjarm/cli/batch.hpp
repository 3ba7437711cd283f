#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "apps/mjarm/cli/options.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/line_reader.hpp"
#include "mjarm/core/long_result.hpp"
#include "mjarm/core/messages.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// Where requests come from and answers go to.
struct BatchOptions {
  std::string in;   ///< file of JSON lines, `-` = standard input
  std::string out;  ///< file, `-` or empty = standard output
  Replace replace = {};
  int threads = 1;                                      ///< >= 1
  std::size_t longest_line = LineReader::kLongestLine;  ///< [bytes]
};

/// Adds `--in FILE`, `--out FILE` and `--overwrite`, bound to `options`.
void add_batch_options(CLI::App& app, BatchOptions& options);

/// Checks that requests come either from `--in` or from `option` (value `one`), not from both.
[[nodiscard]] Result<void> one_source(const std::string& in, const std::string& one,
                                      const std::string& option);

/// Answers one request: appends the answer to `out`, without a line break. Returns why the request
/// could not be done, nothing where it was. An error is a malformed request; it says what is wrong,
/// not where. Called from several threads at once where `BatchOptions::threads` is not 1.
using AnswerLine =
    std::function<Result<std::optional<std::string>>(std::string_view request, std::string& out)>;

/// How a batch went.
struct BatchResult {
  std::uint64_t requests = 0;
  std::uint64_t failed = 0;   ///< well-formed, but could not be done
  std::string first_failure;  ///< `file:line` of the first of them
  std::string first_why;      ///< why it could not be done
};

/// Answers all requests in order, one line each; blank lines are skipped. A file named by `out`
/// appears only when every request was well-formed; standard output gets every answer as it is
/// ready. The answers are the same bytes whatever the number of threads.
/// @param label  what the progress bar says.
/// @return an error that begins with `file:line:` at the first malformed request.
[[nodiscard]] Result<BatchResult> run_batch(const BatchOptions& options, const std::string& label,
                                            const AnswerLine& answer);

/// Where answers go piece by piece: standard output, or a file that appears at the end.
class AnswerOutput {
 public:
  /// @param path  a file, `-` or empty.
  [[nodiscard]] static Result<AnswerOutput> open(const std::string& path, const Replace& replace);
  /// @param now  somebody waits for this very piece.
  [[nodiscard]] Result<void> write(std::string_view piece, bool now);
  /// Call once, last: a file takes its place.
  [[nodiscard]] Result<void> finish();

 private:
  explicit AnswerOutput(LongResult result) : result_(std::move(result)) {}
  LongResult result_;
  std::optional<AtomicFile> file_;
};

/// Writes the only answer, one line.
[[nodiscard]] Result<void> write_answer(AnswerOutput& output, const std::string& answer);
/// The same to `BatchOptions::out`, for answers that are quick.
[[nodiscard]] Result<void> write_answer(const BatchOptions& options, const std::string& answer);

/// Writes the answer to a single request. Where it could not be done, for `why`, the text
/// `impossible` (why) is logged.
/// @return the exit code.
[[nodiscard]] Result<int> finish_one(AnswerOutput& output, const std::string& answer,
                                     const std::optional<std::string>& why, Msg impossible);
/// The same to `BatchOptions::out`, for answers that are quick.
[[nodiscard]] Result<int> finish_one(const BatchOptions& options, const std::string& answer,
                                     const std::optional<std::string>& why, Msg impossible);

/// Logs the text `some_failed` (place, why, failed, requests) where requests could not be done.
/// @return the exit code.
[[nodiscard]] int finish_all(const BatchResult& result, Msg some_failed);

}  // namespace mjarm::app
