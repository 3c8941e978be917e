# Cross-compiles for another system, with clang, the C library and the linker of the Python package ziglang:
#   cmake -DCMAKE_TOOLCHAIN_FILE=... -DLANCER_PLATFORM=windows-x64 -DLANCER_ZIG=/path/of/zig
# Platforms have their names in Blender's extensions.
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES LANCER_PLATFORM LANCER_ZIG)

# The oldest supported systems are those of Blender 4.2: RHEL 8 and macOS 11.
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
  # The linker itself writes the install name and the oldest system.
  set(CMAKE_INSTALL_NAME_TOOL true)
  set(CMAKE_OSX_SYSROOT "")
  set(CMAKE_OSX_DEPLOYMENT_TARGET "")
endif()
string(REGEX REPLACE "-.*" "" CMAKE_SYSTEM_PROCESSOR ${target})

set(CMAKE_C_COMPILER ${LANCER_ZIG} cc)
set(CMAKE_CXX_COMPILER ${LANCER_ZIG} c++)
set(CMAKE_C_COMPILER_TARGET ${target})
set(CMAKE_CXX_COMPILER_TARGET ${target})
# Targets link objects directly and need no archiver.
set(CMAKE_AR ${LANCER_ZIG} CACHE FILEPATH "")
set(CMAKE_RANLIB true CACHE FILEPATH "")
# Exclude the libraries and headers of the build machine.
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
