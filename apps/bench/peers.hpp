#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "apps/bench/suite.hpp"
#include "mjarm/core/json.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// Thrown where an answer of a peer cannot be taken; `run_peers` reports it.
struct BrokenAnswer {
  Error error;
};
/// The same where a member is missing, of another type or does not fit the others.
[[noreturn]] void broken(const std::string& member);

/// Rows of numbers, one a case; empty ones for null, no rows where the member is missing.
[[nodiscard]] std::vector<std::vector<double>> rows_in(const JsonValue& line, const char* key);
/// Such rows of every path; none where the member is missing.
[[nodiscard]] std::vector<std::vector<std::vector<double>>> tables_in(const JsonValue& line,
                                                                      const char* key);
/// Numbers; NaN for null. The member has to be there.
[[nodiscard]] std::vector<double> numbers_in(const JsonValue& line, const char* key);
/// A number; has to be there as well.
[[nodiscard]] double number_in(const JsonValue& line, const char* key);
/// A text; has to be there as well.
[[nodiscard]] std::string text_in(const JsonValue& line, const char* key);
/// A list of objects, texts, ...; has to be there.
[[nodiscard]] const JsonValue& list_in(const JsonValue& line, const char* key);

/// Takes one answer of a peer: the entry with everything but cells and details, and the line it
/// came in, whose members may be of any type. Throws `BrokenAnswer`.
using TakeAnswer = std::function<void(BenchEntry entry, const JsonValue& line)>;

/// Whether there is such an environment, where one is named: to be asked before anything is
/// measured.
[[nodiscard]] Result<void> check_peers(const std::filesystem::path& environment);

/// Runs the peers of a Python environment on one job, each in a process and a loop of its own
/// (`bench/peers/SUITE.py`). A peer that fails has an answer that says why.
/// @param environment  folder of a virtual environment with some of the peers in it.
/// @param job          all that a peer has to know; gets `folder`, where it may leave files for
///                     as long as `take` is called.
/// @return an error where the environment has no Python, an answer is broken, or the user stopped
///         it.
[[nodiscard]] Result<void> run_peers(const std::filesystem::path& environment,
                                     const std::string& suite, JsonDoc job, const TakeAnswer& take);

/// The same where each answer is a run: `read(line, run)` adds to its entry what the suite looks
/// at, and is not called for a peer that failed. The runs are not judged yet.
template <class Run, class Read>
Result<std::vector<Run>> peer_runs(const std::filesystem::path& environment,
                                   const std::string& suite, JsonDoc job, const Read& read) {
  std::vector<Run> runs;
  const auto take = [&](BenchEntry entry, const JsonValue& line) {
    Run& run = runs.emplace_back(Run{std::move(entry)});
    if (run.error.empty()) read(line, run);
  };
  if (auto done = run_peers(environment, suite, std::move(job), take); !done) {
    return fail(std::move(done.error()));
  }
  return runs;
}

}  // namespace mjarm::app
