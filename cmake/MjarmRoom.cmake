# One room = one folder = one library. The files say by their names what they are:
#
#   NAME.hpp            public header: installed, must compile alone with what users have
#   NAME_internal.hpp   header of this room only: neither installed nor checked
#   simd/NAME.hpp       what the kernels of all rooms share: neither installed nor checked
#   NAME.cpp            source; NAME_avx2.cpp and NAME_avx512.cpp get their flags, on x86-64 only
#   NAME_linux.cpp, NAME_windows.cpp, NAME_linux_test.cpp ...   on that system only
#   NAME_test.cpp       into ROOM_test (GoogleTest)
#   NAME_bench.cpp      into ROOM_bench (google-benchmark, where found)
#
# mjarm_room(ROOM [DEPENDS room...] [PUBLIC target...] [PRIVATE target...])
function(mjarm_room room)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "DEPENDS;PUBLIC;PRIVATE")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "mjarm_room(${room}): unknown arguments: ${arg_UNPARSED_ARGUMENTS}")
  endif()
  file(GLOB headers CONFIGURE_DEPENDS *.hpp)
  file(GLOB lists CONFIGURE_DEPENDS messages/*.inc)
  file(GLOB sources CONFIGURE_DEPENDS *.cpp)
  file(GLOB tests CONFIGURE_DEPENDS *_test.cpp simd/*_test.cpp)
  file(GLOB benches CONFIGURE_DEPENDS *_bench.cpp)
  list(FILTER headers EXCLUDE REGEX "_(internal|test)\\.hpp$")
  list(REMOVE_ITEM sources ${tests} ${benches})
  mjarm_system_sources(sources)
  mjarm_system_sources(tests)
  mjarm_simd_flags(sources)
  if(NOT sources)
    file(CONFIGURE OUTPUT empty.cpp CONTENT "")
    set(sources "${CMAKE_CURRENT_BINARY_DIR}/empty.cpp")
  endif()

  set(lib mjarm_${room})
  list(TRANSFORM arg_DEPENDS PREPEND mjarm::)
  add_library(${lib} STATIC ${sources})
  add_library(mjarm::${room} ALIAS ${lib})
  set_target_properties(${lib} PROPERTIES EXPORT_NAME ${room})
  target_compile_features(${lib} PUBLIC cxx_std_20)
  target_sources(
    ${lib} PUBLIC FILE_SET HEADERS BASE_DIRS "${PROJECT_SOURCE_DIR}" FILES ${headers}
           FILE_SET lists TYPE HEADERS BASE_DIRS "${PROJECT_SOURCE_DIR}" FILES ${lists})
  target_link_libraries(${lib} PUBLIC ${arg_DEPENDS} ${arg_PUBLIC}
                               PRIVATE ${arg_PRIVATE} $<BUILD_INTERFACE:mjarm_options>)
  if(MJARM_PRECOMPILE)
    target_precompile_headers(${lib} REUSE_FROM mjarm_precompiled)
  endif()
  set_property(GLOBAL APPEND PROPERTY mjarm_rooms ${room})

  if(MJARM_TESTS AND tests)
    mjarm_tests(${room}_test PREFIX ${room} SOURCES ${tests} LINK mjarm::${room} ${arg_PRIVATE})
  endif()
  if(benchmark_FOUND AND benches)
    add_executable(${room}_bench EXCLUDE_FROM_ALL ${benches})
    target_link_libraries(${room}_bench PRIVATE mjarm::${room} ${arg_PRIVATE} mjarm_options
                                                benchmark::benchmark benchmark::benchmark_main)
    set_property(GLOBAL APPEND PROPERTY mjarm_benches ${room}_bench)
  endif()
endfunction()

# mjarm_tests(TARGET PREFIX text SOURCES file... LINK target...): one GoogleTest program, each of
# its tests a test of ctest with the name PREFIX.Suite.Name; skipped ones are reported as skipped.
# Tests of every room may call MuJoCo, as their oracle. What the user has installed is hidden from
# them: Chinese characters alone are four minutes of writing in `bench control`.
function(mjarm_tests target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "PREFIX" "SOURCES;LINK")
  add_executable(${target} ${arg_SOURCES})
  if(MJARM_SANITIZE)
    target_sources(${target} PRIVATE "${PROJECT_SOURCE_DIR}/tests/support/keep_libraries.cpp")
  endif()
  target_compile_options(${target} PRIVATE ${MJARM_TEST_FLAGS})
  if(MINGW)
    target_sources(${target} PRIVATE "${PROJECT_SOURCE_DIR}/apps/windows/utf8.rc")
  endif()
  if(WIN32)
    target_compile_options(${target} PRIVATE -include "${PROJECT_SOURCE_DIR}/tests/support/windows_names.hpp")
  endif()
  target_link_libraries(${target} PRIVATE ${arg_LINK} mjarm_options mjarm_testing MuJoCo::mujoco
                                          GTest::gtest_main GTest::gmock)
  if(MJARM_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM mjarm_precompiled_tests)
  endif()
  gtest_discover_tests(${target} TEST_PREFIX "${arg_PREFIX}." DISCOVERY_MODE PRE_TEST
                       DISCOVERY_TIMEOUT 60 PROPERTIES ENVIRONMENT MJARM_CACHE=off
                       ENVIRONMENT_MODIFICATION XDG_DATA_HOME=set:${PROJECT_BINARY_DIR}/no_user_data)
endfunction()

# Adds to a test program that of every list of messages in the folder.
function(mjarm_all_messages target)
  file(GLOB lists CONFIGURE_DEPENDS messages/*.inc)
  list(TRANSFORM lists REPLACE "(.+)" "#include \"\\1\"\n")
  list(JOIN lists "" lists)
  file(CONFIGURE OUTPUT all_messages.inc CONTENT "${lists}")
  target_include_directories(${target} PRIVATE "${CMAKE_CURRENT_BINARY_DIR}")
  target_sources(${target} PRIVATE "${PROJECT_SOURCE_DIR}/tests/support/all_messages_test.cpp")
endfunction()

# Drops what is for another system. Headers of Windows define short names, so no other source may share a unit with them.
function(mjarm_system_sources list_name)
  set(files ${${list_name}})
  if(WIN32)
    list(FILTER files EXCLUDE REGEX "_linux(_test)?\\.cpp$")
    set(windows ${files})
    list(FILTER windows INCLUDE REGEX "_windows\\.cpp$")
    set_source_files_properties(${windows} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
  else()
    list(FILTER files EXCLUDE REGEX "_windows(_test)?\\.cpp$")
  endif()
  set(${list_name} ${files} PARENT_SCOPE)
endfunction()

# Sets the flags of the kernels for wider registers, and drops them where the machine has none.
# What runs is chosen at run time, so no other file may be compiled for more than the baseline.
function(mjarm_simd_flags list_name)
  set(files ${${list_name}})
  set(avx2 ${files})
  set(avx512 ${files})
  list(FILTER avx2 INCLUDE REGEX "_avx2\\.cpp$")
  list(FILTER avx512 INCLUDE REGEX "_avx512\\.cpp$")
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
    # What was precompiled for the baseline is of no use to them.
    set_source_files_properties(${avx2} PROPERTIES
                                COMPILE_OPTIONS "-mavx2;-mfma"
                                SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
    set_source_files_properties(${avx512} PROPERTIES
                                COMPILE_OPTIONS "-mavx2;-mfma;-mavx512f;-mavx512dq;-mavx512vl"
                                SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
  elseif(avx2 OR avx512)
    list(REMOVE_ITEM files ${avx2} ${avx512})
  endif()
  set(${list_name} ${files} PARENT_SCOPE)
endfunction()

# mjarm::mjarm, all rooms in one target.
function(mjarm_umbrella)
  get_property(rooms GLOBAL PROPERTY mjarm_rooms)
  list(TRANSFORM rooms PREPEND mjarm::)
  add_library(mjarm_all INTERFACE)
  add_library(mjarm::mjarm ALIAS mjarm_all)
  set_target_properties(mjarm_all PROPERTIES EXPORT_NAME mjarm)
  target_link_libraries(mjarm_all INTERFACE ${rooms})
endfunction()
