#pragma once

#include <string_view>

#include "mjarm/core/os_child.hpp"
#include "mjarm/model/load_internal.hpp"

/// What the two ways to compile what is not trusted share: a copy of the process on Linux, a
/// process of its own on Windows.
namespace mjarm {

inline constexpr ChildLimits kTrialLimits;

/// What such a process says: a letter a stage, then one of these and what belongs to it.
inline constexpr char kTrialError = 'E';  ///< code, text
inline constexpr char kTrialModel = 'M';  ///< warnings and files read, compiled model

/// The stages at the front of `said` are taken off; the last of them counts.
[[nodiscard]] Stage take_stages(std::string_view& said);

/// Why a process that did not come to its end stands against the description.
[[nodiscard]] Error bad_end(const SpecSource& source, const ChildResult& result, Stage stage);

}  // namespace mjarm
