#pragma once

#include <compare>

namespace mjarm {

/// Where something stands in a file, both from 1; 0 where it comes from no file.
struct FilePlace {
  int line = 0;
  int column = 0;

  /// In the order of the text.
  friend auto operator<=>(const FilePlace&, const FilePlace&) = default;
};

}  // namespace mjarm
