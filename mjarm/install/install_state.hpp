#pragma once

#include <string>

namespace mjarm::install {

/// How something that was installed is found.
struct InstallState {
  enum class Kind {
    absent,
    damaged,   ///< files are missing or changed
    outdated,  ///< whole, but of another version of mjarm
    whole,
  };
  Kind kind = Kind::absent;
  std::string problem;  ///< one line where damaged or outdated
};

}  // namespace mjarm::install
