#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/model/describe.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm::app {

/// What `mjarm model info` tells.
struct ModelReport {
  std::string file, format;
  ModelInfo contents;
  std::optional<Arm> arm;
  std::string no_arm;             ///< why there is none
  std::vector<std::string> tips;  ///< frames fixed to the last joint: possible tool frames
};

[[nodiscard]] ModelReport model_report(const Model& model, const Result<Arm>& arm);

/// The report for people, in the language in use.
[[nodiscard]] std::string to_text(const ModelReport& report);
/// The report as one JSON document; numbers without a bound are null.
[[nodiscard]] std::string to_json(const ModelReport& report);

/// The bodies as an indented tree with joints, sites, geoms and masses.
[[nodiscard]] std::string tree_text(const ModelInfo& contents);
/// The same as one JSON document, children inside their parents.
[[nodiscard]] std::string tree_json(const ModelInfo& contents);

}  // namespace mjarm::app
