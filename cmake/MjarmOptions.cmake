# Compiler settings that hold for every target of mjarm, and for nobody who uses it.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")
set(CMAKE_INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # What ccache needs to see past precompiled headers. It compares the headers themselves, not what
  # the preprocessor makes of them: GCC knows the headers in a precompiled one by their bytes, so one
  # that differs in a comment alone would be read again, and all in it defined twice.
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros
                                  CCACHE_DEPEND=1 "${CCACHE_PROGRAM}")
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
endif()

add_library(mjarm_options INTERFACE)
target_compile_options(mjarm_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                                               -Wno-sign-conversion)
# No path of this machine in what is installed.
target_compile_options(mjarm_options INTERFACE "-fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(mjarm_options INTERFACE -Wno-restrict)  # false alarms in std::string
endif()
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # A source that is joined with others is taken for a header, whose types should have a name that
  # other files can see.
  target_compile_options(mjarm_options INTERFACE -Wno-subobject-linkage)
endif()
if(WIN32)
  target_compile_definitions(mjarm_options INTERFACE NOMINMAX WIN32_LEAN_AND_MEAN _WIN32_WINNT=0x0A00)
endif()
if(MJARM_WARNINGS_AS_ERRORS)
  target_compile_options(mjarm_options INTERFACE -Werror)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # These depend on what the optimiser sees, so they differ between releases of the compiler: news
  # for developers, who are not stopped by them, and noise for everybody else.
  set(silence "-Wno-")
  if(MJARM_WARNINGS_AS_ERRORS)
    set(silence "-Wno-error=")
  endif()
  foreach(warning maybe-uninitialized array-bounds stringop-overflow stringop-overread nonnull
                  free-nonheap-object)
    target_compile_options(mjarm_options INTERFACE ${silence}${warning})
  endforeach()
endif()
if(MJARM_SANITIZE)
  target_compile_options(mjarm_options INTERFACE -fsanitize=${MJARM_SANITIZE}
                                                 -fno-omit-frame-pointer)
  target_link_options(mjarm_options INTERFACE -fsanitize=${MJARM_SANITIZE})
  if(MJARM_SANITIZE MATCHES "address")
    # Else Eigen would allocate in another way than in libraries that are built without sanitizers,
    # and each free what the other has allocated.
    target_compile_definitions(mjarm_options INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1)
  endif()
  if(MJARM_SANITIZE MATCHES "thread" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Boost.Asio has fences, which this sanitizer does not follow; what it hands over is locked besides.
    target_compile_options(mjarm_options INTERFACE -Wno-tsan)
  endif()
  if(MJARM_SANITIZE MATCHES "undefined")
    target_compile_options(mjarm_options INTERFACE -fno-sanitize-recover=undefined)
  endif()
endif()
if(MJARM_COVERAGE)
  target_compile_options(mjarm_options INTERFACE --coverage)
  target_link_options(mjarm_options INTERFACE --coverage)
endif()
