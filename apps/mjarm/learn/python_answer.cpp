#include "apps/mjarm/learn/python_answer.hpp"

#include <algorithm>

#include "apps/mjarm/messages/learn.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/os_child_input.hpp"
#include "mjarm/core/trim.hpp"
#include "mjarm/core/utf8.hpp"

namespace mjarm::app {
namespace {

constexpr int kPythonSeconds = 60;  // of the clock
constexpr std::string_view kPythonAnswer = "mjarm-learn-answer ";
constexpr std::string_view kPythonAnswerEnd = " mjarm-learn-end";

/// Reads {"file", "function", "robot", "call", "cases", "seconds"} from standard input. The file
/// may end in `raise SystemExit`, as programs of the pages do; its name is not `__main__`.
constexpr std::string_view kHarness = R"(
import faulthandler, json, math, os, sys
task = json.loads(sys.stdin.readline())
faulthandler.dump_traceback_later(task["seconds"], exit=True)
file = task["file"]
sys.path.insert(0, os.path.dirname(os.path.abspath(file)))
for name, value in ("MPLBACKEND", "Agg"), ("OMP_NUM_THREADS", "1"), ("OPENBLAS_NUM_THREADS", "1"):
    os.environ.setdefault(name, value)
import mjarm, numpy
names = {"__name__": "exercise", "__file__": file}
with open(file, "rb") as opened:
    source = opened.read()
try:
    exec(compile(source, file, "exec"), names)
except SystemExit:
    pass
function = names.get(task["function"])
if not callable(function):
    raise SystemExit(f"{file}: no function {task['function']}")
count = function.__code__.co_argcount if hasattr(function, "__code__") else None
robot = mjarm.Robot(task["robot"])
call = eval("lambda function, robot, case, count: " + task["call"])

def told(value):
    if value is None:
        return {"refused": "None"}
    value = value.tolist() if hasattr(value, "tolist") else value
    rows = [row.tolist() if hasattr(row, "tolist") else row for row in value]
    rows = [rows] if rows and not hasattr(rows[0], "__len__") else rows
    rows = [[round(float(number), 12) for number in row] for row in rows]
    if not all(math.isfinite(number) for row in rows for number in row):
        return {"odd": "nan, inf"}
    return {"rows": rows}

out = []
for case in task["cases"]:
    try:
        value = call(function, robot, case, count)
    except (Exception, SystemExit) as why:
        out.append({"refused": f"{type(why).__name__}: {why}"[:120]})
        continue
    try:
        out.append(told(value))
    except (TypeError, ValueError):
        out.append({"odd": type(value).__name__})
print("\n" + "mjarm-learn-answer " + json.dumps({"cases": out}) + " mjarm-learn-end", file=sys.stderr, flush=True)
os._exit(0)
)";

std::string python_of(const Exercise& exercise) {
  if (!exercise.python.empty()) return exercise.python;
  return find_program("python3").empty() ? "python" : "python3";
}

/// `words` as a JSON string.
std::string json_string(std::string_view words) { return JsonDoc(words).line(); }

std::string task_line(const Exercise& exercise, const PythonTask& task) {
  std::string line =
      "{\"file\":" + json_string(exercise.file) + ",\"function\":" + json_string(task.function) +
      ",\"robot\":" + json_string(task.robot) + ",\"call\":" + json_string(task.call) +
      ",\"seconds\":" + std::to_string(kPythonSeconds) + ",\"cases\":[";
  for (std::size_t i = 0; i < task.cases.size(); ++i) line += (i > 0 ? "," : "") + task.cases[i];
  return line + "]}\n";
}

/// The last line of what Python said that is not empty: the exception.
std::string last_words(std::string_view said) {
  std::string_view last;
  while (!said.empty()) {
    const std::size_t end = std::min(said.find('\n'), said.size());
    if (const std::string_view line = trimmed(said.substr(0, end)); !line.empty()) last = line;
    said.remove_prefix(std::min(end + 1, said.size()));
  }
  constexpr std::size_t kMaxWords = 300;  // [bytes]
  return printable(last.substr(0, kMaxWords));
}

Error python_failed(const Exercise& exercise, const std::string& said) {
  if (said.find("Timeout (0:") != std::string::npos) {
    return {Errc::bad_input, text(msg::learn_python_slow, exercise.file, kPythonSeconds)};
  }
  if (said.rfind(kPythonAnswerEnd) != std::string::npos) {
    return {Errc::bad_input, text(msg::learn_python_long, exercise.file)};
  }
  const std::string words = last_words(said);
  if (words.find("No module named 'mjarm'") != std::string::npos) {
    return {Errc::bad_input, text(msg::learn_python_no_mjarm, python_of(exercise))};
  }
  return {Errc::bad_input, text(msg::learn_python_failed, exercise.file, words)};
}

PythonCase case_of(const JsonValue& told) {
  PythonCase out;
  if (const JsonValue* const refused = told.find("refused")) out.refused = refused->string();
  if (const JsonValue* const odd = told.find("odd")) out.odd = odd->string();
  if (const JsonValue* const rows = told.find("rows")) {
    for (const JsonValue& row : *rows) {
      std::vector<double>& values = out.rows.emplace_back();
      for (const JsonValue& value : row) values.push_back(value.number());
    }
  }
  return out;
}

}  // namespace

Result<std::vector<PythonCase>> ask_python(const Exercise& exercise, const PythonTask& task) {
  Result<FedProgram> python = FedProgram::start(python_of(exercise), {"-c", std::string(kHarness)});
  if (!python) return fail(python.error());
  (void)python->feed(task_line(exercise, task));  // where it has ended, finish() tells why
  const Result<FedProgramEnd> end = python->finish();
  if (!end) return fail(end.error());
  const std::string& said = end->complaints;
  const std::size_t at = said.rfind(kPythonAnswer);
  if (at == std::string::npos) return fail(python_failed(exercise, said));
  const std::size_t begin = at + kPythonAnswer.size(), finish = said.rfind(kPythonAnswerEnd);
  if (finish == std::string::npos || finish < begin) return fail(python_failed(exercise, said));
  const std::string_view answer = std::string_view(said).substr(begin, finish - begin);
  const Result<JsonObject> object = parse_json_object(answer);
  const JsonValue* const cases = object ? (*object)->find("cases") : nullptr;
  if (cases == nullptr || cases->size() != task.cases.size()) {
    return fail(python_failed(exercise, said));
  }
  std::vector<PythonCase> out;
  for (const JsonValue& told : *cases) out.push_back(case_of(told));
  return out;
}

}  // namespace mjarm::app
