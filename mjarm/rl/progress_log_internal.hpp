#pragma once

#include <filesystem>
#include <optional>

#include "mjarm/core/result.hpp"
#include "mjarm/rl/event_log.hpp"
#include "mjarm/rl/training.hpp"

namespace mjarm::rl::detail {

/// The rows of a training, as CSV and for TensorBoard.
class ProgressLog {
 public:
  /// @param keep  steps of the checkpoint that goes on; kNoStep: anew.
  [[nodiscard]] static Result<ProgressLog> open(const std::filesystem::path& folder,
                                                std::int64_t keep);
  [[nodiscard]] Result<void> add(const TrainingStep& step);

 private:
  ProgressLog(CsvLog csv, EventLog events) : csv_(std::move(csv)), events_(std::move(events)) {}
  CsvLog csv_;
  EventLog events_;
};

}  // namespace mjarm::rl::detail
