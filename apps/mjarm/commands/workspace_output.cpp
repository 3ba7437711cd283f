#include "apps/mjarm/commands/workspace_output.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>

#include "apps/mjarm/messages/workspace.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/render/fonts.hpp"
#include "mjarm/render/plot.hpp"
#include "mjarm/render/png.hpp"

namespace mjarm::app {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// How much of the slice is reached.
struct Extent {
  int cells = 0;
  bool has_axis = true;  ///< the first joint turns, so that there is an axis to stand off from
  double nearest = std::numeric_limits<double>::infinity();  ///< [m] from the first joint's axis
  double farthest = 0;                                       ///< [m]
};

/// Calls `see(p_W, branches, manipulability)` for every cell.
template <class See>
void each_cell(const WorkspaceReport& report, const See& see) {
  const WorkspaceMap& map = report.map;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  p_W[report.work.normal] = report.work.at;
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      const std::size_t cell = static_cast<std::size_t>(row) * map.columns + column;
      p_W[map.u] = map.u_at(column);
      p_W[map.v] = map.v_at(row);
      see(p_W, map.branches[cell], map.manipulability[cell]);
    }
  }
}

Extent extent_of(const WorkspaceReport& report) {
  const ArmJoint& base = report.arm.joints.front();
  const Eigen::Vector3d axis_W = base.X_PJ.R * base.axis;
  Extent extent{.has_axis = base.type == JointType::hinge};
  each_cell(report, [&](const Eigen::Vector3d& p_W, int branches, double) {
    if (branches == 0) return;
    const double distance = (p_W - base.X_PJ.p).cross(axis_W).norm();
    ++extent.cells;
    extent.nearest = std::min(extent.nearest, distance);
    extent.farthest = std::max(extent.farthest, distance);
  });
  return extent;
}

std::string axis_name(int axis) { return std::string(1, "xyz"[axis]); }

std::string orientation_text(const WorkspaceReport& report) {
  if (!report.work.R_WT) return text(msg::workspace_any);
  const Eigen::Vector3d euler = to_euler(*report.work.R_WT);
  return text(msg::workspace_fixed, euler[0], euler[1], euler[2]);
}

std::string csv_of(const WorkspaceReport& report) {
  std::string out = "x,y,z,branches,manipulability\n";
  each_cell(report, [&](const Eigen::Vector3d& p_W, int branches, double manipulability) {
    for (const double value : p_W) out += number(value) + ',';
    out += std::to_string(branches) + ',';
    if (branches > 0) out += number(manipulability);
    out += '\n';
  });
  return out;
}

render::PlotPanel panel_of(const WorkspaceReport& report, const std::string& title,
                           std::vector<double> values) {
  const WorkspaceMap& map = report.map;
  const double half = map.step / 2;
  render::PlotPanel panel{.title = title,
                          .x_label = text(msg::workspace_axis, axis_name(map.u)),
                          .y_label = text(msg::workspace_axis, axis_name(map.v)),
                          .equal_aspect = true};
  panel.field = render::PlotField{.x = {map.u_first - half, map.u_at(map.columns - 1) + half},
                                  .y = {map.v_first - half, map.v_at(map.rows - 1) + half},
                                  .columns = map.columns,
                                  .values = std::move(values)};
  const Eigen::Vector3d& p_W = report.arm.joints.front().X_PJ.p;
  const double u = p_W[map.u];
  const double v = p_W[map.v];
  const double arm = 0.04 * (panel.field->x.upper - panel.field->x.lower) / 2;
  panel.lines.push_back({.x = {u - arm, u + arm, kNone, u, u},
                         .y = {v, v, kNone, v - arm, v + arm},
                         .label = text(msg::workspace_base),
                         .color = 1,
                         .width = 2});
  return panel;
}

render::Plot plot_of(const WorkspaceReport& report) {
  const LanguageScope drawn(render::picture_language());
  const WorkspaceMap& map = report.map;
  std::vector<double> counts;
  for (const int branches : map.branches) counts.push_back(branches > 0 ? branches : kNone);
  render::PlotPanel branches = panel_of(
      report, text(map.counted ? msg::workspace_branches : msg::workspace_reached), counts);
  branches.field->whole_numbers = true;
  const int max = *std::max_element(map.branches.begin(), map.branches.end());
  branches.field->colors = {.lower = 1, .upper = std::max(max, 2) * 1.0};
  render::PlotPanel manipulability = panel_of(
      report, text(map.counted ? msg::workspace_manipulability : msg::workspace_manipulability_one),
      map.manipulability);
  const double best = std::transform_reduce(
      map.manipulability.begin(), map.manipulability.end(), 0.0,
      [](double a, double b) { return std::max(a, b); },
      [](double value) { return std::isnan(value) ? 0.0 : value; });
  manipulability.field->colors = {.lower = 0, .upper = std::max(best, 1e-9)};
  return {.title = text(msg::workspace_title, report.arm.name, axis_name(report.work.normal),
                        report.work.at),
          .note = workspace_summary(report),
          .panels = {std::move(branches), std::move(manipulability)},
          .panel_width = 330,
          .panel_height = 320};
}

}  // namespace

Result<WorkspaceFormat> workspace_format(const std::string& path) {
  if (path.empty()) return WorkspaceFormat::none;
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".png") return WorkspaceFormat::png;
  if (ending == ".svg") return WorkspaceFormat::svg;
  if (ending == ".csv") return WorkspaceFormat::csv;
  if (ending == ".json") return WorkspaceFormat::json;
  return fail(Errc::usage, text(msg::workspace_bad_ending, path));
}

std::string workspace_summary(const WorkspaceReport& report) {
  const Extent extent = extent_of(report);
  const std::string line = text(msg::workspace_line, report.arm.name, axis_name(report.work.normal),
                                report.work.at, orientation_text(report), extent.cells,
                                report.map.step, extent.cells * report.map.step * report.map.step);
  if (!extent.has_axis) return line;
  return text(msg::workspace_ring, line, extent.nearest, extent.farthest);
}

std::string workspace_json(const WorkspaceReport& report) {
  const WorkspaceMap& map = report.map;
  const Extent extent = extent_of(report);
  std::string out;
  JsonWriter json(out);
  json.object().member("robot", report.arm.name).member("tip", report.arm.tip);
  json.key("slice")
      .object()
      .member("axis", axis_name(report.work.normal))
      .member("at", report.work.at)
      .end_object()
      .key("quat");
  if (report.work.R_WT) {
    const Quat q = to_quat(*report.work.R_WT);
    json.value(std::vector{q.w(), q.x(), q.y(), q.z()});
  } else {
    json.value(nullptr);
  }
  json.member("step", map.step).member("reached", extent.cells);
  if (extent.has_axis) json.member("nearest", extent.nearest).member("farthest", extent.farthest);
  json.member("columns", map.columns)
      .member("rows", map.rows)
      .member("axes", std::vector{axis_name(map.u), axis_name(map.v)})
      .member("first", std::vector{map.u_first, map.v_first})
      .member("counted", map.counted)
      .key("branches")
      .list();
  for (const int branches : map.branches) json.value(branches);
  json.end_list().member("manipulability", map.manipulability).end_object();
  return out + '\n';
}

Result<void> write_workspace(const WorkspaceReport& report, const std::string& path,
                             WorkspaceFormat format) {
  switch (format) {
    case WorkspaceFormat::none:
      return {};
    case WorkspaceFormat::csv:
      return write_file(path, csv_of(report));
    case WorkspaceFormat::json:
      return write_file(path, workspace_json(report));
    case WorkspaceFormat::svg: {
      const Result<std::string> svg = render::plot_svg(plot_of(report));
      return svg ? write_file(path, *svg) : fail(svg.error());
    }
    case WorkspaceFormat::png: {
      const Result<render::Image> image = render::plot_image(plot_of(report));
      return image ? render::write_png(*image, path) : fail(image.error());
    }
  }
  return {};
}

}  // namespace mjarm::app
