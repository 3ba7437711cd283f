# On which systems mjarm can be built; said before anything else is looked for. Needs no project(), so that a
# machine without a compiler is told as well.
set(mjarm_system "")
if(CMAKE_SYSTEM_NAME AND NOT CMAKE_SYSTEM_NAME MATCHES "^(Linux|Windows)$")  # of a tool chain for another system
  set(mjarm_system "${CMAKE_SYSTEM_NAME}")
elseif(CMAKE_HOST_APPLE)
  set(mjarm_system "macOS")
elseif(NOT CMAKE_HOST_LINUX AND NOT CMAKE_HOST_WIN32)
  set(mjarm_system "this system")
endif()
if(mjarm_system)
  message(FATAL_ERROR "mjarm is built for Linux (Debian 12, Ubuntu 24.04 or like them) and for Windows so far, not for ${mjarm_system}. "
                      "See README.md, \"Where it runs\".")
endif()
