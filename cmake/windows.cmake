# Tool chain of the preset `windows`: MinGW-w64 of Debian on Linux. What mjarm stands on for Windows lies in one folder,
# which `./dev windows` fills.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR AMD64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)  # std::thread needs the threads of POSIX
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
get_filename_component(mjarm_windows "${CMAKE_CURRENT_LIST_DIR}/../.deps/windows" ABSOLUTE)
set(CMAKE_FIND_ROOT_PATH "${mjarm_windows}" /usr/x86_64-w64-mingw32)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_LIBDIR} "${mjarm_windows}/lib/pkgconfig")
set(ENV{PKG_CONFIG_PATH} "")
# GCC, its C++ library and its threads go into the program, so that it needs no more than MuJoCo does.
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
# GCC takes the stack of Windows to be aligned for wide registers, which it is not (GCC bug 54412): the assembler puts
# moves that do not mind in the place of those that do.
set(CMAKE_CXX_FLAGS_INIT -Wa,-muse-unaligned-vector-move)
