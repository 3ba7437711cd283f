#include "apps/bench/suite.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cstdio>
#include <ctime>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <numeric>
#include <tuple>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/peers.hpp"
#include "apps/mjarm/cli/batch.hpp"
#include "apps/mjarm/cli/table.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/cpu.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/log.hpp"

namespace mjarm::app {
namespace {

using Row = std::vector<std::string>;

/// What the processor calls itself, and a comma; empty where unknown.
std::string processor() {
  const std::string info = read_file("/proc/cpuinfo").value_or("");
  const std::size_t at = info.find("model name");
  if (at == std::string::npos) return {};
  const std::size_t from = info.find(": ", at) + 2;
  return info.substr(from, info.find('\n', from) - from) + ", ";
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
  const double us = percentile(mine->us, 50);
  return us > 0 ? percentile(entry.us, 50) / us : 0;
}

Row row_of(const BenchResult& result, const BenchEntry& entry, bool timing) {
  const std::string who = entry.version.empty() ? entry.who : entry.who + " " + entry.version;
  if (!entry.error.empty()) return {entry.set.empty() ? "-" : entry.set, who, entry.error};
  Row row{entry.set, who};
  row.insert(row.end(), entry.cells.begin(), entry.cells.end());
  if (!timing) return row;
  row.push_back(entry.us.empty() ? "-" : rounded(percentile(entry.us, 50)));
  row.push_back(entry.us.size() > 1 ? rounded(percentile(entry.us, 99)) : "-");
  const double ratio = ratio_of(result, entry);
  row.push_back(ours(result, entry.set) == &entry ? "1" : ratio > 0 ? rounded(ratio) : "-");
  row.push_back(entry.timed);
  return row;
}

/// The entries of a set together, ours first, then from fast to slow.
std::vector<const BenchEntry*> in_order(const BenchResult& result) {
  std::map<std::string, std::size_t> first;  // the sets in the order of their first entry
  std::vector<const BenchEntry*> order;
  for (const BenchEntry& entry : result.entries) {
    first.emplace(entry.set, order.size());
    order.push_back(&entry);
  }
  std::ranges::stable_sort(order, {}, [&](const BenchEntry* entry) {
    const bool peer = !entry->version.empty();
    return std::make_tuple(!entry->error.empty(), first.at(entry->set), peer,
                           peer ? percentile(entry->us, 50) : 0.0);
  });
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
    out.set("timed", entry.timed);
    out.set("us", {{"median", percentile(entry.us, 50)}, {"p99", percentile(entry.us, 99)}});
    out.set("ratio", ratio_of(result, entry));
  }
  return out;
}

/// One table a robot in Markdown, aligned, so that it also reads well on a terminal.
std::string table_of(const std::vector<BenchResult>& results, const std::vector<Msg>& columns,
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
    for (const BenchEntry* entry : in_order(result)) rows.push_back(row_of(result, *entry, timing));
    out += markdown_table(rows) + '\n';
  }
  out.pop_back();  // whoever writes it adds a line break
  return out;
}

/// The same with all details, as one JSON document.
std::string json_of(const std::vector<BenchResult>& results, bool timing) {
  std::vector<JsonDoc> robots;
  for (const BenchResult& result : results) {
    std::vector<JsonDoc> runs;
    for (const BenchEntry* entry : in_order(result)) {
      runs.push_back(json_of(result, *entry, timing));
    }
    robots.push_back({{"robot", result.robot}, {"runs", std::move(runs)}});
  }
  JsonDoc out;
  if (timing) out.set("machine", bench_occasion());
  out.set("robots", std::move(robots));
  return out.line();
}

Result<int> report(const ReportOptions& options, const std::vector<BenchResult>& results,
                   const std::vector<Msg>& columns, AnswerOutput& output) {
  const bool timing = !options.no_timing;
  const std::string out =
      options.json ? json_of(results, timing) : table_of(results, columns, timing);
  if (auto written = write_answer(output, out); !written) return fail(std::move(written.error()));
  for (const BenchResult& result : results) {
    if (!result.wrong.empty()) return fail(Errc::impossible, result.wrong);
  }
  return 0;
}

Result<int> run_robots(const BenchOptions& options, std::vector<std::string> robots,
                       const std::vector<Msg>& columns, BenchRobot measure) {
  constexpr int kMaxRounds = 10'000;
  const Result<int> rounds = parse_count("--rounds", options.rounds, kMaxRounds);
  if (!rounds) return fail(rounds.error());
  if (Result<void> there = check_peers(options.peers); !there) return fail(there.error());
  Result<AnswerOutput> output = AnswerOutput::open(options.out, options.replace);
  if (!output) return fail(std::move(output.error()));
  if (!options.robot.empty()) robots = {options.robot};
  std::vector<BenchResult> results;
  for (const std::string& robot : robots) {
    Result<BenchResult> result = measure(options, robot, *rounds);
    if (!result) return fail(std::move(result.error()));
    results.push_back(std::move(*result));
  }
  return report(options, results, columns, *output);
}

}  // namespace

double percentile(std::vector<double> values, std::size_t percent) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return values[values.size() * percent / 100];
}

void print_robot(const ReportOptions& options, const Robot& robot, const std::string& tables,
                 const JsonDoc& doc) {
  const std::string table = (options.no_timing ? "" : bench_occasion() + "\n\n") +
                            std::string(robot.model.name()) + "\n\n" + tables;
  std::fputs((options.json ? doc.document() : table).c_str(), stdout);
}

std::string rounded(double value) {
  const int decimals = value >= 100 ? 0 : value >= 10 ? 1 : value >= 1 ? 2 : 3;
  return fmt::format("{:.{}f}", value, decimals);
}

std::string count_of(int count, std::size_t asked, std::size_t cases) {
  const std::string all = fmt::format("{}/{}", count, asked);
  return asked < cases ? all + " " + text(msg::bench_first, asked) : all;
}

std::string bench_occasion() {
  return fmt::format("{}{}; {:%Y-%m-%d}", processor(), name(simd_level()),
                     fmt::gmtime(std::time(nullptr)));
}

void add_report_options(CLI::App& app, ReportOptions& options) {
  add_flag(app, "--json", options.json, msg::app_option_json);
  add_flag(app, "--no-timing", options.no_timing, msg::app_option_no_timing);
}

Result<int> report_in_folder(const ReportOptions& options, const std::vector<BenchResult>& results,
                             const std::vector<Msg>& columns, const OutputFolder& folder,
                             const std::function<Result<void>()>& write_more, Msg told) {
  Result<void> done =
      write_file(folder.path() / "bench.json", json_of(results, !options.no_timing) + '\n');
  if (done) done = write_more();
  if (!done) return fail(std::move(done.error()));
  folder.made();
  Result<AnswerOutput> output = AnswerOutput::open({}, {});
  if (!output) return fail(std::move(output.error()));
  Result<int> code = report(options, results, columns, *output);
  log_info(text(told, folder.path().string()));
  return code;
}

Run setup_robots(CLI::App& app, Msg data_help, bool tool, std::vector<Msg> columns,
                 BenchRobot measure, std::vector<BenchVariant> variants) {
  auto options = std::make_shared<BenchOptions>();
  add_option(app, "--robot", options->robot, msg::bench_option_robot, "ROBOT");
  add_option(app, "--data", options->data, data_help, "DIR");
  add_option(app, "--peers", options->peers, msg::bench_option_peers, "VENV");
  add_option(app, "--rounds", options->rounds, msg::bench_option_rounds, "N");
  add_option(app, "--out", options->out, msg::bench_option_out, "FILE");
  add_overwrite_option(app, options->replace);
  add_report_options(app, *options);
  if (tool) add_option(app, "--tip", options->tip, msg::app_option_tip, "FRAME");
  if (!variants.empty()) add_option(app, "--seed", options->seed, msg::app_option_seed, "N");
  auto chosen = std::make_shared<std::deque<bool>>(variants.size());
  for (std::size_t i = 0; i < variants.size(); ++i) {
    add_flag(app, variants[i].flag, (*chosen)[i], variants[i].help);
  }
  return [=, columns = std::move(columns), variants = std::move(variants)] {
    for (std::size_t i = 0; i < variants.size(); ++i) {
      if (!(*chosen)[i]) continue;
      return run_robots(*options, {"ur5e"}, variants[i].columns, variants[i].measure);
    }
    return run_robots(*options, {"ur5e", "panda"}, columns, measure);
  };
}

bool wants_peers(const std::string& peers, const std::string& robot) {
  if (peers.empty()) return false;
  log_info(text(msg::bench_running_peers, robot));
  return true;
}

Error stopped() { return {Errc::system, text(msg::app_interrupted)}; }

BenchEntry our_entry(std::string who, std::string set, std::size_t count) {
  return {.who = std::move(who),
          .set = std::move(set),
          .timed = "c++",
          .us = std::vector<double>(count, std::numeric_limits<double>::infinity())};
}

}  // namespace mjarm::app
