#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/mjarm/cli/print.hpp"
#include "apps/mjarm/commands/model_check.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/text_width.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/kinematics/compare.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm::app {
namespace fs = std::filesystem;
namespace {

/// Descriptions that agree this well are the same [m], [rad].
constexpr double kSame = 1e-9;
/// Parts of a cause below this are rounding [m], [rad].
constexpr double kSmallPart = 1e-10;

/// A number for people: rounding noise is no digit.
std::string rounded(double value) {
  return fmt::format("{:.6g}", std::abs(value) < 1e-9 ? 0.0 : value);
}

std::string vector_text(const Eigen::Vector3d& v) {
  return "(" + rounded(v.x()) + ", " + rounded(v.y()) + ", " + rounded(v.z()) + ")";
}

/// "z", "-x" or "(0.1, 0.7, 0.7)".
std::string axis_text(const Eigen::Vector3d& axis) {
  constexpr const char* kNames[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    if (std::abs(std::abs(axis[i]) - 1) > 1e-6) continue;
    return std::string(axis[i] < 0 ? "-" : "") + kNames[i];
  }
  return vector_text(axis);
}

/// "moved by ... and turned by ...".
std::string move_text(const Cause& cause) {
  const bool moves = cause.shift.norm() > kSmallPart;
  const bool turns = cause.turn.norm() > kSmallPart;
  const std::string moved =
      moves ? text(msg::app_against_moved, vector_text(1000 * cause.shift)) : "";
  if (!turns) return moved;
  // Half a turn about -z is one about z.
  const bool half = std::abs(cause.turn.norm() - std::numbers::pi) < 1e-6;
  Eigen::Vector3d axis = cause.turn.normalized();
  if (half && axis.sum() < 0) axis = -axis;
  const std::string turned =
      text(msg::app_against_turned, kDegPerRad * cause.turn.norm(), axis_text(axis));
  return moves ? text(msg::app_against_moved_and_turned, moved, turned) : turned;
}

std::string names_of(const Arm& arm) {
  std::string names;
  for (const ArmJoint& joint : arm.joints)
    names += (names.empty() ? "" : text(msg::core_comma)) + joint.name;
  return names;
}

std::string cause_text(const Cause& cause, const Robot& first, const Robot& second) {
  const auto joint = [&](int i) { return first.arm.joints[static_cast<std::size_t>(i)]; };
  std::string words;
  switch (cause.code) {
    case CauseCode::joint_order:
      return text(msg::app_against_order, names_of(second.arm));
    case CauseCode::base:
      words = text(msg::app_against_base, move_text(cause));
      break;
    case CauseCode::tool:
      words = text(msg::app_against_tool, move_text(cause));
      break;
    case CauseCode::link:
      return text(msg::app_against_link, joint(cause.joint).name, move_text(cause));
    case CauseCode::joint_sign:
      return text(msg::app_against_sign, joint(cause.joint).name);
    case CauseCode::zero_offset: {
      const bool hinge = joint(cause.joint).type == JointType::hinge;
      const double value = cause.offset * (hinge ? kDegPerRad : 1000);
      return text(msg::app_against_zero, joint(cause.joint).name,
                  rounded(value) + (hinge ? " deg" : " mm"));
    }
  }
  if (cause.same_as_zero_of < 0) return words;
  return words + text(msg::app_against_same_as_zero, joint(cause.same_as_zero_of).name);
}

std::string all_causes(const Comparison& comparison, const Robot& first, const Robot& second) {
  std::string words;
  for (const Cause& cause : comparison.causes) {
    words += (words.empty() ? "" : text(msg::core_semicolon)) + cause_text(cause, first, second);
  }
  return words.empty() ? text(msg::app_against_unknown) : words;
}

std::string to_text(const Comparison& comparison, const std::vector<FigureDifference>& figures,
                    const Robot& first, const Robot& second, int configurations) {
  std::string result = text(msg::app_against_title, first.model.file().string(), first.arm.tip,
                            second.model.file().string(), second.arm.tip) +
                       "\n";
  result += "  " +
            (comparison.by_name
                 ? text(msg::app_against_by_name, first.arm.dof())
                 : text(msg::app_against_by_order, first.arm.dof(), names_of(second.arm))) +
            "\n";
  if (std::max(comparison.position, comparison.rotation) <= kSame) {
    result +=
        "  " +
        text(msg::app_against_agree, comparison.position, comparison.rotation, configurations) +
        "\n";
  } else {
    const int width =
        std::max(text_width(text(msg::app_against_at)), text_width(text(msg::app_against_why))) + 2;
    std::string q;
    for (const double value : comparison.q) q += (q.empty() ? "" : ", ") + rounded(value);
    result += "  " +
              text(msg::app_against_worst, 1000 * comparison.position,
                   kDegPerRad * comparison.rotation, configurations) +
              "\n  " + padded(text(msg::app_against_at), width) + q + "\n";
    std::string label = padded(text(msg::app_against_why), width);
    for (const Cause& cause : comparison.causes) {
      result += "  " + label + cause_text(cause, first, second) + "\n";
      label = padded("", width);
    }
    if (comparison.causes.empty()) result += "  " + label + text(msg::app_against_unknown) + "\n";
    if (!comparison.causes.empty()) {
      result += "  " + padded("", width) +
                text(msg::app_against_left, comparison.position_left, comparison.rotation_left) +
                "\n";
    }
  }
  if (!figures.empty()) result += "  " + text(msg::app_against_figures) + "\n";
  for (const FigureDifference& f : figures) {
    result += "    " +
              text(msg::app_against_figure, std::string(f.what), f.joint, f.first, f.second) + "\n";
  }
  return result;
}

JsonDoc vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

JsonDoc cause_json(const Cause& cause, const Robot& first, const Robot& second) {
  const auto joint = [&](int i) {
    return i < 0 ? JsonDoc(nullptr) : JsonDoc(first.arm.joints[static_cast<std::size_t>(i)].name);
  };
  return {{"cause", name(cause.code)},
          {"joint", joint(cause.joint)},
          {"shift", vector_json(cause.shift)},
          {"turn", vector_json(cause.turn)},
          {"offset", cause.offset},
          {"same_as_zero_of", joint(cause.same_as_zero_of)},
          {"message", cause_text(cause, first, second)}};
}

std::string to_json(const Comparison& comparison, const std::vector<FigureDifference>& figures,
                    const Robot& first, const Robot& second, int configurations) {
  std::vector<JsonDoc> causes;
  for (const Cause& cause : comparison.causes) causes.push_back(cause_json(cause, first, second));
  std::vector<JsonDoc> others;
  for (const FigureDifference& f : figures) {
    others.push_back(
        {{"joint", f.joint}, {"what", f.what}, {"first", f.first}, {"second", f.second}});
  }
  const JsonDoc doc{{"file", first.model.file().string()},
                    {"against", second.model.file().string()},
                    {"tip", first.arm.tip},
                    {"against_tip", second.arm.tip},
                    {"ok", std::max(comparison.position, comparison.rotation) <= kSame},
                    {"configurations", configurations},
                    {"matched", comparison.by_name ? "name" : "order"},
                    {"position", comparison.position},
                    {"rotation", comparison.rotation},
                    {"worst_q", comparison.q},
                    {"causes", std::move(causes)},
                    {"position_left", comparison.position_left},
                    {"rotation_left", comparison.rotation_left},
                    {"figures", std::move(others)}};
  return doc.document();
}

}  // namespace

Result<int> check_against(const fs::path& file, const fs::path& other, const CheckOptions& check,
                          bool json) {
  const Result<Robot> first = load_robot(file.string(), {.tip = check.tip, .load = check.load});
  if (!first) return fail(first.error());
  // The other description may call its frames differently.
  Result<Robot> second = load_robot(other.string(), {.tip = check.tip, .load = check.load});
  if (!second && !check.tip.empty()) second = load_robot(other.string(), {.load = check.load});
  if (!second) return fail(second.error());
  const CompareOptions options;
  const Result<Comparison> comparison = compare_arms(first->arm, second->arm, options);
  if (!comparison) {
    return fail(comparison.error().code, text(msg::app_check_worst_element, file.string(),
                                              other.string(), comparison.error().what));
  }
  const auto figures = compare_figures(first->model, first->arm, second->model, second->arm);
  const std::string words =
      json ? to_json(*comparison, figures, *first, *second, options.configurations)
           : to_text(*comparison, figures, *first, *second, options.configurations);
  print_lines(words);
  if (std::max(comparison->position, comparison->rotation) <= kSame) return 0;
  return fail(Errc::impossible, text(msg::app_against_differ, other.string(), file.string(),
                                     1000 * comparison->position, kDegPerRad * comparison->rotation,
                                     all_causes(*comparison, *first, *second)));
}

}  // namespace mjarm::app
