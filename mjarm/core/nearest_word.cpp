#include "mjarm/core/nearest_word.hpp"

#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "mjarm/core/messages/core.hpp"

namespace mjarm {
namespace {

constexpr std::size_t kLongestWord = 64;  // longer input is no typing mistake; keeps the work small

/// What other programs, and other people, call the same thing; the first that is known here counts.
struct OtherWord {
  std::string_view theirs;
  std::initializer_list<std::string_view> ours;
};

const std::span<const OtherWord> other_words() {
  static const OtherWord kWords[] = {
      // poses, joints and files
      {"rpy", {"euler"}},
      {"orientation", {"euler", "quat"}},
      {"rotation", {"euler", "quat"}},
      {"quaternion", {"quat"}},
      {"wxyz", {"quat"}},
      {"xyz", {"pos"}},
      {"xyzw", {"quat"}},
      {"position", {"pos"}},
      {"translation", {"pos"}},
      {"joints", {"q", "joints"}},
      {"joint_values", {"q", "joints"}},
      {"q", {"joints"}},
      {"angles", {"joints", "euler", "q"}},
      {"initial", {"seed-q", "start"}},
      {"guess", {"seed-q"}},
      {"model", {"robot"}},
      {"urdf", {"robot"}},
      {"mjcf", {"robot"}},
      {"arm", {"robot"}},
      {"tool", {"tip", "tool"}},
      {"tcp", {"tip", "tool"}},
      {"ee", {"tip", "tool"}},
      {"input", {"in"}},
      {"output", {"out"}},
      {"file", {"in"}},
      {"velocity", {"speed"}},
      {"vel", {"speed"}},
      {"radius", {"blend", "radius"}},
      {"no-gui", {"headless"}},
      {"nogui", {"headless"}},
      {"duration", {"seconds"}},
      {"time", {"seconds", "wait"}},
      // instructions and commands
      {"sleep", {"wait"}},
      {"delay", {"wait"}},
      {"pause", {"wait"}},
      {"loop", {"repeat"}},
      {"line", {"movel", "polyline"}},
      {"linear", {"movel"}},
      {"ptp", {"movej"}},
      {"lin", {"movel"}},
      {"circ", {"movec"}},
      {"arc", {"movec"}},
      {"gripper", {"grip"}},
      {"inverse", {"ik"}},
      {"forward", {"fk"}},
      {"validate", {"check", "verify"}},
      {"lint", {"check"}},
      {"show", {"view"}},
      {"simulate", {"sim", "run"}},
      {"play", {"run"}},
      {"evaluate", {"eval"}},
      {"test", {"eval", "check"}},
      {"benchmark", {"bench"}},
      // languages
      {"cn", {"zh-CN"}},
      {"chinese", {"zh-CN"}},
      {"zh-hans", {"zh-CN"}},
      {"zh-sg", {"zh-CN"}},
      {"mandarin", {"zh-CN"}},
      {"中文", {"zh-CN"}},
      {"english", {"en"}},
      {"en-us", {"en"}},
      {"en-gb", {"en"}},
  };
  return kWords;
}

std::string_view without_dashes(std::string_view word) noexcept {
  return word.substr(std::min(word.find_first_not_of('-'), word.size()));
}

char lower(char c) noexcept { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool is_same(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, {}, lower, lower);
}

/// The word of `known` that others call `word`.
std::optional<std::string> by_other_name(std::string_view word,
                                         std::span<const std::string> known) {
  for (const OtherWord& other : other_words()) {
    if (!is_same(other.theirs, without_dashes(word))) continue;
    for (const std::string_view ours : other.ours) {
      const auto found = std::ranges::find(known, ours, without_dashes);
      if (found != known.end() && *found != word) return *found;
    }
  }
  return std::nullopt;
}

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  // Optimal string alignment distance, three rows of the table at a time.
  std::vector<int> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      const bool swapped = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
                           lower(a[i - 2]) == lower(b[j - 1]);
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

std::optional<std::string> nearest_word(std::string_view word, std::span<const std::string> known) {
  if (word.empty() || word.size() > kLongestWord) return std::nullopt;
  if (auto meant = by_other_name(word, known)) return meant;
  int best = std::max(2, static_cast<int>(word.size()) / 3) + 1;
  std::optional<std::string> nearest;
  for (const std::string& candidate : known) {
    if (candidate.size() > kLongestWord || candidate == word) continue;
    const int distance = edit_distance(word, candidate);
    // A word of one or two letters is near to everything; it must share at least one letter.
    if (distance < best && distance < static_cast<int>(std::max(word.size(), candidate.size()))) {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string listed(std::span<const std::string> words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : text(msg::core_comma)) + word;
  return list;
}

std::string did_you_mean(std::string_view word, std::span<const std::string> known) {
  const std::optional<std::string> nearest = nearest_word(word, known);
  return nearest ? text(msg::core_did_you_mean, *nearest) : std::string();
}

Result<std::size_t> index_of_word(std::string_view word, std::span<const std::string_view> names,
                                  Msg unknown) {
  const auto found = std::ranges::find(names, word);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  const std::vector<std::string> words(names.begin(), names.end());
  return fail(Errc::usage, text(unknown, word, listed(words)) + did_you_mean(word, words));
}

}  // namespace mjarm
