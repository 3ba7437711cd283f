#pragma once

#include <string>

namespace mjarm::perception {

/// Why an object, or a tag, has no pose.
enum class FindErrc {
  not_seen,    ///< nothing in the picture is it
  tag_twice,   ///< two tags with its number are seen
  wrong_size,  ///< its tag is seen at another size than it was told to have
  no_depth,    ///< too few of its pixels have a depth
  disagrees,   ///< depth contradicts its shape where its tag says it is: a tag on another face
  occluded,    ///< too much of it is hidden, or outside of the picture
  ambiguous,   ///< several poses or objects explain what is seen equally well
  touching,    ///< it is seen as one with something else
};

/// One sentence, in the language in use.
[[nodiscard]] std::string describe(FindErrc code);

}  // namespace mjarm::perception
