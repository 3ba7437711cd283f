#include "mjarm/program/program.hpp"

#include <array>
#include <utility>

namespace mjarm::program {

std::string_view word(const Instruction& instruction) noexcept {
  static constexpr std::array<std::string_view, 16> kWords{
      "movej", "movel", "movec",  "ellipse", "polyline", "spline", "text",  "wait",
      "set",   "plan",  "excite", "grip",    "look",     "pick",   "place", "repeat"};
  if (const auto* drawn = std::get_if<DrawEllipse>(&instruction.what)) return drawn->word;
  return kWords[instruction.what.index()];
}

Instruction move_j(std::vector<double> q, std::optional<double> share) {
  return {MoveJ{JointValues{std::move(q)}, share}};
}

Instruction move_j(const Pose& X_FT, std::optional<double> share) {
  return {MoveJ{ProgramPose{X_FT}, share}};
}

Instruction move_l(const Pose& X_FT, std::optional<double> speed, std::optional<double> blend) {
  return {MoveL{{X_FT}, speed, blend}};
}

Instruction move_c(const Pose& X_via, const Pose& X_to, std::optional<double> speed,
                   std::optional<double> blend) {
  return {MoveC{{X_via}, {X_to}, speed, blend}};
}

Instruction wait(double seconds) { return {Wait{seconds}}; }

Instruction repeat(int times, std::vector<Instruction> body) {
  return {Repeat{times, std::move(body)}};
}

}  // namespace mjarm::program
