#pragma once

#include <filesystem>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/view/recorded_run.hpp"

namespace mjarm::serve {

/// The page as one file that needs no server and no network: the run is played and scrubbed in it;
/// where the page was built with its kinematics (`ik.wasm`), and the run has an arm, that is led by
/// its tool as in a live session.
/// Nothing but what is in the file may run or be loaded (a content security policy with hashes).
/// @return not_available where the page is not there (`page_folder()`); bad_input for a camera that
///         the model does not have.
[[nodiscard]] Result<std::string> run_page(const view::RecordedRun& run);

/// Writes it in one step.
/// @return also what `write_file` says.
[[nodiscard]] Result<void> write_run_page(const std::filesystem::path& file,
                                          const view::RecordedRun& run);

}  // namespace mjarm::serve
