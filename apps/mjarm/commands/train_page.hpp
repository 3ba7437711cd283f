#pragma once

#include <filesystem>
#include <memory>

#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/rl/reach_options.hpp"

namespace mjarm::app {

/// A window or page beside a training: the newest policy at work, and how far it has come. It reads
/// the files of the training and nothing else, so that it cannot disturb it.
class TrainPage {
 public:
  /// Opens it where the main thread stands ready for that (`run_beside`).
  /// @return what `RemoteWindow::open` says.
  [[nodiscard]] static Result<std::unique_ptr<TrainPage>> open(const Model& model,
                                                               const rl::ReachOptions& task);
  /// The files are those in `folder` from now on.
  void follow(const std::filesystem::path& folder);
  /// Closes it.
  ~TrainPage();
  TrainPage(const TrainPage&) = delete;
  TrainPage& operator=(const TrainPage&) = delete;

 private:
  struct Impl;
  explicit TrainPage(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm::app
