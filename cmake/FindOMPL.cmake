# Finds the Open Motion Planning Library (Debian: libompl-dev) and makes the target OMPL::ompl.
#
# OMPL's own configuration names the development files of libraries that users of OMPL need not link,
# and which are missing where only libompl-dev is installed; so only OMPL itself is linked here.
#
# Sets OMPL_VERSION, OMPL_INCLUDE_DIR, OMPL_LIBRARY.
find_package(PkgConfig QUIET)
if(PKG_CONFIG_FOUND)
  pkg_check_modules(PC_OMPL QUIET ompl)
endif()
find_path(OMPL_INCLUDE_DIR ompl/config.h HINTS ${PC_OMPL_INCLUDE_DIRS} PATH_SUFFIXES ompl-1.7 ompl-1.6 ompl-1.5)
find_library(OMPL_LIBRARY ompl HINTS ${PC_OMPL_LIBRARY_DIRS})
find_path(OMPL_BOOST_INCLUDE_DIR boost/version.hpp)
mark_as_advanced(OMPL_INCLUDE_DIR OMPL_LIBRARY OMPL_BOOST_INCLUDE_DIR)

unset(OMPL_VERSION)
if(OMPL_INCLUDE_DIR)
  foreach(part MAJOR MINOR PATCH)
    file(STRINGS "${OMPL_INCLUDE_DIR}/ompl/config.h" _ompl_line REGEX "^#define OMPL_${part}_VERSION ")
    string(REGEX MATCH "[0-9]+$" _ompl_number "${_ompl_line}")
    list(APPEND OMPL_VERSION "${_ompl_number}")
  endforeach()
  string(REPLACE ";" "." OMPL_VERSION "${OMPL_VERSION}")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  OMPL REQUIRED_VARS OMPL_LIBRARY OMPL_INCLUDE_DIR OMPL_BOOST_INCLUDE_DIR VERSION_VAR OMPL_VERSION
  HANDLE_VERSION_RANGE REASON_FAILURE_MESSAGE "install libompl-dev, or pass -DMJARM_OMPL=OFF.")

if(OMPL_FOUND AND NOT TARGET OMPL::ompl)
  add_library(OMPL::ompl UNKNOWN IMPORTED)
  set_target_properties(
    OMPL::ompl PROPERTIES IMPORTED_LOCATION "${OMPL_LIBRARY}"
                          INTERFACE_INCLUDE_DIRECTORIES "${OMPL_INCLUDE_DIR};${OMPL_BOOST_INCLUDE_DIR}")
endif()
