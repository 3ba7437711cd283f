#include "apps/mjarm/cli/batch.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/core/threads.hpp"

namespace mjarm::app {
namespace {

/// One request on its way.
struct Line {
  std::string request, place, answer;
  Result<std::optional<std::string>> done;
};

constexpr std::size_t kBlock = 4096;                       // most requests of a block
constexpr std::size_t kBlockBytes = std::size_t{1} << 24;  // and of all of them together

/// Up to `count` requests, fewer where they are long; after an error those before it.
Result<void> read_block(LineReader& reader, std::size_t count, std::vector<Line>& lines) {
  lines.clear();
  std::size_t bytes = 0;
  while (lines.size() < count && bytes < kBlockBytes) {
    const Result<std::optional<std::string_view>> request = reader.next();
    if (!request) return fail(request.error());
    if (!*request) break;
    bytes += (*request)->size();
    lines.push_back({std::string(**request), reader.place(), {}, {}});
  }
  return {};
}

void answer_block(const AnswerLine& answer, int threads, std::vector<Line>& lines) {
  std::atomic<std::size_t> next = 0;
  run_in_threads(std::min(threads, static_cast<int>(lines.size())), [&](int) {
    for (std::size_t i = next++; i < lines.size(); i = next++) {
      lines[i].done = answer(lines[i].request, lines[i].answer);
      lines[i].answer += '\n';
    }
  });
}

}  // namespace

Result<AnswerOutput> AnswerOutput::open(const std::string& path, const Replace& replace) {
  const bool to_file = !path.empty() && path != "-";
  Result<LongResult> result = LongResult::begin(to_file ? path : "", replace);
  if (!result) return fail(std::move(result.error()));
  AnswerOutput output(std::move(*result));
  if (!to_file) return output;
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return fail(std::move(file.error()));
  output.file_ = std::move(*file);
  return output;
}

Result<void> AnswerOutput::write(std::string_view piece, bool now) {
  if (file_) return file_->write(piece);
  const bool written = std::fwrite(piece.data(), 1, piece.size(), stdout) == piece.size();
  if (written && (!now || std::fflush(stdout) == 0)) return {};
  return fail(Errc::system, text(msg::core_cannot_write, "stdout", system_message(errno)));
}

Result<void> AnswerOutput::finish() {
  if (!file_) return {};
  if (Result<void> written = file_->commit(); !written) return written;
  result_.made();
  return {};
}

void add_batch_options(CLI::App& app, BatchOptions& options) {
  add_option(app, "--in", options.in, msg::app_option_in, "FILE");
  add_option(app, "--out", options.out, msg::app_option_out, "FILE");
  add_overwrite_option(app, options.replace);
}

Result<void> one_source(const std::string& in, const std::string& one, const std::string& option) {
  if (in.empty() != one.empty()) return {};
  return fail(Errc::usage, text(msg::app_need_one_of, "--in", option));
}

Result<BatchResult> run_batch(const BatchOptions& options, const std::string& label,
                              const AnswerLine& answer) {
  Result<LineReader> reader = LineReader::open(options.in, options.longest_line);
  if (!reader) return fail(std::move(reader.error()));
  Result<AnswerOutput> output = AnswerOutput::open(options.out, options.replace);
  if (!output) return fail(std::move(output.error()));
  Progress progress(label, reader->count_lines());
  // Somebody may wait for each line of a stream; a file is taken in blocks that feed the threads.
  const bool stream = reader->is_stream() || options.threads <= 1;
  const std::size_t block =
      stream ? 1 : std::min(kBlock, 64 * static_cast<std::size_t>(options.threads));
  BatchResult result;
  std::vector<Line> lines;
  do {
    const Result<void> read = read_block(*reader, block, lines);
    answer_block(answer, options.threads, lines);
    for (const Line& line : lines) {
      if (!line.done)
        return fail(line.done.error().code,
                    text(msg::core_at_place, line.place, line.done.error().what));
      if (*line.done && result.failed++ == 0) {
        result.first_failure = line.place;
        result.first_why = **line.done;
      }
      ++result.requests;
      if (Result<void> written = output->write(line.answer, reader->is_stream()); !written) {
        return fail(std::move(written.error()));
      }
    }
    if (!read) return fail(read.error());
    progress.advance(lines.size());
  } while (!lines.empty());
  if (Result<void> written = output->finish(); !written) return fail(std::move(written.error()));
  return result;
}

Result<void> write_answer(AnswerOutput& output, const std::string& answer) {
  if (Result<void> written = output.write(answer + "\n", true); !written) return written;
  return output.finish();
}

Result<void> write_answer(const BatchOptions& options, const std::string& answer) {
  Result<AnswerOutput> output = AnswerOutput::open(options.out, options.replace);
  if (!output) return fail(std::move(output.error()));
  return write_answer(*output, answer);
}

Result<int> finish_one(AnswerOutput& output, const std::string& answer,
                       const std::optional<std::string>& why, Msg impossible) {
  if (Result<void> written = write_answer(output, answer); !written) {
    return fail(std::move(written.error()));
  }
  if (!why) return 0;
  log_error(text(impossible, *why));
  return 1;
}

Result<int> finish_one(const BatchOptions& options, const std::string& answer,
                       const std::optional<std::string>& why, Msg impossible) {
  Result<AnswerOutput> output = AnswerOutput::open(options.out, options.replace);
  if (!output) return fail(std::move(output.error()));
  return finish_one(*output, answer, why, impossible);
}

int finish_all(const BatchResult& result, Msg some_failed) {
  if (result.failed == 0) return 0;
  log_error(
      text(some_failed, result.first_failure, result.first_why, result.failed, result.requests));
  return 1;
}

}  // namespace mjarm::app
