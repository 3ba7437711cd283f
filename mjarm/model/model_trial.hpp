#pragma once

#include <optional>
#include <string>
#include <vector>

namespace mjarm {

/// On Windows `mjarm.exe` is also the process in which a file that is not trusted is tried out,
/// since a process cannot be copied there. To be called first in it.
/// @param arguments  of the program.
/// @return exit code of the trial; none where these arguments ask for none.
[[nodiscard]] std::optional<int> model_trial(const std::vector<std::string>& arguments);

}  // namespace mjarm
