#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/mjarm/bench/report.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// A pose as the files of cases and the peers write it.
[[nodiscard]] nlohmann::json pose_json(const Pose& X);

/// Takes one answer of a peer: the entry with everything but cells and details, and the line it
/// came in, whose members may be of any type (throws json's exceptions).
using TakeAnswer = std::function<Result<void>(BenchEntry entry, const nlohmann::json& line)>;

/// Runs the peers of a Python environment on one job, each in a process and a loop of its own
/// (`bench/peers/SUITE.py`). A peer that fails has an answer that says why.
/// @param environment  folder of a virtual environment with some of the peers in it.
/// @param job          all that a peer has to know; gets `folder`, where it may leave files for
///                     as long as `take` is called.
/// @return an error where the environment has no Python, an answer is broken, or the user stopped
///         it.
[[nodiscard]] Result<void> run_peers(const std::filesystem::path& environment,
                                     const std::string& suite, nlohmann::json job,
                                     const TakeAnswer& take);

}  // namespace mjarm::app
