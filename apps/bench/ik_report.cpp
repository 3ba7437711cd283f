#include "apps/bench/ik_report.hpp"

#include <fmt/format.h>

#include <utility>

#include "apps/bench/messages/bench.hpp"

namespace mjarm::app {
namespace {

/// Right answers of those asked for; what is right to the last case shows no decimals. Who was slow
/// did only the first cases.
std::string share_of(const IkRun& run) {
  const std::size_t asked = run.q.size();
  if (asked == 0) return "-";
  const double share = 100.0 * run.right / static_cast<double>(asked);
  const std::string words = fmt::format("{:.{}f} %", share, run.wrong.empty() ? 0 : 1);
  return asked == run.cases ? words : words + " " + text(msg::bench_first, asked);
}

}  // namespace

std::vector<Msg> ik_columns() { return {msg::bench_ik_right}; }

BenchEntry ik_entry(const IkRun& run) {
  BenchEntry entry = run;
  entry.cells = {share_of(run)};
  if (!run.q.empty()) {
    std::vector<JsonDoc> misses;
    for (const std::size_t at : run.wrong) {
      misses.push_back({{"case", at}, {"reason", at < run.reasons.size() ? run.reasons[at] : ""}});
    }
    entry.details = {{"cases", run.q.size()},
                     {"right", run.right},
                     {"false_ok", run.false_ok},
                     {"misses", std::move(misses)}};
  }
  if (run.set == "path" || run.set == "track") entry.details.set("max_step", run.max_step);
  return entry;
}

}  // namespace mjarm::app
