#pragma once

#include <map>
#include <string>
#include <vector>

#include "apps/mjarm/cli/options.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/session/run_model.hpp"

namespace mjarm::app {

/// How a model is simulated, as it stands on the command line.
struct SimArguments {
  std::vector<std::string> ctrl;
  std::string ctrl_csv, keyframe, qpos;
};

/// Adds `--ctrl`, `--ctrl-csv`, `--keyframe` and `--qpos`, bound to `arguments`.
void add_sim_options(CLI::App& app, SimArguments& arguments);

/// The first of the options that is given; empty where none is.
[[nodiscard]] std::string first_given(const SimArguments& arguments);

/// Reads where the model begins: `--keyframe` or `--qpos`.
[[nodiscard]] Result<session::ModelStart> read_start(const Model& model,
                                                     const SimArguments& arguments);

/// Reads all of them.
/// @param seconds  [s] to be simulated, which is checked.
/// @return an error that names the option and, with the nearest word, what it should name.
[[nodiscard]] Result<session::ModelRunOptions> read_sim_options(const Model& model,
                                                                const SimArguments& arguments,
                                                                double seconds);

/// Reads `NAME=VALUE,...`, or one value for each of `columns`, in their order; a value may carry
/// the unit of its column, and degrees and millimetres need theirs.
/// @return pairs of a column's number and its value.
[[nodiscard]] Result<std::map<int, double>> parse_ctrl(const Model& model,
                                                       const std::vector<std::string>& words);

}  // namespace mjarm::app
