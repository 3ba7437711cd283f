# Finds AprilTag 3 (Debian: libapriltag-dev) and makes the target apriltag::apriltag.
#
# Sets APRILTAG_INCLUDE_DIR, APRILTAG_LIBRARY.
find_path(APRILTAG_INCLUDE_DIR apriltag/tag36h11.h)
find_library(APRILTAG_LIBRARY apriltag)
mark_as_advanced(APRILTAG_INCLUDE_DIR APRILTAG_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  AprilTag REQUIRED_VARS APRILTAG_LIBRARY APRILTAG_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "install libapriltag-dev, or pass -DMJARM_APRILTAG=OFF.")

if(AprilTag_FOUND AND NOT TARGET apriltag::apriltag)
  add_library(apriltag::apriltag UNKNOWN IMPORTED)
  set_target_properties(
    apriltag::apriltag PROPERTIES IMPORTED_LOCATION "${APRILTAG_LIBRARY}"
                                  INTERFACE_INCLUDE_DIRECTORIES "${APRILTAG_INCLUDE_DIR}")
endif()
