# What `cmake --install` puts where, and what `find_package(mjarm CONFIG)` finds there.
include(CMakePackageConfigHelpers)

get_property(rooms GLOBAL PROPERTY mjarm_rooms)
list(TRANSFORM rooms PREPEND mjarm_)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME development)  # what programs are built with, as against what is run
install(TARGETS ${rooms} EXPORT mjarmTargets FILE_SET HEADERS FILE_SET lists)
install(TARGETS mjarm_all EXPORT mjarmTargets)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)
install(TARGETS mjarm)
install(TARGETS mjarm-bench OPTIONAL)  # `./dev` builds it when it is asked for first
install(DIRECTORY "${PROJECT_SOURCE_DIR}/models/" DESTINATION "${CMAKE_INSTALL_DATADIR}/mjarm/models"
        OPTIONAL)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/examples/programs" DESTINATION "${CMAKE_INSTALL_DATADIR}/mjarm")
# The pages, with the pictures and programs that they link to, beside each other as in a clone.
install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs" DESTINATION "${CMAKE_INSTALL_DATADIR}/mjarm" PATTERN roadmap.md EXCLUDE)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/examples/learn" DESTINATION "${CMAKE_INSTALL_DATADIR}/mjarm/examples")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/python/examples" "${PROJECT_SOURCE_DIR}/python/lerobot_env_mjarm" DESTINATION "${CMAKE_INSTALL_DATADIR}/mjarm/python")
file(GLOB python_pages "${PROJECT_SOURCE_DIR}/python/README*.md")
install(FILES ${python_pages} DESTINATION "${CMAKE_INSTALL_DATADIR}/mjarm/python")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/web/dist/" DESTINATION "${CMAKE_INSTALL_DATADIR}/mjarm/page" OPTIONAL)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/bench/peers" DESTINATION "${CMAKE_INSTALL_DATADIR}/mjarm/bench")
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}")

# MuJoCo goes along, with its licences, so that the installed tree is complete.
if(WIN32)
  install(PROGRAMS "${MuJoCo_DLL}" DESTINATION "${CMAKE_INSTALL_BINDIR}")
  install(FILES "${MuJoCo_LIBRARY}" DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development)
  file(COPY "${MuJoCo_DLL}" DESTINATION "${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")  # programs look beside themselves
else()
  file(REAL_PATH "${MuJoCo_LIBRARY}" mujoco_file)
  install(PROGRAMS "${mujoco_file}" DESTINATION "${CMAKE_INSTALL_LIBDIR}"
          RENAME "libmujoco.so.${MuJoCo_VERSION}")
endif()
install(DIRECTORY "${MuJoCo_INCLUDE_DIR}/mujoco" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT development)
file(GLOB mujoco_licences "${MUJOCO_ROOT}/LICENSE*"
     "${MUJOCO_ROOT}/../mujoco_core-*.dist-info/licenses/LICENSE*")
install(FILES ${mujoco_licences} DESTINATION "${CMAKE_INSTALL_DOCDIR}/mujoco")
if(MJARM_LICENCES)  # of libraries that are linked into the program
  install(DIRECTORY "${MJARM_LICENCES}/" DESTINATION "${CMAKE_INSTALL_DOCDIR}/licences")
endif()

set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME development)
set(config_dir "${CMAKE_INSTALL_LIBDIR}/cmake/mjarm")
install(EXPORT mjarmTargets NAMESPACE mjarm:: DESTINATION "${config_dir}")
configure_package_config_file(cmake/mjarmConfig.cmake.in mjarmConfig.cmake
                              INSTALL_DESTINATION "${config_dir}")
write_basic_package_version_file(mjarmConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/mjarmConfig.cmake"
              "${PROJECT_BINARY_DIR}/mjarmConfigVersion.cmake" cmake/FindMuJoCo.cmake
              cmake/FindOMPL.cmake cmake/FindAprilTag.cmake
        DESTINATION "${config_dir}")
include(MjarmPackage)
