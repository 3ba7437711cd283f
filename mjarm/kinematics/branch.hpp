#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "mjarm/core/result.hpp"

namespace mjarm {

class IkSolver;

/// Which way an arm is bent, in words: `shoulder` left or right, `elbow` up or down, `wrist`
/// no_flip or flip. As a wish, parts that are not set are left open; of an arm, they are not known.
///
/// - shoulder: on which side of the line from the base axis to the wrist the arm (six axes in
///   closed form) or its elbow (seven) is, seen from the base.
/// - elbow: above or below the line from the shoulder to the wrist, in the world.
/// - wrist: no_flip is bent to the side to which it is bent at the arm's home, flip to the other.
struct Branch {
  static constexpr int kParts = 3;
  /// By part: 0 the first of its words, 1 the second, -1 neither.
  std::array<int, kParts> way{-1, -1, -1};

  /// True where no part is set.
  [[nodiscard]] bool empty() const noexcept { return way == Branch{}.way; }
  /// True where all that is set here is the same in `other`.
  [[nodiscard]] bool allows(const Branch& other) const noexcept;
  bool operator==(const Branch&) const = default;
};

/// "shoulder", "elbow", "wrist".
[[nodiscard]] std::span<const std::string_view> branch_parts() noexcept;
/// The two words of a part: "left" and "right" of part 0.
[[nodiscard]] std::span<const std::string_view> branch_ways(int part) noexcept;

/// Sets one part by its words.
/// @return bad_input: one line with the nearest word.
[[nodiscard]] Result<void> set_way(Branch& branch, std::string_view part, std::string_view way);
/// `shoulder=left,elbow=up,wrist=no_flip`, or some of them; each at most once.
[[nodiscard]] Result<Branch> parse_branch(std::string_view words);
/// The same, of what is set.
[[nodiscard]] std::string describe(const Branch& branch);

/// Which way an arm is bent at `q`, shape (dof,) [rad or m]. Only the elbow is known of an arm
/// without a closed form, nothing of one of fewer than four joints.
[[nodiscard]] Branch branch_of(const IkSolver& ik, std::span<const double> q) noexcept;
/// @return bad_input for a wish with parts that are not known of that arm.
[[nodiscard]] Result<void> check_branch(const IkSolver& ik, const Branch& wanted);

}  // namespace mjarm
