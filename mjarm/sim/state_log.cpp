#include "mjarm/sim/state_log.hpp"

#include <algorithm>
#include <cassert>

#include "mjarm/core/csv.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/number.hpp"

namespace mjarm {
namespace {

void append_titles(std::string& line, const char* kind, const std::vector<StateColumn>& columns) {
  for (const StateColumn& column : columns) {
    const std::string unit = column.unit.empty() ? "" : " [" + column.unit + "]";
    line += "," + csv_field(std::string(kind) + " " + column.name + unit);
  }
}

}  // namespace

StateLog::StateLog(const Model& model)
    : columns_(state_columns(model)),
      width_(1 + columns_.qpos.size() + columns_.qvel.size() + columns_.ctrl.size() +
             columns_.sensors.size()),
      max_rows_(std::clamp<std::size_t>(kMaxNumbers / width_, 2, kMaxRows)) {}

void StateLog::record(const Sim& sim, std::span<const double> ctrl) {
  assert(ctrl.size() == columns_.ctrl.size());
  const bool kept = calls_++ % stride_ == 0;
  if (kept) last_.clear();
  std::vector<double>& out = kept ? numbers_ : last_;
  if (!kept) out.clear();
  out.push_back(sim.time());
  for (const auto numbers : {sim.qpos(), sim.qvel(), ctrl, sim.sensor_data()}) {
    out.insert(out.end(), numbers.begin(), numbers.end());
  }
  if (kept && numbers_.size() / width_ > max_rows_) thin_out();
}

void StateLog::thin_out() {
  const std::size_t rows = numbers_.size() / width_;
  const std::size_t kept = (rows + 1) / 2;
  const bool last_goes = rows % 2 == 0;
  if (last_goes) last_.assign(numbers_.end() - static_cast<std::ptrdiff_t>(width_), numbers_.end());
  for (std::size_t i = 1; i < kept; ++i) {
    const auto from = numbers_.begin() + static_cast<std::ptrdiff_t>(2 * i * width_);
    std::copy_n(from, width_, numbers_.begin() + static_cast<std::ptrdiff_t>(i * width_));
  }
  numbers_.resize(kept * width_);
  stride_ *= 2;
}

Result<void> StateLog::write_csv(const std::filesystem::path& file) const {
  Result<AtomicFile> out = AtomicFile::create(file);
  if (!out) return fail(out.error());
  std::string line = "time [s]";
  append_titles(line, "qpos", columns_.qpos);
  append_titles(line, "qvel", columns_.qvel);
  append_titles(line, "ctrl", columns_.ctrl);
  append_titles(line, "sensor", columns_.sensors);
  line += '\n';
  for (std::size_t i = 0; i < size(); ++i) {
    if (Result<void> written = out->write(line); !written) return written;
    line.clear();
    for (const double value : row(i)) {
      append_number(line, value);
      line += ',';
    }
    line.back() = '\n';
  }
  if (Result<void> written = out->write(line); !written) return written;
  return out->commit();
}

}  // namespace mjarm
