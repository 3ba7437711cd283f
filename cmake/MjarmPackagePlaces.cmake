# Run by cpack for each package: the Debian one lies in a folder of its own, as its MuJoCo may not be that of the system;
# the program alone is where programs are.
if(CPACK_GENERATOR STREQUAL "DEB")
  set(CPACK_PACKAGING_INSTALL_PREFIX "/opt/mjarm")
  set(CPACK_PRE_BUILD_SCRIPTS "${CMAKE_CURRENT_LIST_DIR}/MjarmPackageLink.cmake")
endif()
