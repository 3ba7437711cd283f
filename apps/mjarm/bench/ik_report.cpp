#include "apps/mjarm/bench/ik_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <map>
#include <numeric>
#include <tuple>

#include "mjarm/core/cpu.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/bench.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/core/text_width.hpp"

namespace mjarm::app {
namespace {

using Row = std::vector<std::string>;

/// What the processor calls itself; empty where unknown.
std::string processor() {
  const std::string info = read_file("/proc/cpuinfo").value_or("");
  const std::size_t at = info.find("model name");
  if (at == std::string::npos) return {};
  const std::size_t from = info.find(": ", at) + 2;
  return info.substr(from, info.find('\n', from) - from);
}

std::string today() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  char date[16] = "";
  std::tm utc{};
  if (const std::tm* parts = std::gmtime(&now)) utc = *parts;
  std::strftime(date, sizeof date, "%Y-%m-%d", &utc);
  return date;
}

/// Ours on the same set, against which the others are measured: its numeric solver is a contestant.
const IkRun* ours(const IkResult& result, const std::string& set) {
  for (const IkRun& run : result.runs) {
    if (run.set == set && run.who == "mjarm") return &run;
  }
  return nullptr;
}

/// How many times as long as ours; 0 where that cannot be told.
double ratio_of(const IkResult& result, const IkRun& run) {
  const IkRun* mine = ours(result, run.set);
  if (mine == nullptr || run.us.empty()) return 0;
  const double us = times_of(*mine).median;
  return us > 0 ? times_of(run).median / us : 0;
}

std::string rounded(double value) {
  const int decimals = value >= 100 ? 0 : value >= 10 ? 1 : value >= 1 ? 2 : 3;
  return fmt::format("{:.{}f}", value, decimals);
}

/// Right answers of those asked for; what is right to the last case shows no decimals. Who was slow
/// did only the first cases.
std::string share_of(const IkRun& run) {
  const std::size_t asked = run.q.size();
  if (asked == 0) return "-";
  const double share = 100.0 * run.right / static_cast<double>(asked);
  const std::string words = fmt::format("{:.{}f} %", share, run.wrong.empty() ? 0 : 1);
  return asked == run.cases ? words : words + " " + text(msg::bench_ik_first, asked);
}

Row row_of(const IkResult& result, const IkRun& run, bool timing) {
  const std::string who = run.version.empty() ? run.who : run.who + " " + run.version;
  if (!run.error.empty()) return {"-", who, run.error};
  Row row{run.set, who, share_of(run)};
  if (!timing) return row;
  const Times times = times_of(run);
  row.push_back(rounded(times.median));
  row.push_back(run.us.size() > 1 ? rounded(times.p99) : "-");
  row.push_back(ours(result, run.set) == &run ? "1" : rounded(ratio_of(result, run)));
  row.push_back(run.timed);
  return row;
}

std::string aligned(const std::vector<Row>& rows) {
  std::vector<int> widths;
  for (const Row& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], text_width(row[i]));
    }
  }
  std::string out;
  for (const Row& row : rows) {
    out += '|';
    for (std::size_t i = 0; i < row.size(); ++i) out += " " + padded(row[i], widths[i]) + " |";
    out += '\n';
    if (&row != rows.data()) continue;
    for (const int width : widths) {
      out += "|" + std::string(static_cast<std::size_t>(width) + 2, '-');
    }
    out += "|\n";
  }
  return out;
}

/// The runs of one set together, ours first, then from fast to slow.
std::vector<std::size_t> order_of(const IkResult& result) {
  std::map<std::string, std::size_t> first;  // the sets in the order of their first run
  for (std::size_t i = 0; i < result.runs.size(); ++i) first.emplace(result.runs[i].set, i);
  std::vector<std::size_t> order(result.runs.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](std::size_t i) {
    const IkRun& run = result.runs[i];
    const bool failed = !run.error.empty();
    return std::make_tuple(failed, first.at(run.set), run.version.empty() ? 0 : 1,
                           run.version.empty() ? 0.0 : times_of(run).median, i);
  };
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  return order;
}

void append_misses(std::string& out, const IkRun& run) {
  out += ",\"misses\":[";
  for (const std::size_t at : run.wrong) {
    if (out.back() == '}') out += ',';
    out += "{\"case\":" + std::to_string(at) + ",\"reason\":";
    append_json_string(out, at < run.reasons.size() ? run.reasons[at] : "");
    out += '}';
  }
  out += ']';
}

void append_run(std::string& out, const IkResult& result, const IkRun& run, bool timing) {
  out += "{\"who\":";
  append_json_string(out, run.who);
  if (!run.version.empty()) {
    out += ",\"version\":";
    append_json_string(out, run.version);
  }
  if (!run.error.empty()) {
    out += ",\"error\":";
    append_json_string(out, run.error);
    out += '}';
    return;
  }
  out += ",\"set\":";
  append_json_string(out, run.set);
  if (!run.q.empty()) {
    out += ",\"cases\":" + std::to_string(run.q.size()) +
           ",\"right\":" + std::to_string(run.right) +
           ",\"false_ok\":" + std::to_string(run.false_ok);
    append_misses(out, run);
  }
  if (run.set == "path" || run.set == "track") out += ",\"max_step\":" + number(run.max_step);
  if (timing) {
    const Times times = times_of(run);
    out += ",\"timed\":\"" + run.timed + "\",\"us\":{\"median\":" + number(times.median) +
           ",\"p99\":" + number(times.p99) + "},\"ratio\":" + number(ratio_of(result, run));
  }
  out += '}';
}

}  // namespace

std::string bench_occasion() {
  const std::string cpu = processor();
  return (cpu.empty() ? std::string() : cpu + ", ") + std::string(name(simd_level())) + "; " +
         today();
}

std::string ik_table(const std::vector<IkResult>& results, bool timing) {
  std::string out;
  if (timing) out += bench_occasion() + "\n\n";
  for (const IkResult& result : results) {
    out += text(msg::bench_ik_robot, result.robot, result.file) + "\n\n";
    Row head{text(msg::bench_ik_case), text(msg::bench_ik_who), text(msg::bench_ik_right)};
    if (timing) {
      for (const Msg column :
           {msg::bench_ik_median, msg::bench_ik_p99, msg::bench_ik_ratio, msg::bench_ik_clock}) {
        head.push_back(text(column));
      }
    }
    std::vector<Row> rows{head};
    for (const std::size_t i : order_of(result))
      rows.push_back(row_of(result, result.runs[i], timing));
    out += aligned(rows) + '\n';
  }
  return out;
}

std::string ik_json(const std::vector<IkResult>& results, bool timing) {
  std::string out = "{";
  if (timing) {
    out += "\"machine\":";
    append_json_string(out, bench_occasion());
    out += ',';
  }
  out += "\"robots\":[";
  for (const IkResult& result : results) {
    if (&result != results.data()) out += ',';
    out += "{\"robot\":";
    append_json_string(out, result.robot);
    out += ",\"runs\":[";
    for (const std::size_t i : order_of(result)) {
      if (out.back() == '}') out += ',';
      append_run(out, result, result.runs[i], timing);
    }
    out += "]}";
  }
  return out + "]}\n";
}

}  // namespace mjarm::app
