#include "mjarm/teleop/input_file.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "mjarm/core/csv.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/teleop.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/core/trim.hpp"
#include "mjarm/core/units.hpp"

namespace mjarm {
namespace {

constexpr std::size_t kNeededColumns = 8;
constexpr std::array<std::string_view, 9> kInputColumns = {"time", "vx", "vy",      "vz",     "wx",
                                                           "wy",   "wz", "gripper", "in_tool"};
constexpr std::array<std::string_view, 9> kInputUnits = {
    " [s]", " [m/s]", " [m/s]", " [m/s]", " [rad/s]", " [rad/s]", " [rad/s]", "", ""};
constexpr std::size_t kMaxInputFile = std::size_t{64} << 20;  // [bytes]

bool has_columns(const std::vector<std::string>& fields) {
  return fields.size() == kNeededColumns || fields.size() == kInputColumns.size();
}

bool is_head(const std::vector<std::string>& fields) {
  if (!has_columns(fields)) return false;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string_view word = std::string_view(fields[i]).substr(0, fields[i].find('['));
    if (trimmed(word) != kInputColumns[i]) return false;
  }
  return true;
}

Error line_error(const std::string& source, std::size_t line, const std::string& what) {
  return {Errc::bad_input, text(msg::teleop_input_line, source, line, what)};
}

/// One line, without the head.
Result<TimedInput> input_of(const std::vector<std::string>& fields, TwistFrame frame) {
  if (!has_columns(fields)) {
    return fail(Errc::bad_input, text(msg::teleop_input_columns, kNeededColumns));
  }
  std::array<double, kInputColumns.size()> values{};
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const Result<double> value = parse_quantity(fields[i], Quantity::number);
    if (!value) return fail(value.error());
    values[i] = *value;
  }
  if (values[7] < 0 || values[7] > 1) {
    return fail(Errc::bad_input, text(msg::teleop_input_gripper, values[7]));
  }
  if (values[8] != 0 && values[8] != 1) {
    return fail(Errc::bad_input, text(msg::teleop_input_frame, values[8]));
  }
  TimedInput out;
  out.input.frame = frame;
  if (fields.size() > kNeededColumns) {
    out.input.frame = values[8] == 1 ? TwistFrame::tool : TwistFrame::world;
  }
  out.time = values[0];
  out.input.linear = {values[1], values[2], values[3]};
  out.input.angular = {values[4], values[5], values[6]};
  out.input.grip_to = values[7];
  return out;
}

}  // namespace

Result<std::vector<TimedInput>> parse_inputs(std::string_view csv, TwistFrame frame,
                                             const std::string& source) {
  std::vector<TimedInput> out;
  std::size_t number = 0;
  while (!csv.empty()) {
    const std::size_t end = std::min(csv.find('\n'), csv.size());
    const std::string_view line = csv.substr(0, end);
    csv.remove_prefix(std::min(end + 1, csv.size()));
    ++number;
    if (trimmed(line).empty()) continue;
    const std::vector<std::string> fields = csv_fields(line);
    if (out.empty() && is_head(fields)) continue;
    Result<TimedInput> input = input_of(fields, frame);
    if (!input) return fail(line_error(source, number, input.error().what));
    if (input->time < 0 || (!out.empty() && !(input->time > out.back().time))) {
      return fail(line_error(source, number, text(msg::teleop_input_time, input->time)));
    }
    out.push_back(std::move(*input));
  }
  if (out.empty()) return fail(Errc::bad_input, text(msg::teleop_input_empty, source));
  return out;
}

Result<std::vector<TimedInput>> read_inputs(const std::filesystem::path& file, TwistFrame frame) {
  const Result<std::string> bytes = read_file(file, kMaxInputFile);
  if (!bytes) return fail(bytes.error());
  return parse_inputs(*bytes, frame, file.string());
}

std::string inputs_csv(std::span<const TimedInput> inputs) {
  std::string out;
  for (std::size_t i = 0; i < kInputColumns.size(); ++i) {
    out +=
        std::string(i > 0 ? "," : "") + std::string(kInputColumns[i]) + std::string(kInputUnits[i]);
  }
  out += '\n';
  for (const TimedInput& one : inputs) {
    append_number(out, one.time);
    for (const Eigen::Vector3d& part : {one.input.linear, one.input.angular}) {
      for (const double value : part) {
        out += ',';
        append_number(out, value);
      }
    }
    out += ',';
    append_number(out, one.input.grip_to.value_or(0));
    out += one.input.frame == TwistFrame::tool ? ",1\n" : ",0\n";
  }
  return out;
}

}  // namespace mjarm
