# Toolchain: Debian's cross compiler for 64-bit ARM and its packages for that architecture beside this machine's
# (tools/arm64.sh). Programs that the build starts run under qemu.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(ENV{PKG_CONFIG_LIBDIR} /usr/lib/aarch64-linux-gnu/pkgconfig:/usr/share/pkgconfig)
# Highway's functions for NEON have AES: what calls them has to be compiled for that as well. Values of some types are
# passed in another way since GCC 10, which matters to nobody here.
set(CMAKE_CXX_FLAGS_INIT "-march=armv8-a+crypto -Wno-psabi")
