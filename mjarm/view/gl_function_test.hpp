#pragma once

#include "mjarm/core/os.hpp"

namespace mjarm::testing {

/// A function of OpenGL, from the library that passes it on to the context of the thread; null
/// where it is not there.
inline void (*gl_function(const char* name))() {
  static const Result<void*> library = open_library("libOpenGL.so.0");
  if (!library) return nullptr;
  return reinterpret_cast<void (*)()>(library_symbol(*library, name));
}

}  // namespace mjarm::testing
