#include "mjarm/serve/live_messages.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/core/json_writer.hpp"
#include "mjarm/serve/byte_order_internal.hpp"
#include "mjarm/serve/json_parts_internal.hpp"

namespace mjarm::serve {
namespace {

double finite_or_zero(double value) { return std::isfinite(value) ? value : 0; }

/// A message that says one thing.
std::string line_message(const char* type, const char* member, std::string_view line) {
  std::string out;
  JsonWriter(out).object().member("type", type).member(member, line).end_object();
  return out;
}

const char* word_of(render::LineStyle style) {
  switch (style) {
    case render::LineStyle::dashed:
      return "dashed";
    case render::LineStyle::points:
      return "points";
    default:
      return "solid";
  }
}

/// A curve with as many points as a page takes; where one was left out for not being finite, so
/// that the curve has a gap, there is one.
struct ThinCurve {
  std::vector<double> x, y;  ///< y may be NaN
};

ThinCurve thinned(const view::LiveSeries& series) {
  const std::size_t count = std::min(series.x.size(), series.y.size());
  const std::size_t stride = count / (kMaxSeriesPoints - 1) + 1;
  ThinCurve out;
  const auto append = [&](std::size_t first, std::size_t end) {
    if (!std::isfinite(series.x[first])) return;
    bool whole = true;
    for (std::size_t i = first; i < end; ++i) whole = whole && std::isfinite(series.y[i]);
    out.x.push_back(series.x[first]);
    out.y.push_back(whole ? series.y[first] : std::nan(""));
  };
  if (count == 0) return out;
  for (std::size_t i = 0; i + 1 < count; i += stride) append(i, std::min(i + stride, count - 1));
  append(count - 1, count);
  return out;
}

void add_series(JsonWriter& json, const view::LiveSeries& series) {
  const ThinCurve curve = thinned(series);
  json.object().member("name", series.name);
  add_color(json, series.color);
  json.member("style", word_of(series.style)).key("x").list();
  for (const double x : curve.x) json.value(shortened(x));
  json.end_list().key("y").list();
  for (const double y : curve.y) {
    std::isfinite(y) ? json.value(shortened(y)) : json.value(nullptr);
  }
  json.end_list().end_object();
}

void add(JsonWriter& json, const view::PanelButton&) { json.member("kind", "button"); }
void add(JsonWriter& json, const view::PanelCheckbox& box) {
  json.member("kind", "checkbox").member("on", box.on);
}
void add(JsonWriter& json, const view::PanelSlider& slider) {
  json.member("kind", "slider").member("value", finite_or_zero(slider.value));
  json.member("lower", finite_or_zero(slider.lower)).member("upper", finite_or_zero(slider.upper));
}
void add(JsonWriter& json, const view::PanelText& line) {
  json.member("kind", "text").member("value", line.value);
}
void add(JsonWriter& json, const view::PanelChoice& choice) {
  json.member("kind", "choice").member("words", choice.words).member("current", choice.current);
}
void add(JsonWriter& json, const view::PanelList& list) {
  json.member("kind", "list").member("lines", list.lines).member("current", list.current);
}
void add(JsonWriter& json, const view::PanelTimeline& line) {
  json.member("kind", "timeline").member("time", finite_or_zero(line.time));
  json.member("end", finite_or_zero(line.end));
}

}  // namespace

std::string frame_message(const BodyPoses& poses, double time, bool paused, std::uint32_t number) {
  std::string out;
  const std::span<const double> p = poses.p_W();
  const std::span<const double> q = poses.quat();
  out.reserve(16 + 4 * (p.size() + q.size() + poses.qpos().size()));
  append_whole(out, std::uint8_t{1});
  append_whole(out, static_cast<std::uint8_t>(paused ? 1 : 0));
  append_whole(out, std::uint16_t{0});
  append_whole(out, number);
  append_f64(out, time);
  for (std::size_t body = 0; 4 * body < q.size(); ++body) {
    for (std::size_t i = 0; i < 3; ++i) append_f32(out, static_cast<float>(p[3 * body + i]));
    for (std::size_t i = 0; i < 4; ++i) append_f32(out, static_cast<float>(q[4 * body + i]));
  }
  for (const double value : poses.qpos()) append_f32(out, static_cast<float>(value));
  return out;
}

std::string hello_message() {
  std::string out;
  JsonWriter(out)
      .object()
      .member("type", "hello")
      .member("protocol", 1)
      .member("can_control", true)
      .end_object();
  return out;
}

std::string plots_message(std::span<const view::LivePlot> plots) {
  std::string out;
  JsonWriter json(out);
  json.object().member("type", "plots").key("plots").list();
  for (const view::LivePlot& plot : plots) {
    json.object().member("title", plot.title).member("x_label", plot.x_label);
    json.member("equal_aspect", plot.equal_aspect).member("y_from_zero", plot.y_from_zero);
    json.member("over_time", plot.over_time);
    json.key("series").list();
    for (const view::LiveSeries& series : plot.series) add_series(json, series);
    json.end_list().end_object();
  }
  json.end_list().end_object();
  return out;
}

std::string panels_message(std::span<const view::PanelSection> sections) {
  std::string out;
  JsonWriter json(out);
  json.object().member("type", "panels").key("sections").list();
  for (const view::PanelSection& section : sections) {
    json.object().member("title", section.title).member("open", section.open).key("items").list();
    for (const view::PanelItem& item : section.items) {
      json.object().member("id", item.id).member("name", item.name);
      json.member("enabled", item.enabled);
      std::visit([&json](const auto& what) { add(json, what); }, item.what);
      json.end_object();
    }
    json.end_list().end_object();
  }
  json.end_list().end_object();
  return out;
}

std::string status_message(std::string_view line) { return line_message("status", "line", line); }
std::string error_message(std::string_view what) { return line_message("error", "what", what); }
std::string bye_message(std::string_view what) { return line_message("bye", "what", what); }

std::string target_message(const view::TargetLook& look, bool turns) {
  std::string out;
  JsonWriter json(out);
  const bool finite = look.X_WT.p.allFinite() && look.X_WT.R.allFinite();
  const Pose X_WT = finite ? look.X_WT : Pose{};
  json.object().member("type", "target").member("shown", look.shown && finite);
  // Whole: what a page drags on from is where the target is, to the last digit.
  json.pose_members(X_WT).key("axes");
  if (look.R_WG && look.R_WG->allFinite()) {
    json.list();
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) json.value((*look.R_WG)(row, column));
    }
    json.end_list();
  } else {
    json.value(nullptr);
  }
  add_color(json, look.color);
  json.member("number", look.number).member("turns", turns).end_object();
  return out;
}

}  // namespace mjarm::serve
