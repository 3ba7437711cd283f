#pragma once

#include <string>
#include <utility>

namespace mjarm {

/// What kind of thing went wrong.
enum class Errc {
  bad_input,      ///< a file or value is malformed, missing or of the wrong size
  usage,          ///< the call itself makes no sense (unknown name, contradicting options)
  impossible,     ///< well-formed, but cannot be done (unreachable, limit broken, check failed)
  system,         ///< the operating system refused (disk full, no permission, no display)
  not_available,  ///< something optional is missing on this machine (GL back end, mesh, library)
};

/// A cold failure (loading, options, files): a code and one line of text in the user's language,
/// which names the file and the element and what was expected.
struct Error {
  Errc code = Errc::bad_input;
  std::string what;
};

}  // namespace mjarm
