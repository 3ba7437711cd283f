#include "mjarm/identification/joint_log.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "mjarm/core/csv.hpp"
#include "mjarm/core/line_reader.hpp"
#include "mjarm/core/messages/identification.hpp"
#include "mjarm/core/units.hpp"

namespace mjarm {
namespace {

/// Where the columns stand that matter.
struct LogColumns {
  std::size_t count = 0;
  std::vector<std::string> names;   // as the table has them: time, q of each joint, torques
  std::vector<std::size_t> places;  // in the same order
};

std::string joint_names(const Arm& arm) {
  std::string out;
  for (const ArmJoint& joint : arm.joints) out += (out.empty() ? "" : ", ") + joint.name;
  return out;
}

Result<LogColumns> find_columns(const std::string& file, std::string_view head, const Arm& arm) {
  const std::vector<std::string> titles = csv_fields(head);
  LogColumns out;
  out.count = titles.size();
  std::vector<std::string> wanted = {"time"};
  for (const char* quantity : {"q ", "torque "}) {
    for (const ArmJoint& joint : arm.joints) wanted.push_back(quantity + joint.name);
  }
  for (const std::string& name : wanted) {
    const auto found = std::ranges::find_if(titles, [&](const std::string& title) {
      return title == name || title.starts_with(name + " [");
    });
    if (found == titles.end()) {
      return fail(Errc::bad_input,
                  text(msg::identification_no_column, file, name, joint_names(arm)));
    }
    out.places.push_back(static_cast<std::size_t>(found - titles.begin()));
    out.names.push_back(*found);
  }
  return out;
}

/// The numbers of one row, in the order of `columns`.
Result<std::vector<double>> read_row(const std::string& place, std::string_view line,
                                     const LogColumns& columns) {
  const std::vector<std::string> fields = csv_fields(line);
  if (fields.size() != columns.count) {
    return fail(Errc::bad_input,
                text(msg::identification_short_row, place, fields.size(), columns.count));
  }
  std::vector<double> out;
  for (std::size_t i = 0; i < columns.places.size(); ++i) {
    const std::string& field = fields[columns.places[i]];
    const Result<double> value = parse_quantity(field, Quantity::number);
    if (!value) {
      return fail(Errc::bad_input,
                  text(msg::identification_bad_number, place, columns.names[i], field));
    }
    out.push_back(*value);
  }
  return out;
}

}  // namespace

Result<JointLog> read_joint_log(const std::filesystem::path& file, const Arm& arm) {
  constexpr double kEven = 0.02;  // of a time step
  Result<LineReader> reader = LineReader::open(file.string());
  if (!reader) return fail(std::move(reader.error()));
  auto line = reader->next();
  if (!line) return fail(line.error());
  const Result<LogColumns> columns = find_columns(file.string(), line->value_or(""), arm);
  if (!columns) return fail(columns.error());
  JointLog out;
  std::vector<double> before;
  const Eigen::Index n = arm.dof();
  for (line = reader->next(); line && *line; line = reader->next()) {
    const Result<std::vector<double>> row = read_row(reader->place(), **line, *columns);
    if (!row) return fail(row.error());
    // Where a motion ends and the next one begins stands in a log for both.
    if (out.q.size() > 1 && *row == before) continue;
    const double step = before.empty() ? 0 : row->front() - before.front();
    before = *row;
    if (out.q.size() == 1) out.timestep = step;
    if (!out.q.empty() &&
        !(out.timestep > 0 && std::abs(step - out.timestep) < kEven * out.timestep)) {
      return fail(Errc::bad_input,
                  text(msg::identification_uneven, reader->place(), step, out.timestep));
    }
    out.q.emplace_back(Eigen::Map<const Eigen::VectorXd>(row->data() + 1, n));
    out.torque.emplace_back(Eigen::Map<const Eigen::VectorXd>(row->data() + 1 + n, n));
  }
  if (!line) return fail(line.error());
  return out;
}

}  // namespace mjarm
