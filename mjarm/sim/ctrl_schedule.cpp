#include "mjarm/sim/ctrl_schedule.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

#include "mjarm/core/csv.hpp"
#include "mjarm/core/line_reader.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/sim.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/sim/state_columns.hpp"

namespace mjarm {
namespace {

std::vector<std::string> actuator_names(const Model& model) {
  std::vector<std::string> names;
  for (const StateColumn& column : state_columns(model).ctrl) names.push_back(column.name);
  return names;
}

/// A value that the actuator can take; MuJoCo would clamp others without a word.
Result<void> check_value(const Model& model, int actuator, const std::string& name, double value) {
  const mjModel& m = *model.raw();
  constexpr double kRounding = 1e-9;
  const double lower = m.actuator_ctrlrange[2 * actuator];
  const double upper = m.actuator_ctrlrange[2 * actuator + 1];
  const bool limited = m.actuator_ctrllimited[actuator] != 0;
  if (std::isfinite(value) &&
      (!limited || (value >= lower - kRounding && value <= upper + kRounding))) {
    return {};
  }
  if (!limited) return fail(Errc::bad_input, text(msg::sim_ctrl_not_finite, name, value));
  return fail(Errc::bad_input, text(msg::sim_ctrl_range, name, value, lower, upper));
}

Error at(const LineReader& reader, const std::string& what) {
  return {Errc::bad_input, text(msg::core_at_place, reader.place(), what)};
}

/// `ctrl left [rad]` -> `left`; names in a header.
std::string_view bare_title(std::string_view title) {
  if (title.starts_with("ctrl ")) title.remove_prefix(5);
  if (title.ends_with(']')) {
    if (const std::size_t unit = title.rfind(" ["); unit != std::string_view::npos) {
      title = title.substr(0, unit);
    }
  }
  return title;
}

/// Which column of the table is what.
struct Header {
  std::vector<int> actuators;        ///< number in the model
  std::vector<std::size_t> columns;  ///< of these, in the table
  std::vector<std::string> names;
  std::size_t width = 0;
};

Result<Header> read_header(const Model& model, LineReader& reader) {
  const Result<std::optional<std::string_view>> line = reader.next();
  if (!line) return fail(line.error());
  if (!*line) return fail(Errc::bad_input, text(msg::sim_csv_empty, reader.name()));
  const std::vector<std::string> titles = csv_fields(**line);
  if (titles.empty() || bare_title(titles.front()) != "time") {
    return fail(at(reader, text(msg::sim_csv_time, titles.empty() ? "" : titles.front())));
  }
  Header header{.actuators = {}, .columns = {}, .names = {}, .width = titles.size()};
  for (std::size_t i = 1; i < titles.size(); ++i) {
    const auto is_of = [&](const char* kind) { return titles[i].starts_with(kind); };
    if (is_of("qpos ") || is_of("qvel ") || is_of("sensor ")) continue;
    const std::string name(bare_title(titles[i]));
    const Result<int> actuator = find_actuator(model, name);
    if (!actuator) return fail(at(reader, actuator.error().what));
    if (std::ranges::count(header.actuators, *actuator) > 0) {
      return fail(at(reader, text(msg::sim_csv_twice, name)));
    }
    header.actuators.push_back(*actuator);
    header.columns.push_back(i);
    header.names.push_back(name);
  }
  if (header.actuators.empty()) return fail(at(reader, text(msg::sim_csv_no_actuator)));
  return header;
}

}  // namespace

Result<int> find_actuator(const Model& model, std::string_view name) {
  const std::vector<std::string> names = actuator_names(model);
  if (names.empty()) return fail(Errc::bad_input, text(msg::sim_no_actuators, name));
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  for (int i = 0; i < model.nu(); ++i) {
    const char* real = mj_id2name(model.raw(), mjOBJ_ACTUATOR, i);
    const bool bare = real == nullptr || *real == '\0';
    if (bare && (name == std::to_string(i) || name == "#" + std::to_string(i))) return i;
  }
  return fail(Errc::bad_input,
              text(msg::sim_unknown_actuator, name, did_you_mean(name, names), listed(names)));
}

Result<CtrlSchedule> CtrlSchedule::constant(const Model& model,
                                            const std::map<int, double>& values) {
  const std::vector<std::string> names = actuator_names(model);
  CtrlSchedule schedule;
  for (const auto& [actuator, value] : values) {
    auto fits = check_value(model, actuator, names[static_cast<std::size_t>(actuator)], value);
    if (!fits) return fail(std::move(fits.error()));
    schedule.actuators_.push_back(actuator);
    schedule.values_.push_back(value);
  }
  if (!values.empty()) schedule.times_.push_back(0);
  return schedule;
}

Result<CtrlSchedule> CtrlSchedule::read_csv(const Model& model, const std::filesystem::path& file) {
  Result<LineReader> reader = LineReader::open(file.string());
  if (!reader) return fail(reader.error());
  const Result<Header> header = read_header(model, *reader);
  if (!header) return fail(header.error());
  CtrlSchedule schedule;
  schedule.actuators_ = header->actuators;
  for (;;) {
    const Result<std::optional<std::string_view>> line = reader->next();
    if (!line) return fail(line.error());
    if (!*line) break;
    const std::vector<std::string> fields = csv_fields(**line);
    if (fields.size() != header->width) {
      return fail(at(*reader, text(msg::sim_csv_width, fields.size(), header->width)));
    }
    const Result<double> time = parse_quantity(fields.front(), Quantity::time);
    if (!time) return fail(at(*reader, time.error().what));
    if (*time < 0 || (!schedule.times_.empty() && *time <= schedule.times_.back())) {
      return fail(at(*reader, text(msg::sim_csv_order, *time)));
    }
    schedule.times_.push_back(*time);
    for (std::size_t i = 0; i < header->columns.size(); ++i) {
      const Result<double> value = parse_quantity(fields[header->columns[i]], Quantity::number);
      if (!value) return fail(at(*reader, value.error().what));
      auto fits = check_value(model, header->actuators[i], header->names[i], *value);
      if (!fits) return fail(at(*reader, fits.error().what));
      schedule.values_.push_back(*value);
    }
    if (schedule.values_.size() > kMaxValues) {
      return fail(at(*reader, text(msg::sim_csv_long, kMaxValues)));
    }
  }
  if (schedule.times_.empty()) {
    return fail(Errc::bad_input, text(msg::sim_csv_empty, reader->name()));
  }
  return schedule;
}

void CtrlSchedule::apply(double time, std::span<double> ctrl) const {
  constexpr double kRounding = 1e-9;  // [s] of a clock that counts steps
  const auto after = std::ranges::upper_bound(times_, time + kRounding);
  if (after == times_.begin()) return;
  const auto row = static_cast<std::size_t>(after - times_.begin()) - 1;
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    ctrl[static_cast<std::size_t>(actuators_[i])] = values_[row * actuators_.size() + i];
  }
}

}  // namespace mjarm
