#pragma once

#include <string>
#include <vector>

#include "apps/mjarm/learn/exercise.hpp"
#include "mjarm/core/json.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// What functions of a reader are called with; what they return is told in `answer`.
struct PythonTask {
  std::string function;  ///< its name in the reader's file
  std::string robot;     ///< name or path of the robot that it gets
  std::string call;      ///< Python: `function`, `robot` and one `case` to what it returns
  std::vector<std::string> cases = {};  ///< JSON, one a call
};

/// What came of one call.
struct PythonCase {
  std::string refused = {};                    ///< the name of the exception, or "None"; else empty
  std::vector<std::vector<double>> rows = {};  ///< a single list is one row
  std::string odd = {};  ///< why the value cannot be read: its type, or what is not finite
};

/// Runs the reader's file in a Python of its own, which may take a minute of time, and calls the
/// function once a case.
/// @return an error that names the file and what Python said where it does not come that far.
[[nodiscard]] Result<std::vector<PythonCase>> ask_python(const Exercise& exercise,
                                                         const PythonTask& task);

}  // namespace mjarm::app
