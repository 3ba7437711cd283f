# Finds MuJoCo and makes the imported target MuJoCo::mujoco.
#
# MUJOCO_ROOT (cache or environment) names the folder to look in; default: where `./dev` puts it, or
# the prefix this file is installed to. Two layouts are known: that of the Python wheel (the library
# beside `include/`) and that of a release archive or an installed tree (`lib/` and `include/`).
#
# Sets MuJoCo_VERSION, MuJoCo_INCLUDE_DIR, MuJoCo_LIBRARY.
get_filename_component(_mujoco_default "${CMAKE_CURRENT_LIST_DIR}/../.deps/mujoco-core-4.0.1/mujoco" ABSOLUTE)
if(DEFINED MJARM_PREFIX)  # set by the installed mjarmConfig.cmake
  set(_mujoco_default "${MJARM_PREFIX}")
elseif(DEFINED ENV{MUJOCO_ROOT})
  set(_mujoco_default "$ENV{MUJOCO_ROOT}")
endif()
set(MUJOCO_ROOT "${_mujoco_default}" CACHE PATH "Folder of MuJoCo: holds include/mujoco/mujoco.h")

if(NOT MUJOCO_ROOT STREQUAL MuJoCo_SEARCHED)  # another folder than last time
  unset(MuJoCo_INCLUDE_DIR CACHE)
  unset(MuJoCo_LIBRARY CACHE)
  set(MuJoCo_SEARCHED "${MUJOCO_ROOT}" CACHE INTERNAL "Folder of the last search")
endif()
find_path(MuJoCo_INCLUDE_DIR mujoco/mujoco.h HINTS "${MUJOCO_ROOT}" PATH_SUFFIXES include
          NO_DEFAULT_PATH)

if(MuJoCo_INCLUDE_DIR)
  file(STRINGS "${MuJoCo_INCLUDE_DIR}/mujoco/mujoco.h" _mujoco_line
       REGEX "^#define mjVERSION_HEADER +[0-9]+")
  string(REGEX MATCH "[0-9]+$" _mujoco_number "${_mujoco_line}")
  # Since 4.0 the number is major * 10^6 + minor * 10^3 + patch; before, one digit each (3.3.7: 337).
  if(_mujoco_number GREATER_EQUAL 1000000)
    math(EXPR _mujoco_major "${_mujoco_number} / 1000000")
    math(EXPR _mujoco_minor "${_mujoco_number} / 1000 % 1000")
    math(EXPR _mujoco_patch "${_mujoco_number} % 1000")
  elseif(_mujoco_number)
    math(EXPR _mujoco_major "${_mujoco_number} / 100")
    math(EXPR _mujoco_minor "${_mujoco_number} / 10 % 10")
    math(EXPR _mujoco_patch "${_mujoco_number} % 10")
  endif()
  set(MuJoCo_VERSION "${_mujoco_major}.${_mujoco_minor}.${_mujoco_patch}")
endif()

find_library(MuJoCo_LIBRARY NAMES libmujoco.so.${MuJoCo_VERSION} mujoco HINTS "${MUJOCO_ROOT}"
             PATH_SUFFIXES . lib NO_DEFAULT_PATH)
mark_as_advanced(MuJoCo_INCLUDE_DIR MuJoCo_LIBRARY)
if(WIN32)  # what was found is what one links against
  find_file(MuJoCo_DLL mujoco.dll HINTS "${MUJOCO_ROOT}" PATH_SUFFIXES . bin NO_DEFAULT_PATH REQUIRED)
  mark_as_advanced(MuJoCo_DLL)
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  MuJoCo REQUIRED_VARS MuJoCo_LIBRARY MuJoCo_INCLUDE_DIR VERSION_VAR MuJoCo_VERSION
  REASON_FAILURE_MESSAGE
  "looked in ${MUJOCO_ROOT}. Run ./dev build, which fetches it, or pass -DMUJOCO_ROOT=FOLDER.")

if(MuJoCo_FOUND AND NOT TARGET MuJoCo::mujoco)
  add_library(MuJoCo::mujoco SHARED IMPORTED)
  set_target_properties(MuJoCo::mujoco PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${MuJoCo_INCLUDE_DIR}")
  if(WIN32)
    set_target_properties(MuJoCo::mujoco PROPERTIES IMPORTED_LOCATION "${MuJoCo_DLL}" IMPORTED_IMPLIB "${MuJoCo_LIBRARY}")
  else()
    set_target_properties(MuJoCo::mujoco PROPERTIES IMPORTED_LOCATION "${MuJoCo_LIBRARY}"
                                                    IMPORTED_SONAME "libmujoco.so.${MuJoCo_VERSION}")
  endif()
endif()
