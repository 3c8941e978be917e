# Builds for another system on this one, with the clang, the C library and the linker that the Python package ziglang holds:
#   cmake -DCMAKE_TOOLCHAIN_FILE=... -DLANCER_PLATFORM=windows-x64 -DLANCER_ZIG=/path/of/zig
# Platforms are called as Blender's extensions call them.
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES LANCER_PLATFORM LANCER_ZIG)

# The oldest systems that are served: those of Blender 4.2, which are RHEL 8 and macOS 11.
if(LANCER_PLATFORM STREQUAL "linux-x64")
  set(target x86_64-linux-gnu.2.28)
elseif(LANCER_PLATFORM STREQUAL "linux-arm64")
  set(target aarch64-linux-gnu.2.28)
elseif(LANCER_PLATFORM STREQUAL "windows-x64")
  set(target x86_64-windows-gnu)
elseif(LANCER_PLATFORM STREQUAL "macos-arm64")
  set(target aarch64-macos.11.0)
elseif(LANCER_PLATFORM STREQUAL "macos-x64")
  set(target x86_64-macos.11.0)
else()
  message(FATAL_ERROR "LANCER_PLATFORM is none of linux-x64, linux-arm64, windows-x64, macos-arm64, macos-x64: '${LANCER_PLATFORM}'")
endif()

if(LANCER_PLATFORM MATCHES "^linux")
  set(CMAKE_SYSTEM_NAME Linux)
elseif(LANCER_PLATFORM MATCHES "^windows")
  set(CMAKE_SYSTEM_NAME Windows)
else()
  set(CMAKE_SYSTEM_NAME Darwin)
  # The linker writes both itself.
  set(CMAKE_INSTALL_NAME_TOOL true)
  set(CMAKE_OSX_SYSROOT "")
  set(CMAKE_OSX_DEPLOYMENT_TARGET "")
endif()
string(REGEX REPLACE "-.*" "" CMAKE_SYSTEM_PROCESSOR ${target})

set(CMAKE_C_COMPILER ${LANCER_ZIG} cc)
set(CMAKE_CXX_COMPILER ${LANCER_ZIG} c++)
set(CMAKE_C_COMPILER_TARGET ${target})
set(CMAKE_CXX_COMPILER_TARGET ${target})
# Everything is linked from objects.
set(CMAKE_AR ${LANCER_ZIG} CACHE FILEPATH "")
set(CMAKE_RANLIB true CACHE FILEPATH "")
# Nothing of this machine's own libraries and headers.
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
