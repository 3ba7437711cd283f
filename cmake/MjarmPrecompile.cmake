# The headers that most files of the rooms begin with, compiled once: a build takes much less time. The
# macros here must be those that every room has.
set(MJARM_PRECOMPILED <Eigen/Core> <Eigen/Geometry> <algorithm> <cmath> <filesystem> <functional>
                      <map> <memory> <optional> <set> <string> <tl/expected.hpp> <vector>)
foreach(header core/joint_state core/messages core/result core/rotation model/arm)
  list(APPEND MJARM_PRECOMPILED "${PROJECT_SOURCE_DIR}/mjarm/${header}.hpp")
endforeach()
file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/precompiled.cpp" CONTENT "")
add_library(mjarm_precompiled OBJECT "${PROJECT_BINARY_DIR}/precompiled.cpp")
target_compile_features(mjarm_precompiled PUBLIC cxx_std_20)
target_compile_definitions(mjarm_precompiled PRIVATE EIGEN_MAX_STATIC_ALIGN_BYTES=32)
target_include_directories(mjarm_precompiled PRIVATE "${PROJECT_SOURCE_DIR}")
target_link_libraries(mjarm_precompiled PRIVATE Eigen3::Eigen tl::expected mjarm_options)
target_precompile_headers(mjarm_precompiled PRIVATE ${MJARM_PRECOMPILED})
if(MJARM_TESTS)
  # A program, as what is compiled for one is not position-independent in the same way.
  file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/precompiled_tests.cpp" CONTENT "int main() {}\n")
  add_executable(mjarm_precompiled_tests EXCLUDE_FROM_ALL
                                         "${PROJECT_BINARY_DIR}/precompiled_tests.cpp")
  target_compile_definitions(mjarm_precompiled_tests PRIVATE EIGEN_MAX_STATIC_ALIGN_BYTES=32)
  target_include_directories(mjarm_precompiled_tests PRIVATE "${PROJECT_SOURCE_DIR}")
  target_link_libraries(mjarm_precompiled_tests PRIVATE Eigen3::Eigen tl::expected GTest::gmock
                                                        mjarm_options)
  target_compile_options(mjarm_precompiled_tests PRIVATE ${MJARM_TEST_FLAGS})
  target_precompile_headers(mjarm_precompiled_tests PRIVATE ${MJARM_PRECOMPILED} <gmock/gmock.h>
                            <gtest/gtest.h>)
endif()
