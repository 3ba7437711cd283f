#include "apps/bench/pick.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/pick_creep.hpp"
#include "apps/bench/pick_seen.hpp"
#include "apps/bench/suite.hpp"
#include "apps/mjarm/cli/table.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "mjarm/core/log.hpp"

namespace mjarm::app {
namespace {

constexpr int kMostScenes = 100'000;
constexpr std::array kRobots = {"ur5e", "panda"};

struct PickWords : ReportOptions {
  std::string robot, set, scenes = "100", first = "0", seed = "1", hold = "60";

  [[nodiscard]] bool wants(std::string_view name) const { return set.empty() || set == name; }
};

/// All scenes of a set, solved.
struct SolvedSet {
  std::string name, robot;
  std::size_t first;  ///< number of the first scene
  std::vector<PickVerdict> verdicts;
};

std::vector<std::string> row_of(const SolvedSet& set) {
  double seen = 0, seen_turn = 0, off = 0, turn = 0, others = 0, seconds = 0;
  std::size_t placed = 0, tries = 0;
  for (const PickVerdict& one : set.verdicts) {
    seen = std::max(seen, one.seen_position);
    seen_turn = std::max(seen_turn, one.seen_rotation);
    tries += one.tries;
    if (!one.placed) continue;
    ++placed;
    off = std::max(off, one.position);
    turn = std::max(turn, one.rotation);
    others = std::max(others, one.others);
    seconds += one.seconds;
  }
  return {set.robot,
          set.name,
          fmt::format("{}/{}", placed, set.verdicts.size()),
          fmt::format("{:.2f} mm, {:.2f} deg", 1e3 * seen, in_degrees(seen_turn)),
          fmt::format("{:.2f} mm, {:.2f} deg", 1e3 * off, in_degrees(turn)),
          fmt::format("{:.2f}", 1e3 * others),
          std::to_string(tries),
          fmt::format("{:.1f}", placed == 0 ? 0 : seconds / static_cast<double>(placed))};
}

std::string picks_table(const std::vector<SolvedSet>& sets) {
  std::vector<std::vector<std::string>> rows{
      {text(msg::bench_pick_robot), text(msg::bench_pick_set), text(msg::bench_pick_placed),
       text(msg::bench_pick_seen), text(msg::bench_pick_error), text(msg::bench_pick_others),
       text(msg::bench_pick_tries), text(msg::bench_pick_cycle)}};
  std::string misses;
  for (const SolvedSet& set : sets) {
    rows.push_back(row_of(set));
    int passed_over = 0;
    for (const PickVerdict& one : set.verdicts) passed_over += one.passed_over;
    if (passed_over > 0) {
      misses += text(msg::bench_pick_passed_over, set.robot, set.name, passed_over) + '\n';
    }
    for (std::size_t i = 0; i < set.verdicts.size(); ++i) {
      const PickVerdict& one = set.verdicts[i];
      if (one.placed) continue;
      misses +=
          text(msg::bench_pick_miss, set.robot, set.name, set.first + i, one.object, one.miss) +
          '\n';
    }
  }
  const std::string out = markdown_table(rows);
  return misses.empty() ? out : out + '\n' + misses;
}

JsonDoc picks_json(const std::vector<SolvedSet>& sets) {
  std::vector<JsonDoc> docs;
  for (const SolvedSet& set : sets) {
    std::vector<JsonDoc> scenes;
    for (const PickVerdict& one : set.verdicts) {
      scenes.push_back({{"object", one.object},
                        {"placed", one.placed},
                        {"position", one.position},
                        {"rotation", one.rotation},
                        {"seen_position", one.seen_position},
                        {"seen_rotation", one.seen_rotation},
                        {"others", one.others},
                        {"tries", static_cast<int>(one.tries)},
                        {"seconds", one.seconds},
                        {"passed_over", one.passed_over},
                        {"miss", one.miss}});
    }
    docs.push_back({{"robot", set.robot}, {"set", set.name}, {"scenes", std::move(scenes)}});
  }
  return docs;
}

/// The scenes that are asked for.
Result<std::vector<PickSet>> sets_of(const PickWords& options, std::uint64_t seed) {
  constexpr std::array<
      std::pair<const char*, Result<PickSet> (*)(const std::string&, std::uint64_t)>, 2>
      kSets = {{{"table", table_scenes}, {"clutter", clutter_scenes}}};
  std::vector<PickSet> out;
  for (const char* robot : kRobots) {
    for (const auto& [name, scenes] : kSets) {
      if (!options.wants(name)) continue;
      if (!options.robot.empty() && options.robot != robot) continue;
      Result<PickSet> set = scenes(robot, seed);
      if (!set) return fail(std::move(set.error()));
      out.push_back(std::move(*set));
    }
  }
  return out;
}

Result<void> check_names(const PickWords& options) {
  constexpr std::array kNames = {"table", "clutter", "seen", "creep"};
  if (!options.set.empty() && std::ranges::find(kNames, options.set) == kNames.end()) {
    return fail(Errc::usage, text(msg::bench_pick_no_set, options.set));
  }
  if (!options.robot.empty() && std::ranges::find(kRobots, options.robot) == kRobots.end()) {
    return fail(Errc::usage, text(msg::bench_pick_no_robot, options.robot));
  }
  if (options.set == "seen" && !options.robot.empty()) {
    return fail(Errc::usage, text(msg::bench_pick_no_robot_in_seen));
  }
  return {};
}

Result<std::vector<SolvedSet>> solve_all(const std::vector<PickSet>& sets,
                                         const SceneNumbers& scenes) {
  Progress progress(text(msg::bench_pick_progress),
                    sets.size() * static_cast<std::size_t>(scenes.count));
  std::vector<SolvedSet> solved;
  for (const PickSet& set : sets) {
    solved.push_back({set.name, set.robot, scenes.first, {}});
    for (int i = 0; i < scenes.count; ++i) {
      const Result<PickProblem> problem = set.draw(scenes.number(i));
      if (!problem) return fail(problem.error());
      Result<PickVerdict> verdict = solve_pick(set, *problem);
      if (!verdict) return fail(std::move(verdict.error()));
      solved.back().verdicts.push_back(std::move(*verdict));
      progress.advance();
    }
  }
  return solved;
}

/// What is printed, as it comes.
struct PickAnswer {
  std::vector<std::string> tables = {};
  JsonDoc json = {};
};

Result<PickAnswer> measure_all(const PickWords& options, const SceneNumbers& scenes,
                               std::uint64_t seed, const HoldTimes& times) {
  PickAnswer out;
  Result<std::vector<PickSet>> sets = sets_of(options, seed);
  if (!sets) return fail(std::move(sets.error()));
  if (!sets->empty()) {
    const Result<std::vector<SolvedSet>> solved = solve_all(*sets, scenes);
    if (!solved) return fail(solved.error());
    out.tables.push_back(picks_table(*solved));
    out.json.set("sets", picks_json(*solved));
  }
  if (options.wants("seen") && options.robot.empty()) {
    const Result<std::vector<SeenErrors>> seen = measure_seen(scenes, seed);
    if (!seen) return fail(seen.error());
    out.tables.push_back(text(msg::bench_seen_caption, scenes.count) + "\n\n" + seen_table(*seen));
    out.json.set("seen", seen_json(*seen));
  }
  if (options.wants("creep")) {
    const Result<std::vector<HoldVerdict>> held = measure_creep(options.robot, times);
    if (!held) return fail(held.error());
    out.tables.push_back(text(msg::bench_creep_caption) + "\n\n" + creep_table(*held, times));
    out.json.set("creep", creep_json(*held));
  }
  return out;
}

Result<int> run_pick(const PickWords& options) {
  constexpr int kMaxHold = 3600;  // [s]
  if (Result<void> known = check_names(options); !known) return fail(std::move(known.error()));
  const Result<int> scenes = parse_count("--scenes", options.scenes, kMostScenes);
  if (!scenes) return fail(scenes.error());
  const Result<std::uint64_t> first = parse_whole("--first", options.first);
  if (!first) return fail(first.error());
  const Result<int> seed = parse_count("--seed", options.seed, kMostScenes);
  if (!seed) return fail(seed.error());
  const Result<int> hold = parse_count("--hold", options.hold, kMaxHold);
  if (!hold) return fail(hold.error());
  const Result<PickAnswer> answer =
      measure_all(options, {*first, *scenes}, static_cast<std::uint64_t>(*seed),
                  {.rest = static_cast<double>(*hold)});
  if (!answer) return fail(answer.error());
  std::string out;
  if (options.json) {
    out = answer->json.document();
  } else {
    if (!options.no_timing) out = bench_occasion() + "\n";
    for (const std::string& table : answer->tables) out += (out.empty() ? "" : "\n") + table;
  }
  std::fputs(out.c_str(), stdout);
  return 0;
}

}  // namespace

Command pick_suite() {
  return {"pick", msg::bench_pick_summary, msg::bench_pick_examples, [](CLI::App& app) -> Run {
            auto options = std::make_shared<PickWords>();
            add_option(app, "--robot", options->robot, msg::bench_pick_option_robot, "NAME");
            add_option(app, "--set", options->set, msg::bench_pick_option_set, "NAME");
            add_option(app, "--scenes", options->scenes, msg::bench_pick_option_scenes, "N");
            add_option(app, "--first", options->first, msg::bench_pick_option_first, "N");
            add_option(app, "--seed", options->seed, msg::bench_pick_option_seed, "N");
            add_option(app, "--hold", options->hold, msg::bench_pick_option_hold, "S");
            add_report_options(app, *options);
            return [options] { return run_pick(*options); };
          }};
}

}  // namespace mjarm::app
