#pragma once

#include <fmt/format.h>

#include <array>
#include <numbers>
#include <string>
#include <vector>

#include "mjarm/core/rng.hpp"

/// Motion programs of the UR5e, made so that it is known whether and where they are at fault.
namespace mjarm::testing {

/// A program as text, and the line (from 1) that is at fault; 0 = none.
struct RandomProgram {
  std::string text;
  int line = 0;
  std::vector<std::string> reasons;  ///< any of these words will do; none: it must not even be read
};

/// Writes a program line by line.
class ProgramText {
 public:
  int add(const std::string& line) {
    text_ += line + "\n";
    return ++lines_;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
  int lines_ = 0;
};

/// A place in front of the arm where the tool can point down, away from the arm and the floor.
inline std::array<double, 3> place(Rng& rng) {
  const double turn = rng.uniform(-0.6, 0.6) - std::numbers::pi / 2,
               radius = rng.uniform(0.35, 0.6);
  return {radius * std::cos(turn), radius * std::sin(turn), rng.uniform(0.25, 0.5)};
}

inline std::string pos(const std::array<double, 3>& p) {
  return fmt::format("[{:.4f}, {:.4f}, {:.4f}]", p[0], p[1], p[2]);
}

inline std::string down(const std::array<double, 3>& p) {
  return fmt::format("pos: {}, euler: [3.1416, 0, 0]", pos(p));
}

inline void begin(ProgramText& out) {
  out.add("# made by a test");
  out.add("robot: ur5e");
  out.add("program:");
}

/// One instruction that can be done from anywhere near where the others end.
inline void add_good(ProgramText& out, Rng& rng) {
  const auto p = place(rng);
  switch (rng.below(10)) {
    case 0:
      out.add(fmt::format("  - movej: {{{}, speed: {:.2f}}}", down(p), rng.uniform(0.2, 1)));
      return;
    case 1:
      out.add(fmt::format("  - movel: {{{}}}", down(p)));
      return;
    case 2: {
      const auto q = place(rng);
      out.add(fmt::format("  - movel: {{{}, speed: 100mm/s, blend: 0.01}}", down(p)));
      out.add(fmt::format("  - movel: {{{}}}", down(q)));
      return;
    }
    case 3:
      out.add(
          fmt::format("  - ellipse: {{center: [{:.3f}, -0.45, {:.3f}], a: {:.3f}, b: 0.08, "
                      "normal: [0, 0, 1], euler: [180deg, 0, 0]}}",
                      rng.uniform(-0.1, 0.1), p[2], rng.uniform(0.05, 0.15)));
      return;
    case 4:
      out.add(
          fmt::format("  - circle: {{center: [0, -0.45, {:.3f}], radius: 50mm, "
                      "normal: [0, 0, 1], quat: [0, 1, 0, 0]}}",
                      p[2]));
      return;
    case 5:
      out.add("  - wait: 250ms");
      return;
    case 6:
      out.add(fmt::format("  - polyline: {{points: [{}, {}, {}], euler: [3.1416, 0, 0]}}",
                          pos(place(rng)), pos(place(rng)), pos(place(rng))));
      return;
    case 7:
      out.add("  - repeat:");
      out.add("      times: 2");
      out.add("      program:");
      out.add(fmt::format("        - movel: {{{}}}", down(p)));
      out.add(fmt::format("        - movel: {{{}}}", down(place(rng))));
      return;
    case 8: {
      // A line, an arc towards the middle and a line, in one motion.
      const double way = p[0] > 0 ? -0.1 : 0.1;
      const std::array<double, 3> via{p[0] + 0.5 * way, p[1], p[2] + 0.03},
          to{p[0] + way, p[1], p[2]};
      out.add(fmt::format("  - movel: {{{}, blend: 15mm}}", down(p)));
      out.add(
          fmt::format("  - movec: {{via: {{{}}}, to: {{{}}}, blend: 10mm}}", down(via), down(to)));
      out.add(fmt::format("  - movel: {{{}}}", down(place(rng))));
      return;
    }
    default:
      out.add(fmt::format("  - set: {{speed: {:.2f}, zone: 5mm}}", rng.uniform(0.05, 0.2)));
      out.add(fmt::format("  - movel: {{{}}}", down(p)));
      return;
  }
}

inline RandomProgram good_program(Rng& rng) {
  ProgramText out;
  begin(out);
  out.add(fmt::format("  - movej: {{{}}}", down(place(rng))));
  const auto count = 2 + rng.below(4);
  for (std::uint64_t i = 0; i < count; ++i) add_good(out, rng);
  return {out.text(), 0, {}};
}

/// The classes of faults.
inline const std::vector<std::string>& fault_classes() {
  static const std::vector<std::string> kClasses{
      "unreachable pose", "limit",      "singular line", "overlapping blends",
      "unknown name",     "wrong unit", "missing field", "collision with the scene",
      "impossible speed"};
  return kClasses;
}

/// Adds the instruction at fault; returns its line and what may be said.
inline RandomProgram add_fault(ProgramText& out, const std::string& kind, Rng& rng) {
  auto p = place(rng);
  if (kind == "unreachable pose") {
    p[1] = rng.uniform(-3, -1.2);
    const char* word = rng.uniform() < 0.5 ? "movej" : "movel";
    return {{}, out.add(fmt::format("  - {}: {{{}}}", word, down(p))), {"out_of_reach"}};
  }
  if (kind == "limit") {
    return {{},
            out.add(fmt::format("  - movej: {{joints: [0, {:.2f}, {}, -1.57, 90deg, 0]}}",
                                rng.uniform(-2, -1), rng.uniform() < 0.5 ? "4.2" : "-200deg")),
            {"joint_limit"}};
  }
  if (kind == "singular line") {
    // The tool points along the line: half way its axis meets that of the wrist's first joint.
    const std::string how = fmt::format("euler: [0, {:.4f}, 0]", 1.57 + rng.uniform(0.02, 0.04));
    const double z = rng.uniform(0.4, 0.47);
    out.add(fmt::format("  - movej: {{pos: [-0.25, -0.45, {:.3f}], {}}}", z, how));
    return {
        {},
        out.add(fmt::format("  - movel: {{pos: [0.35, -0.45, {:.3f}], {}, speed: 0.25}}", z, how)),
        {"singularity", "joint_speed"}};
  }
  if (kind == "overlapping blends") {
    out.add("  - movel: {pos: [-0.1, -0.4, 0.4], euler: [180deg, 0, 0]}");
    const double radius = rng.uniform(0.03, 0.045);
    const int line = out.add(fmt::format(
        "  - movel: {{pos: [0.1, -0.4, 0.4], euler: [180deg, 0, 0], blend: {:.3f}}}", radius));
    out.add(fmt::format(
        "  - movel: {{pos: [0.1, -0.45, 0.4], euler: [180deg, 0, 0], blend: {:.3f}}}", radius));
    out.add("  - movel: {pos: [-0.1, -0.45, 0.4], euler: [180deg, 0, 0]}");
    return {{}, line, {"blend_overlap"}};
  }
  if (kind == "unknown name") {
    const std::string faults[] = {fmt::format("  - movell: {{{}}}", down(p)),
                                  fmt::format("  - movel: {{{}, sped: 0.1}}", down(p)),
                                  "  - movel: {pose: abvoe}",
                                  "  - set: {tool: atachment_site}",
                                  fmt::format("  - movel: {{{}, frame: wrld}}", down(p)),
                                  "  - movej: {joints: hoem}"};
    return {{}, out.add(faults[rng.below(6)]), {"unknown_name"}};
  }
  if (kind == "wrong unit") {
    const std::string faults[] = {fmt::format("  - movel: {{{}, speed: 25mm}}", down(p)),
                                  "  - wait: 2m",
                                  fmt::format("  - movel: {{pos: {}, euler: [180, 0, 0]}}", pos(p)),
                                  fmt::format("  - movel: {{{}, blend: 10deg}}", down(p)),
                                  fmt::format("  - movej: {{{}, speed: 50}}", down(p)),
                                  "  - circle: {center: [0, -0.45, 0.4], radius: 5s, normal: [0, "
                                  "0, 1], euler: [3.14, 0, 0]}"};
    return {{}, out.add(faults[rng.below(6)]), {}};
  }
  if (kind == "missing field") {
    const std::string faults[] = {
        fmt::format("  - movel: {{pos: {}}}", pos(p)),
        "  - movel: {euler: [3.14, 0, 0]}",
        "  - ellipse: {center: [0, -0.45, 0.4], a: 0.1, normal: [0, 0, 1], euler: [3.14, 0, 0]}",
        fmt::format("  - movec: {{to: {{{}}}}}", down(p)),
        "  - repeat: {times: 2}",
        "  - polyline: {euler: [3.14, 0, 0]}"};
    return {{}, out.add(faults[rng.below(6)]), {}};
  }
  if (kind == "collision with the scene") {
    p[2] = rng.uniform(-0.1, -0.03);
    const char* word = rng.uniform() < 0.5 ? "movej" : "movel";
    return {{}, out.add(fmt::format("  - {}: {{{}}}", word, down(p))), {"collision"}};
  }
  out.add("  - movel: {pos: [-0.2, -0.45, 0.4], euler: [180deg, 0, 0]}");
  return {{},
          out.add(fmt::format("  - movel: {{pos: [0.2, -0.45, 0.4], euler: [180deg, 0, 0], "
                              "speed: {:.1f}}}",
                              rng.uniform(3, 20))),
          {"joint_speed"}};
}

/// A program with one fault of a class of `fault_classes()` among good instructions.
inline RandomProgram faulty_program(const std::string& kind, Rng& rng) {
  ProgramText out;
  begin(out);
  out.add(fmt::format("  - movej: {{{}}}", down(place(rng))));
  if (rng.uniform() < 0.5) add_good(out, rng);
  RandomProgram fault = add_fault(out, kind, rng);
  out.add(fmt::format("  - movej: {{{}}}", down(place(rng))));
  fault.text = out.text();
  return fault;
}

}  // namespace mjarm::testing
