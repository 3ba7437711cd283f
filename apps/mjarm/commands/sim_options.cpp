#include "apps/mjarm/commands/sim_options.hpp"

#include <algorithm>

#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/sim_command.hpp"
#include "mjarm/sim/state_columns.hpp"

namespace mjarm::app {
namespace {

/// One value for each of the columns, in their order.
Result<std::vector<double>> read_row(const char* option, const std::vector<std::string_view>& words,
                                     const std::vector<StateColumn>& columns) {
  if (words.size() != columns.size()) {
    return fail(Errc::bad_input,
                text(msg::sim_command_values, option, words.size(), columns.size()));
  }
  std::vector<double> values;
  for (std::size_t i = 0; i < words.size(); ++i) {
    Result<double> value = parse_quantity(words[i], columns[i].quantity);
    if (!value) return fail(in_option(option, std::move(value.error())));
    values.push_back(*value);
  }
  return values;
}

Result<void> add_named(const Model& model, const std::vector<StateColumn>& columns,
                       std::string_view entry, std::map<int, double>& out) {
  const std::size_t equals = entry.rfind('=');
  if (equals == std::string_view::npos) {
    return fail(Errc::usage, text(msg::sim_command_pair, entry));
  }
  const Result<int> actuator = find_actuator(model, entry.substr(0, equals));
  if (!actuator) return fail(in_option("--ctrl", actuator.error()));
  const Quantity quantity = columns[static_cast<std::size_t>(*actuator)].quantity;
  const Result<double> value = parse_quantity(entry.substr(equals + 1), quantity);
  if (!value) return fail(in_option("--ctrl", value.error()));
  if (!out.emplace(*actuator, *value).second) {
    return fail(Errc::usage, text(msg::sim_command_twice, entry.substr(0, equals)));
  }
  return {};
}

/// The table of `--ctrl-csv`, which may not speak of what `constants` says already.
Result<CtrlSchedule> read_table(const Model& model, const std::string& file,
                                const CtrlSchedule& constants) {
  Result<CtrlSchedule> table = CtrlSchedule::read_csv(model, file);
  if (!table) return fail(in_option("--ctrl-csv", std::move(table.error())));
  for (const int actuator : table->actuators()) {
    if (std::ranges::count(constants.actuators(), actuator) == 0) continue;
    const std::vector<StateColumn> columns = state_columns(model).ctrl;
    return fail(Errc::usage,
                text(msg::sim_command_both, columns[static_cast<std::size_t>(actuator)].name));
  }
  return table;
}

}  // namespace

void add_sim_options(CLI::App& app, SimArguments& arguments) {
  add_option(app, "--ctrl", arguments.ctrl, msg::sim_command_option_ctrl, "NAME=VALUE,...");
  add_option(app, "--ctrl-csv", arguments.ctrl_csv, msg::sim_command_option_csv, "FILE");
  add_option(app, "--keyframe", arguments.keyframe, msg::sim_command_option_keyframe, "NAME");
  add_option(app, "--qpos", arguments.qpos, msg::sim_command_option_qpos, "Q");
}

std::string first_given(const SimArguments& arguments) {
  if (!arguments.ctrl.empty()) return "--ctrl";
  if (!arguments.ctrl_csv.empty()) return "--ctrl-csv";
  if (!arguments.keyframe.empty()) return "--keyframe";
  return arguments.qpos.empty() ? "" : "--qpos";
}

Result<session::ModelStart> read_start(const Model& model, const SimArguments& arguments) {
  session::ModelStart start{.keyframe = arguments.keyframe};
  if (arguments.qpos.empty()) return start;
  if (!arguments.keyframe.empty()) {
    return fail(Errc::usage, text(msg::app_exclusive_options, "--keyframe", "--qpos"));
  }
  auto values = read_row("--qpos", split_list(arguments.qpos), state_columns(model).qpos);
  if (!values) return fail(std::move(values.error()));
  start.qpos = std::move(*values);
  return start;
}

Result<std::map<int, double>> parse_ctrl(const Model& model,
                                         const std::vector<std::string>& words) {
  const std::vector<StateColumn> columns = state_columns(model).ctrl;
  std::map<int, double> out;
  for (const std::string& part : words) {
    const std::vector<std::string_view> entries = split_list(part);
    if (part.find('=') == std::string::npos && words.size() == 1) {
      const auto row = read_row("--ctrl", entries, columns);
      if (!row) return fail(row.error());
      for (std::size_t i = 0; i < row->size(); ++i) out[static_cast<int>(i)] = (*row)[i];
      return out;
    }
    for (const std::string_view entry : entries) {
      if (auto added = add_named(model, columns, entry, out); !added) return fail(added.error());
    }
  }
  return out;
}

Result<session::ModelRunOptions> read_sim_options(const Model& model, const SimArguments& arguments,
                                                  double seconds) {
  if (auto length = session::check_run_length(model, seconds); !length) {
    return fail(in_option("--seconds", std::move(length.error())));
  }
  Result<session::ModelStart> start = read_start(model, arguments);
  if (!start) return fail(std::move(start.error()));
  session::ModelRunOptions options{.start = std::move(*start), .ctrl = {}, .seconds = seconds};
  const auto values = parse_ctrl(model, arguments.ctrl);
  if (!values) return fail(values.error());
  Result<CtrlSchedule> constants = CtrlSchedule::constant(model, *values);
  if (!constants) return fail(in_option("--ctrl", std::move(constants.error())));
  if (!arguments.ctrl_csv.empty()) {
    Result<CtrlSchedule> table = read_table(model, arguments.ctrl_csv, *constants);
    if (!table) return fail(std::move(table.error()));
    options.ctrl.push_back(std::move(*table));
  }
  options.ctrl.push_back(std::move(*constants));
  return options;
}

}  // namespace mjarm::app
