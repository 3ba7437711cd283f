#include "mjarm/kinematics/branch.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mjarm/core/messages/kinematics.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/trim.hpp"
#include "mjarm/kinematics/bend_internal.hpp"
#include "mjarm/kinematics/ik.hpp"

namespace mjarm {
namespace {

constexpr std::string_view kBlank = " ";
constexpr std::string_view kPartNames[] = {"shoulder", "elbow", "wrist"};
constexpr std::string_view kWayNames[][2] = {
    {"left", "right"}, {"up", "down"}, {"no_flip", "flip"}};

/// Index of `word`, or one line with the nearest of `words`.
Result<int> index_of(std::string_view word, std::span<const std::string_view> words) {
  const auto found = std::ranges::find(words, word);
  if (found != words.end()) return static_cast<int>(found - words.begin());
  const std::vector<std::string> known(words.begin(), words.end());
  return fail(Errc::bad_input,
              text(msg::kinematics_branch_word, word, listed(known)) + did_you_mean(word, known));
}

}  // namespace

bool Branch::allows(const Branch& other) const noexcept {
  for (std::size_t part = 0; part < way.size(); ++part) {
    if (way[part] >= 0 && way[part] != other.way[part]) return false;
  }
  return true;
}

std::span<const std::string_view> branch_parts() noexcept { return kPartNames; }

std::span<const std::string_view> branch_ways(int part) noexcept { return kWayNames[part]; }

Result<void> set_way(Branch& branch, std::string_view part, std::string_view way) {
  const Result<int> index = index_of(part, kPartNames);
  if (!index) return fail(index.error());
  const Result<int> chosen = index_of(way, kWayNames[*index]);
  if (!chosen) {
    return fail(Errc::bad_input, text(msg::kinematics_branch_in, part, chosen.error().what));
  }
  branch.way[static_cast<std::size_t>(*index)] = *chosen;
  return {};
}

Result<Branch> parse_branch(std::string_view words) {
  Branch out;
  for (bool more = true; more;) {
    const std::size_t comma = words.find(',');
    const std::string_view one = trimmed(words.substr(0, comma), kBlank);
    more = comma != std::string_view::npos;
    if (more) words.remove_prefix(comma + 1);
    const std::size_t equals = one.find('=');
    if (equals == std::string_view::npos) {
      return fail(Errc::bad_input, text(msg::kinematics_branch_form, one));
    }
    const Branch before = out;
    const std::string_view part = trimmed(one.substr(0, equals), kBlank);
    Result<void> set = set_way(out, part, trimmed(one.substr(equals + 1), kBlank));
    if (!set) return fail(std::move(set.error()));
    for (std::size_t k = 0; k < before.way.size(); ++k) {
      if (before.way[k] >= 0 && part == kPartNames[k]) {
        return fail(Errc::bad_input, text(msg::kinematics_branch_twice, part));
      }
    }
  }
  return out;
}

std::string describe(const Branch& branch) {
  std::string out;
  for (std::size_t part = 0; part < branch.way.size(); ++part) {
    const int way = branch.way[part];
    if (way < 0) continue;
    if (!out.empty()) out += ",";
    out += std::string(kPartNames[part]) + "=" + std::string(kWayNames[part][way]);
  }
  return out;
}

Branch branch_of(const IkSolver& ik, std::span<const double> q) noexcept {
  constexpr double kStraight = 1e-3;
  constexpr double kLevel = 1e-9;  // [m] an elbow no farther aside is neither above nor below
  Branch out;
  const detail::Bend bend = detail::bend_of(ik, q);
  if (!bend.has_elbow) return out;
  const double up = bend.aside.z();
  out.way[1] = (std::abs(up) > kLevel ? up : bend.turn) >= 0 ? 0 : 1;
  if (!bend.closed) return out;
  out.way[0] = bend.left >= 0 ? 0 : 1;
  const double at_home = detail::bend_of(ik, as_span(ik.arm().home)).wrist;
  const double side = std::abs(at_home) > kStraight ? at_home : 1;
  out.way[2] = bend.wrist * side >= 0 ? 0 : 1;
  return out;
}

Result<void> check_branch(const IkSolver& ik, const Branch& wanted) {
  const Branch known = branch_of(ik, as_span(ik.arm().home));
  std::vector<std::string> parts;
  for (std::size_t part = 0; part < known.way.size(); ++part) {
    if (known.way[part] >= 0) parts.emplace_back(kPartNames[part]);
  }
  for (std::size_t part = 0; part < known.way.size(); ++part) {
    if (wanted.way[part] < 0 || known.way[part] >= 0) continue;
    return fail(Errc::bad_input, parts.empty() ? text(msg::kinematics_branch_none, ik.arm().name)
                                               : text(msg::kinematics_branch_unknown, ik.arm().name,
                                                      kPartNames[part], listed(parts)));
  }
  return {};
}

}  // namespace mjarm
