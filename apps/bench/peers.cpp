#include "apps/bench/peers.hpp"

#include <limits>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/robots.hpp"
#include "apps/bench/scratch_folder.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/os_program.hpp"
#include "mjarm/core/share.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;

fs::path python_of(const fs::path& environment) { return environment / "bin" / "python"; }

Result<fs::path> find_script(const std::string& suite) {
  const Result<fs::path> share = share_folder();
  if (!share) return fail(share.error());
  fs::path script = *share / "bench" / "peers" / (suite + ".py");
  if (is_there(script)) return script;
  return fail(Errc::not_available, text(msg::bench_no_script, script.string()));
}

/// Member `key`, which satisfies `is`.
const JsonValue& member(const JsonValue& line, const char* key, bool (JsonValue::*is)() const) {
  const JsonValue* const found = line.find(key);
  if (found == nullptr || !(found->*is)()) broken(key);
  return *found;
}

/// A text that may be missing.
std::string text_or_nothing(const JsonValue& line, const char* key) {
  return line.contains(key) ? text_in(line, key) : std::string();
}

/// All entries of a list by `read`; none of null. `key` stands for the list where it is broken.
template <class Read>
auto list_of(const JsonValue& list, const char* key, const Read& read) {
  std::vector<decltype(read(list, key))> values;
  if (!list.is_list() && !list.is_null()) broken(key);
  for (const JsonValue& entry : list) values.push_back(read(entry, key));
  return values;
}

double number_of(const JsonValue& value, const char* key) {
  if (!value.is_number()) broken(key);
  return value.number();
}
double number_or_nan(const JsonValue& value, const char* key) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : number_of(value, key);
}
std::vector<double> row_of(const JsonValue& value, const char* key) {
  return list_of(value, key, number_of);
}
std::vector<std::vector<double>> rows_of(const JsonValue& value, const char* key) {
  return list_of(value, key, row_of);
}

Result<void> take_line(std::string_view line, const TakeAnswer& take) {
  const Result<JsonObject> object = parse_json_object(line);
  if (!object) return fail(Errc::system, text(msg::bench_bad_answer, object.error().what));
  const JsonValue& answer = **object;
  try {
    BenchEntry entry{.who = text_in(answer, "who"),
                     .version = text_or_nothing(answer, "version"),
                     .set = text_or_nothing(answer, "set"),
                     .timed = text_or_nothing(answer, "timed"),
                     .error = text_or_nothing(answer, "error")};
    if (const JsonValue* const us = answer.find("us")) entry.us = row_of(*us, "us");
    take(std::move(entry), answer);
    return {};
  } catch (const BrokenAnswer& answer_is) {
    return fail(answer_is.error);
  }
}

}  // namespace

void broken(const std::string& member) {
  throw BrokenAnswer{{Errc::system, text(msg::bench_bad_answer, member)}};
}

std::vector<std::vector<double>> rows_in(const JsonValue& line, const char* key) {
  const JsonValue* const found = line.find(key);
  if (found == nullptr) return {};
  return rows_of(*found, key);
}

std::vector<std::vector<std::vector<double>>> tables_in(const JsonValue& line, const char* key) {
  const JsonValue* const found = line.find(key);
  if (found == nullptr) return {};
  return list_of(*found, key, rows_of);
}

const JsonValue& list_in(const JsonValue& line, const char* key) {
  return member(line, key, &JsonValue::is_list);
}

std::vector<double> numbers_in(const JsonValue& line, const char* key) {
  return list_of(list_in(line, key), key, number_or_nan);
}

double number_in(const JsonValue& line, const char* key) {
  return member(line, key, &JsonValue::is_number).number();
}

std::string text_in(const JsonValue& line, const char* key) {
  return member(line, key, &JsonValue::is_string).string();
}

Result<void> check_peers(const fs::path& environment) {
  const fs::path python = python_of(environment);
  if (environment.empty() || is_there(python)) return {};
  return fail(Errc::bad_input, text(msg::bench_no_python, python.string()));
}

Result<void> run_peers(const fs::path& environment, const std::string& suite, JsonDoc job,
                       const TakeAnswer& take) {
  const Result<fs::path> script = find_script(suite);
  if (!script) return fail(script.error());
  const ScratchFolder folder("bench");
  const fs::path job_file = folder.path() / "job.json";
  const fs::path answer_file = folder.path() / "answer.jsonl";
  job.set("folder", folder.path().string());
  if (auto written = write_file(job_file, job.line()); !written) return fail(written.error());
  const Result<int> code = run_program(python_of(environment),
                                       {script->string(), job_file.string(), answer_file.string()});
  if (!code) return fail(code.error());
  if (*code != 0) return fail(Errc::system, text(msg::bench_peers_failed, *code));
  const Result<std::string> content = read_file(answer_file);
  if (!content) return fail(content.error());
  std::size_t from = 0;
  for (std::size_t to = content->find('\n'); to != std::string::npos;
       from = to + 1, to = content->find('\n', from)) {
    const std::string_view line(content->data() + from, to - from);
    if (auto taken = take_line(line, take); !taken) return taken;
  }
  return {};
}

}  // namespace mjarm::app
