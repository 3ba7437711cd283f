#pragma once

namespace mjarm::detail {

/// Lanes of one block, whatever the registers: what is computed does not depend on their width but
/// for rounding.
inline constexpr int kBlock = 8;

}  // namespace mjarm::detail
