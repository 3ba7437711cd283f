#pragma once

#include <functional>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/model/xml_sources_internal.hpp"

namespace mjarm {

/// The description that a model was compiled from, read once more.
class SpecOrigin {
 public:
  explicit SpecOrigin(const Model& model, bool allow_outside = true);

  /// Parsed; null, with `error` filled, where that is not possible any more.
  [[nodiscard]] MjSpecPtr parse(std::string& error) const;

  /// Compiled again, guarded as on loading, after `prepare` has changed the description.
  [[nodiscard]] Result<LoadedModel> compile(const std::function<void(mjSpec*)>& prepare) const;

 private:
  void finish(mjSpec* spec) const;

  const Model& model_;
  XmlSources files_;
};

}  // namespace mjarm
