#include "apps/bench/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/mjarm/cli/table.hpp"
#include "mjarm/core/cpu.hpp"
#include "mjarm/core/file.hpp"

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
const BenchEntry* ours(const BenchResult& result, const std::string& set) {
  for (const BenchEntry& entry : result.entries) {
    if (entry.set == set && entry.who == "mjarm") return &entry;
  }
  return nullptr;
}

/// How many times as long as ours; 0 where that cannot be told.
double ratio_of(const BenchResult& result, const BenchEntry& entry) {
  if (entry.ratio > 0) return entry.ratio;
  const BenchEntry* mine = ours(result, entry.set);
  if (mine == nullptr || entry.us.empty()) return 0;
  const double us = times_of(mine->us).median;
  return us > 0 ? times_of(entry.us).median / us : 0;
}

Row row_of(const BenchResult& result, const BenchEntry& entry, bool timing) {
  const std::string who = entry.version.empty() ? entry.who : entry.who + " " + entry.version;
  if (!entry.error.empty()) return {entry.set.empty() ? "-" : entry.set, who, entry.error};
  Row row{entry.set, who};
  row.insert(row.end(), entry.cells.begin(), entry.cells.end());
  if (!timing) return row;
  const Times times = times_of(entry.us);
  row.push_back(entry.us.empty() ? "-" : rounded(times.median));
  row.push_back(entry.us.size() > 1 ? rounded(times.p99) : "-");
  const double ratio = ratio_of(result, entry);
  row.push_back(ours(result, entry.set) == &entry ? "1" : ratio > 0 ? rounded(ratio) : "-");
  row.push_back(entry.timed);
  return row;
}

std::vector<std::size_t> order_of(const BenchResult& result) {
  std::map<std::string, std::size_t> first;  // the sets in the order of their first entry
  for (std::size_t i = 0; i < result.entries.size(); ++i) {
    first.emplace(result.entries[i].set, i);
  }
  std::vector<std::size_t> order(result.entries.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](std::size_t i) {
    const BenchEntry& entry = result.entries[i];
    const bool failed = !entry.error.empty();
    return std::make_tuple(failed, first.at(entry.set), entry.version.empty() ? 0 : 1,
                           entry.version.empty() ? 0.0 : times_of(entry.us).median, i);
  };
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  return order;
}

JsonDoc json_of(const BenchResult& result, const BenchEntry& entry, bool timing) {
  JsonDoc out{{"who", entry.who}};
  if (!entry.version.empty()) out.set("version", entry.version);
  if (!entry.set.empty()) out.set("set", entry.set);
  if (!entry.error.empty()) {
    out.set("error", entry.error);
    return out;
  }
  out.set_all(entry.details);
  if (timing) {
    const Times times = times_of(entry.us);
    out.set("timed", entry.timed);
    out.set("us", {{"median", times.median}, {"p99", times.p99}});
    out.set("ratio", ratio_of(result, entry));
  }
  return out;
}

}  // namespace

Times times_of(std::vector<double> us) {
  if (us.empty()) return {};
  std::sort(us.begin(), us.end());
  return {us[us.size() / 2], us[us.size() * 99 / 100]};
}

std::string rounded(double value) {
  const int decimals = value >= 100 ? 0 : value >= 10 ? 1 : value >= 1 ? 2 : 3;
  return fmt::format("{:.{}f}", value, decimals);
}

std::string bench_occasion() {
  const std::string cpu = processor();
  return (cpu.empty() ? std::string() : cpu + ", ") + std::string(name(simd_level())) + "; " +
         today();
}

std::string bench_table(const std::vector<BenchResult>& results, const std::vector<Msg>& columns,
                        bool timing) {
  std::vector<Msg> headings{msg::bench_case, msg::bench_who};
  headings.insert(headings.end(), columns.begin(), columns.end());
  if (timing) {
    headings.insert(headings.end(),
                    {msg::bench_median, msg::bench_p99, msg::bench_ratio, msg::bench_clock});
  }
  Row head;
  for (const Msg heading : headings) head.push_back(text(heading));
  std::string out;
  if (timing) out += bench_occasion() + "\n\n";
  for (const BenchResult& result : results) {
    out += result.file.empty() ? result.robot : text(msg::bench_robot, result.robot, result.file);
    out += "\n\n";
    std::vector<Row> rows{head};
    for (const std::size_t i : order_of(result)) {
      rows.push_back(row_of(result, result.entries[i], timing));
    }
    out += markdown_table(rows) + '\n';
  }
  return out;
}

std::string bench_json(const std::vector<BenchResult>& results, bool timing) {
  std::vector<JsonDoc> robots;
  for (const BenchResult& result : results) {
    std::vector<JsonDoc> runs;
    for (const std::size_t i : order_of(result)) {
      runs.push_back(json_of(result, result.entries[i], timing));
    }
    robots.push_back({{"robot", result.robot}, {"runs", std::move(runs)}});
  }
  JsonDoc out;
  if (timing) out.set("machine", bench_occasion());
  out.set("robots", std::move(robots));
  return out.line() + '\n';
}

}  // namespace mjarm::app
